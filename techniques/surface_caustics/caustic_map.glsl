// The lights' maps of the scene without specular objects, where caustic rays end: a caustic map has a texel for each of theirs.
#ifndef LIMN_CAUSTIC_MAP_GLSL
#define LIMN_CAUSTIC_MAP_GLSL
#include "glsl/numeric/sampling.glsl"
#include "glsl/shadow/shadow_view.glsl"

uniform sampler2DArray scene_depth;
layout(std430) readonly buffer SceneViews { ShadowView scene_views[]; };
layout(std430) readonly buffer SceneLights { ShadowLight scene_lights[]; };

// What a texel shows of the scene.
struct MapSurface {
  bool present;
  vec3 position;  // world space, of the texel's centre
};

MapSurface map_surface(ShadowView view, ivec2 texel) {
  float stored = texelFetch(scene_depth, ivec3(texel, view.layer), 0).x;
  vec3 local = shadow_texel_offset(view, texel, stored);
  return MapSurface(stored < 1.0, view.origin + shadow_world_offset(view, local));
}

#endif  // LIMN_CAUSTIC_MAP_GLSL
