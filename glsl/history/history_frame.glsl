// Frames before this one: the views they were seen through, and what is kept of their surfaces.
#ifndef LIMN_HISTORY_FRAME_GLSL
#define LIMN_HISTORY_FRAME_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/surface/gbuffer.glsl"
LIMN_BEGIN

// A frame of which light is kept. Element of a storage buffer.
struct HistoryFrame {
  mat4 world_to_clip;
  vec4 camera_position;  // world, homogeneous
  vec4 view_ray_origin;  // as in FrameBlock
  vec4 view_ray_dx;
  vec4 view_ray_dy;
  uint slot;  // where its light lies
  uint still;  // 1 where its pixels look the same way as those of this frame
  uint age;   // frames since
  uint moved;  // 1 where instances may have been elsewhere than in this frame
};

// A surface as it is kept: view depth in metres, its geometric normal (two times 12 bits) and the low 8 bits of its
// draw instance. depth 0: none.
LIMN_FN uvec2 history_surface(float depth, vec2 octahedral_normal, uint instance) {
  uvec2 n = uvec2((octahedral_normal * 0.5f + vec2(0.5f)) * 4095.0f + vec2(0.5f));
  return uvec2(floatBitsToUint(depth), n.x | (n.y << 12u) | (instance << 24u));
}

LIMN_FN float history_depth(uvec2 surface) { return uintBitsToFloat(surface.x); }

LIMN_FN vec3 history_normal(uvec2 surface) {
  vec2 n = vec2(float(surface.y & 4095u), float((surface.y >> 12u) & 4095u));
  return octahedral_decode(n * (2.0f / 4095.0f) - vec2(1.0f));
}

LIMN_FN bool history_same_instance(uvec2 surface, uint instance) { return (surface.y >> 24u) == (instance & 255u); }

LIMN_END
#endif  // LIMN_HISTORY_FRAME_GLSL
