// The view of the radiance cache.
#ifndef LIMN_CACHE_VIEW_GLSL
#define LIMN_CACHE_VIEW_GLSL
#include "glsl/scene/blocks.glsl"
#include "techniques/subtractive_shadows/cache_place.glsl"

// The one direction to the camera that all surfaces are taken to have: that in the middle of the picture.
vec3 cache_view() { return vec3(frame.world_to_view[0].z, frame.world_to_view[1].z, frame.world_to_view[2].z); }

float cache_view_reach() { return cache_reach(length(frame.view_ray_origin.xyz)); }

#endif  // LIMN_CACHE_VIEW_GLSL
