// Morphing and skinning of vertices: the compute shader and the CPU use these formulas (glTF 2.0, sections
// 3.7.2.2 and 3.7.3). Order: all morph targets, then the skin.
#ifndef LIMN_DEFORM_GLSL
#define LIMN_DEFORM_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Unit vector, or `fallback` where v has no direction.
LIMN_FN vec3 safe_normalize(vec3 v, vec3 fallback) {
  float square = dot(v, v);
  return square > 0.0f ? v * (1.0f / sqrt(square)) : fallback;
}

// Adds one morph target's delta to a position, normal or tangent direction.
LIMN_FN vec3 morph(vec3 base, vec3 delta, float weight) { return base + weight * delta; }

// Linear blend of four joint matrices (each: bind space to world); the weights sum to 1.
LIMN_FN mat4 blend_joints(mat4 a, mat4 b, mat4 c, mat4 d, vec4 weights) {
  return a * weights.x + b * weights.y + c * weights.z + d * weights.w;
}

LIMN_FN vec3 skin_position(mat4 joint, vec3 position) { return vec3(joint * vec4(position, 1.0f)); }

// The direction of inverse(transpose(M)) * normal, unit, from the cofactors: needs no division and keeps the
// outside outside where M mirrors.
LIMN_FN vec3 skin_normal(mat4 joint, vec3 normal) {
  vec3 x = vec3(joint[0]);
  vec3 y = vec3(joint[1]);
  vec3 z = vec3(joint[2]);
  vec3 yz = cross(y, z);
  vec3 result = yz * normal.x + cross(z, x) * normal.y + cross(x, y) * normal.z;
  return safe_normalize(dot(x, yz) < 0.0f ? -result : result, normal);
}

// Tangents lie in the surface and so move like differences of positions. w is the bitangent's sign, which those who draw flip
// where the primitive's node mirrors, skinned or not.
LIMN_FN vec4 skin_tangent(mat4 joint, vec4 tangent) {
  vec3 t = vec3(tangent);
  return vec4(safe_normalize(vec3(joint * vec4(t, 0.0f)), t), tangent.w);
}

LIMN_END
#endif  // LIMN_DEFORM_GLSL
