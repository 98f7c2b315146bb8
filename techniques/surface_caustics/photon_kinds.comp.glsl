// Which caustic rays are photons: those that end on a surface.
#include "glsl/caustics/caustic_ray.glsl"
#include "glsl/caustics/ray_runs.glsl"

layout(std430) readonly buffer Rays { CausticRay rays[]; };

uint ray_kind(int index) { return rays[index].kind == caustic_ray_surface ? 0u : ray_kind_none; }

#include "glsl/caustics/ray_kinds.glsl"
