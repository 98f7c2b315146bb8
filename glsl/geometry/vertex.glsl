// How vertices are stored: a stream of positions (3 floats) and one of attributes (VertexAttributes, 16 bytes), both
// shared by all primitives of a scene. Written by the upload and by the deform pass.
#ifndef LIMN_VERTEX_GLSL
#define LIMN_VERTEX_GLSL
#include "glsl/surface/gbuffer.glsl"
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Storage buffer element and vertex attributes 2 (uvec2: normal, tangent) and 3 (vec2: uv).
struct VertexAttributes {
  uint normal;   // octahedral, 2 x 16 bits: within 6.5e-5 radians
  uint tangent;  // octahedral, 16 + 15 bits; lowest bit of the second: the bitangent's sign
  float u;
  float v;
};

LIMN_FN uint vertex_pack_normal(vec3 n) { return packSnorm2x16(octahedral_encode(n)); }
LIMN_FN vec3 vertex_unpack_normal(uint bits) { return octahedral_decode(unpackSnorm2x16(bits)); }

// t.w: +-1.
LIMN_FN uint vertex_pack_tangent(vec4 t) {
  uint bits = packSnorm2x16(octahedral_encode(vec3(t))) & 0xfffeffffu;
  return bits | (t.w < 0.0f ? 0x00010000u : 0u);
}
LIMN_FN vec4 vertex_unpack_tangent(uint bits) {
  vec3 t = octahedral_decode(unpackSnorm2x16(bits & 0xfffeffffu));
  return vec4(t, (bits & 0x00010000u) != 0u ? -1.0f : 1.0f);
}

LIMN_END
#endif  // LIMN_VERTEX_GLSL
