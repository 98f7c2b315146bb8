// Surface of the G-buffer. MASKED 1: discard below the material's alpha cutoff. TEXTURES: which textures the material has
// (material_has_*), a constant because software renderers execute both sides of every branch. COLOURS 1: vertex colours.
#include "glsl/blocks.glsl"
#include "glsl/gbuffer.glsl"
#include "glsl/normal_map.glsl"
#include "glsl/texture_level.glsl"

layout(location = 0) in vec3 normal_ws;
layout(location = 1) in vec4 tangent_ws;
layout(location = 2) in vec2 surface_uv;
#if COLOURS
layout(location = 3) in vec4 surface_colour;
#endif
layout(location = 4) flat in uvec3 surface_instance;  // draw instance, first vertex, first index

layout(std430, binding = 0) readonly buffer Instances { Instance instances[]; };
layout(std430, binding = 2) readonly buffer Positions { float positions[]; };
layout(std430, binding = 3) readonly buffer Indices { uint indices[]; };
layout(std140, binding = 1) uniform MaterialBlock { Material material; };  // of the draw, at a constant place

const uint textures = TEXTURES;

layout(binding = 0) uniform sampler2D base_colour_texture;
layout(binding = 1) uniform sampler2D metal_rough_texture;
layout(binding = 2) uniform sampler2D normal_texture;
layout(binding = 3) uniform sampler2D emissive_texture;

layout(location = 0) out float out_depth;
layout(location = 1) out vec2 out_normal;
layout(location = 2) out vec2 out_geometric_normal;
layout(location = 3) out vec4 out_albedo;
layout(location = 4) out vec4 out_material;
layout(location = 5) out vec4 out_emission;
layout(location = 6) out uint out_instance;

vec3 corner(int k) {
  uint vertex = surface_instance.y + indices[surface_instance.z + 3u * uint(gl_PrimitiveID) + uint(k)];
  return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

// Normal of the triangle from its corners, towards the camera: exact however small the triangle is on the screen, where
// derivatives of interpolated positions are not.
vec3 triangle_normal(vec3 view_direction) {
  vec3 a = corner(0);
  mat3 linear = mat3(instances[surface_instance.x].object_to_world);
  vec3 e = linear * (corner(1) - a);
  vec3 f = linear * (corner(2) - a);
  float scale = max(max(max(abs(e.x), abs(e.y)), abs(e.z)), max(max(abs(f.x), abs(f.y)), abs(f.z)));
  vec3 n = cross(e / scale, f / scale);
  float squared = dot(n, n);
  if (!(squared > 0.0)) return -view_direction;
  n *= inversesqrt(squared);
  return dot(n, view_direction) > 0.0 ? -n : n;
}

vec4 texel(sampler2D image, vec2 uv_dx, vec2 uv_dy) {
  return textureLod(image, surface_uv, texture_level(uv_dx, uv_dy, vec2(textureSize(image, 0))));
}

void main() {
  vec2 uv_dx = dFdxFine(surface_uv);
  vec2 uv_dy = dFdyFine(surface_uv);

  vec4 base = material.base_colour;
#if COLOURS
  base *= surface_colour;
#endif
  if ((textures & material_has_base_colour_texture) != 0u) base *= texel(base_colour_texture, uv_dx, uv_dy);
#if MASKED
  if (base.a < material.emission.w) discard;
#endif

  vec2 pixel = floor(gl_FragCoord.xy);
  vec3 view_direction =
      frame.view_ray_origin.xyz + pixel.x * frame.view_ray_dx.xyz + pixel.y * frame.view_ray_dy.xyz;
  GBufferSurface s;
  s.geometric_normal = triangle_normal(normalize(view_direction));
  float side = gl_FrontFacing ? 1.0 : -1.0;
  s.normal = dot(normal_ws, normal_ws) > 0.0 ? normalize(normal_ws) : side * s.geometric_normal;
  if ((textures & material_has_normal_texture) != 0u) {
    vec4 tangent = vec4(tangent_ws.xyz, tangent_ws.w < 0.0 ? -1.0 : 1.0);
    s.normal = mapped_normal(s.normal, tangent, texel(normal_texture, uv_dx, uv_dy).rgb, material.metal_rough.z);
  }
  s.normal *= side;

  vec2 metal_rough = material.metal_rough.xy;
  if ((textures & material_has_metal_rough_texture) != 0u) {
    metal_rough *= texel(metal_rough_texture, uv_dx, uv_dy).bg;
  }
  s.emission = material.emission.rgb;
  if ((textures & material_has_emissive_texture) != 0u) s.emission *= texel(emissive_texture, uv_dx, uv_dy).rgb;

  s.base_colour = base.rgb;
  s.metallic = metal_rough.x;
  s.roughness = metal_rough.y;
  s.specular_factor = material.specular.w;
  s.specular_colour = material.specular.w > 0.0 ? material.specular.rgb / material.specular.w : vec3(1.0);
  s.ior = material.metal_rough.w;
  s.flags = (material.info.x & material_specular_surface) != 0u ? gbuffer_flag_specular : 0u;

  GBufferTexels texels = gbuffer_pack(s);
  out_depth = 1.0 / gl_FragCoord.w;
  out_normal = texels.normal;
  out_geometric_normal = texels.geometric_normal;
  out_albedo = texels.albedo;
  out_material = texels.material;
  out_emission = texels.emission;
  out_instance = surface_instance.x;
}
