// The G-buffer: what each texture holds, and how a surface is packed into it and read back.
//
//   texture           format      content
//   depth             R32F        distance along the view axis, m; 0: no coverage
//   normal            RG16_SNORM  shading normal, octahedral
//   geometric normal  RG16_SNORM  normal of the triangle, facing the camera, octahedral
//   albedo            RGBA16      rgb: square root of the base colour; a: metallic
//   material          RGBA8       r: perceptual roughness; g: specularFactor; b: ior, gbuffer_ior_encode(); a: flags / 255
//   emission          RGBA16F     rgb: emitted radiance; a: specularColour, 31 levels per channel as bits
//   instance id       R32UI       index of the draw instance; 0xffffffff: none
//   tangent           R16         turn of the tangent about the normal as read back (frame_turned()), 1e-4 radians a
//                                 step; only in scenes with anisotropic materials
//             or    RGBA16      where places in height maps are asked for. r: as above, but about the geometric normal as
//                                 read back where the pixel has a place; gba: the place (GBufferPlace), a: 0: none
//
// The frame of a height map's base is made of the geometric normal because the shading normal is that of the bumps.
//
// Quantisation (half a step): base colour sqrt(base colour) / 65536, which is 0.02 % of 0.005 and 0.002 % of 0.5 (8 bits
// would be wrong by up to 3.6 and 0.6 %, the same for every pixel of a wall: a bias); metallic 8e-6; roughness and
// specularFactor 0.002; ior 0.005 up to 3, of which two decimals are exact; specularColour 0.017; emission 2^-11 relative, up
// to 65504. Normals: 6.5e-5 radians, reached at the centres of the octahedron's faces, where the map stretches by 3 along one
// diagonal.
#ifndef LIMN_GBUFFER_GLSL
#define LIMN_GBUFFER_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_CONST uint gbuffer_flag_specular = 1u;  // specular surface: takes no direct and no indirect light
LIMN_CONST uint gbuffer_flag_back = 2u;      // of a specular surface: its back is seen, from within the body
LIMN_CONST uint gbuffer_flag_translucent = 4u;  // light enters; the base colour is the half space's albedo

// A surface point before packing and after unpacking.
struct GBufferSurface {
  vec3 normal;            // unit, shading
  vec3 geometric_normal;  // unit, towards the camera
  vec3 base_colour;       // linear, [0, 1]
  float metallic;         // [0, 1]
  float roughness;        // perceptual, [0, 1]
  float specular_factor;  // KHR_materials_specular specularFactor, [0, 1]
  vec3 specular_colour;   // KHR_materials_specular specularColorFactor, clamped to [0, 1]
  float ior;              // clamped to [1, 999]: metals of other material systems, which reflect all of specular_colour
  vec3 emission;          // radiance, W/(sr m^2)
  uint flags;             // gbuffer_flag_*
};

// The same as written to the textures.
struct GBufferTexels {
  vec2 normal;
  vec2 geometric_normal;
  vec4 albedo;
  vec4 material;
  vec4 emission;
};

// Where a pixel lies in its material's height map. Backs of surfaces have no place.
struct GBufferPlace {
  bool present;      // false: no height map
  vec2 uv;           // texture coordinates within the map, [0, 1], steps of 1 / 65535
  float level;       // of detail (texture_level()), [0, 15], steps of 1 / 2048
  bool left_handed;  // tangent, rising v and geometric normal are
};

// Octahedral map of the sphere onto [-1, 1]^2 (Cigolle et al. 2014, A Survey of Efficient Representations for
// Independent Unit Vectors, "oct"). n: any length but 0.
LIMN_FN vec2 octahedral_encode(vec3 n) {
  float scale = 1.0f / (abs(n.x) + abs(n.y) + abs(n.z));
  vec2 p = vec2(n.x * scale, n.y * scale);
  if (n.z >= 0.0f) return p;
  vec2 folded = vec2(1.0f - abs(p.y), 1.0f - abs(p.x));
  return vec2(p.x >= 0.0f ? folded.x : -folded.x, p.y >= 0.0f ? folded.y : -folded.y);
}

LIMN_FN vec3 octahedral_decode(vec2 p) {
  vec3 n = vec3(p.x, p.y, 1.0f - abs(p.x) - abs(p.y));
  float fold = max(-n.z, 0.0f);
  n.x += n.x >= 0.0f ? -fold : fold;
  n.y += n.y >= 0.0f ? -fold : fold;
  return normalize(n);
}

