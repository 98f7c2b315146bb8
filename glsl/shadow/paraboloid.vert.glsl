// Corners of the scene's triangles in the views of paraboloid maps, for paraboloid.geom.glsl. MASKED 1: passes on what an
// alpha test needs.
#include "glsl/scene/blocks.glsl"
#include "glsl/shadow/shadow_view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in uvec2 entry;  // x: draw instance, y: view
layout(location = 0) out vec3 corner;  // relative to the view's origin, in its axes, m
layout(location = 1) flat out uint view_index;
#if MASKED
layout(location = 3) in vec2 uv;
layout(location = 4) in vec4 colour;
layout(location = 2) out vec3 coverage;  // uv, alpha of the vertex
layout(location = 3) flat out uint corner_material;
#endif

layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Views { ShadowView views[]; };

void main() {
  corner = shadow_local(views[entry.y], (instances[entry.x].object_to_world * vec4(position, 1.0)).xyz);
  view_index = entry.y;
#if MASKED
  coverage = vec3(uv, colour.a);
  corner_material = instances[entry.x].material;
#endif
}
