// Surface of the G-buffer. MASKED 1: discard below the material's alpha cutoff.
#include "glsl/blocks.glsl"
#include "glsl/gbuffer.glsl"
#include "glsl/normal_map.glsl"
#include "glsl/texture_level.glsl"

layout(location = 0) in vec3 normal_ws;
layout(location = 1) in vec4 tangent_ws;
layout(location = 2) in vec2 surface_uv;
layout(location = 3) in vec4 surface_colour;
layout(location = 4) flat in uint instance_index;

layout(std430, binding = 0) readonly buffer Instances { Instance instances[]; };
layout(std430, binding = 1) readonly buffer Materials { Material materials[]; };
layout(std430, binding = 2) readonly buffer Positions { float positions[]; };
layout(std430, binding = 3) readonly buffer Indices { uint indices[]; };

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

vec3 corner(Instance instance, int k) {
  uint vertex = instance.info.y + indices[instance.info.w + 3u * uint(gl_PrimitiveID) + uint(k)];
  return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

// Normal of the triangle from its corners, towards the camera: exact however small the triangle is on the screen, where
// derivatives of interpolated positions are not.
vec3 triangle_normal(Instance instance, vec3 view_direction) {
  vec3 a = corner(instance, 0);
  mat3 linear = mat3(instance.object_to_world);
  vec3 e = linear * (corner(instance, 1) - a);
  vec3 f = linear * (corner(instance, 2) - a);
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
  Instance instance = instances[instance_index];
  Material material = materials[instance.info.x];
  uint flags = material.info.x;

  vec4 base = material.base_colour * surface_colour;
  if ((flags & material_has_base_colour_texture) != 0u) base *= texel(base_colour_texture, uv_dx, uv_dy);
#if MASKED
  if (base.a < material.emission.w) discard;
#endif

  vec2 pixel = floor(gl_FragCoord.xy);
  vec3 view_direction =
      frame.view_ray_origin.xyz + pixel.x * frame.view_ray_dx.xyz + pixel.y * frame.view_ray_dy.xyz;
  GBufferSurface s;
  s.geometric_normal = triangle_normal(instance, normalize(view_direction));
  float side = gl_FrontFacing ? 1.0 : -1.0;
  s.normal = dot(normal_ws, normal_ws) > 0.0 ? normalize(normal_ws) : side * s.geometric_normal;
  if ((flags & material_has_normal_texture) != 0u) {
    vec4 tangent = vec4(tangent_ws.xyz, tangent_ws.w < 0.0 ? -1.0 : 1.0);
    s.normal = mapped_normal(s.normal, tangent, texel(normal_texture, uv_dx, uv_dy).rgb, material.metal_rough.z);
  }
  s.normal *= side;

  vec2 metal_rough = material.metal_rough.xy;
  if ((flags & material_has_metal_rough_texture) != 0u) {
    metal_rough *= texel(metal_rough_texture, uv_dx, uv_dy).bg;
  }
  s.emission = material.emission.rgb;
  if ((flags & material_has_emissive_texture) != 0u) s.emission *= texel(emissive_texture, uv_dx, uv_dy).rgb;

  s.base_colour = base.rgb;
  s.metallic = metal_rough.x;
  s.roughness = metal_rough.y;
  s.specular_factor = material.specular.w;
  s.specular_colour = material.specular.w > 0.0 ? material.specular.rgb / material.specular.w : vec3(1.0);
  s.ior = material.metal_rough.w;
  s.flags = (flags & material_specular_surface) != 0u ? gbuffer_flag_specular : 0u;

  GBufferTexels texels = gbuffer_pack(s);
  out_depth = 1.0 / gl_FragCoord.w;
  out_normal = texels.normal;
  out_geometric_normal = texels.geometric_normal;
  out_albedo = texels.albedo;
  out_material = texels.material;
  out_emission = texels.emission;
  out_instance = instance_index;
}