// A colour in [0, 1]^3 at 31 levels per channel as the bits of a normal, finite, positive half:
// 0x400 + r + 31 g + 961 b.
LIMN_FN float colour_to_half_bits(vec3 colour) {
  uint r = uint(clamp(colour.x, 0.0f, 1.0f) * 30.0f + 0.5f);
  uint g = uint(clamp(colour.y, 0.0f, 1.0f) * 30.0f + 0.5f);
  uint b = uint(clamp(colour.z, 0.0f, 1.0f) * 30.0f + 0.5f);
  return unpackHalf2x16(0x400u + r + 31u * g + 961u * b).x;
}

LIMN_FN vec3 colour_from_half_bits(float bits) {
  uint code = (packHalf2x16(vec2(bits, 0.0f)) & 0xffffu) - 0x400u;
  return vec3(float(code % 31u), float(code / 31u % 31u), float(code / 961u)) / 30.0f;
}

// A colour in [0, 1]^3 as the albedo texture holds it, and back: roots spread the steps as eyes and dark walls need them.
LIMN_FN vec3 gbuffer_colour_encode(vec3 colour) { return sqrt(clamp(colour, vec3(0.0f), vec3(1.0f))); }
LIMN_FN vec3 gbuffer_colour_decode(vec3 encoded) { return encoded * encoded; }

// A place as g, b and a of the tangent's texture. uv: within the map.
LIMN_FN vec3 gbuffer_place_pack(vec2 uv, float level, bool left_handed) {
  float code = 1.0f + 2.0f * floor(clamp(level, 0.0f, 15.0f) * 2048.0f + 0.5f) + (left_handed ? 1.0f : 0.0f);
  return vec3(uv, code / 65535.0f);
}

LIMN_FN GBufferPlace gbuffer_place_unpack(vec3 stored) {
  uint code = uint(stored.z * 65535.0f + 0.5f);
  uint value = code == 0u ? 0u : code - 1u;
  GBufferPlace p;
  p.present = code != 0u;
  p.uv = vec2(stored);
  p.level = float(value / 2u) / 2048.0f;
  p.left_handed = value % 2u != 0u;
  return p;
}

// Steps of 0.01 up to 3, then even steps of (ior - 1) / (ior + 1), whose square is the reflectance, up to 0.998. In [0, 1].
LIMN_FN float gbuffer_ior_encode(float ior) {
  float ratio = 1.0f - 2.0f / (max(ior, 1.0f) + 1.0f);
  float code = ior < 3.0f ? 100.0f * max(ior - 1.0f, 0.0f) : 200.0f + 55.0f / 0.498f * (min(ratio, 0.998f) - 0.5f);
  return code / 255.0f;
}
LIMN_FN float gbuffer_ior_decode(float stored) {
  float code = 255.0f * stored;
  float ratio = 0.5f + 0.498f / 55.0f * (code - 200.0f);
  return code < 200.5f ? 1.0f + 0.01f * code : (1.0f + ratio) / (1.0f - ratio);
}

// Two of the constants that the material's texture holds.
LIMN_FN float gbuffer_stored_ior(vec4 material) { return gbuffer_ior_decode(material.z); }
LIMN_FN uint gbuffer_stored_flags(vec4 material) { return uint(material.w * 255.0f + 0.5f); }

LIMN_FN GBufferTexels gbuffer_pack(GBufferSurface s) {
  GBufferTexels t;
  t.normal = octahedral_encode(s.normal);
  t.geometric_normal = octahedral_encode(s.geometric_normal);
  t.albedo = vec4(gbuffer_colour_encode(s.base_colour), s.metallic);
  t.material = vec4(s.roughness, s.specular_factor, gbuffer_ior_encode(s.ior), float(s.flags) / 255.0f);
  t.emission = vec4(min(s.emission, vec3(65504.0f)), colour_to_half_bits(s.specular_colour));
  return t;
}

LIMN_FN GBufferSurface gbuffer_unpack(GBufferTexels t) {
  GBufferSurface s;
  s.normal = octahedral_decode(t.normal);
  s.geometric_normal = octahedral_decode(t.geometric_normal);
  s.base_colour = gbuffer_colour_decode(vec3(t.albedo));
  s.metallic = t.albedo.w;
  s.roughness = t.material.x;
  s.specular_factor = t.material.y;
  s.specular_colour = colour_from_half_bits(t.emission.w);
  s.ior = gbuffer_stored_ior(t.material);
  s.emission = vec3(t.emission);
  s.flags = gbuffer_stored_flags(t.material);
  return s;
}

LIMN_END
#endif  // LIMN_GBUFFER_GLSL
