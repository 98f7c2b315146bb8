// Normal mapping, as the GPU and the reference both do it.
#ifndef LIMN_NORMAL_MAP_GLSL
#define LIMN_NORMAL_MAP_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// World shading normal from the interpolated world normal and tangent (any length; w: sign of the bitangent, negated by
// the caller where object to world is a mirroring) and the direction of the new normal (any length) along tangent,
// bitangent and normal. The tangent is made perpendicular to the normal, the bitangent is cross(normal, tangent) * w,
// all in world space. A vanishing tangent leaves the interpolated normal.
LIMN_FN vec3 normal_from_frame(vec3 normal, vec4 tangent, vec3 m) {
  vec3 n = normalize(normal);
  vec3 t = vec3(tangent) - n * dot(n, vec3(tangent));
  float size = length(t);
  if (!(size > 0.0f)) return n;
  t = t / size;
  vec3 b = cross(n, t) * tangent.w;
  vec3 mapped = m.x * t + m.y * b + m.z * n;
  float mapped_size = length(mapped);
  return mapped_size > 0.0f ? mapped / mapped_size : n;
}

// The same from the texel of a normal map in [0, 1]^3 (glTF 2.0, 3.9.3: x, y scaled by normalTexture.scale).
LIMN_FN vec3 mapped_normal(vec3 normal, vec4 tangent, vec3 texel, float scale) {
  return normal_from_frame(normal, tangent, (2.0f * texel - vec3(1.0f)) * vec3(scale, scale, 1.0f));
}

LIMN_END
#endif  // LIMN_NORMAL_MAP_GLSL
