// Surface of the G-buffer. SURFACE_TANGENTS 1: and its tangent; SURFACE_PLACES 1: and its place
// in the material's height map. MASKED, TEXTURES, COLOURS: see surface_input.glsl.
#include "glsl/surface/gbuffer.glsl"
#include "glsl/geometry/surface_input.glsl"
#include "glsl/relief/height_normal.glsl"
#include "glsl/surface/normal_map.glsl"
#if SURFACE_TANGENTS
#include "glsl/numeric/geometry.glsl"
#endif

layout(location = 0) in vec3 normal_ws;
layout(location = 1) in vec4 tangent_ws;

layout(location = 0) out float out_depth;
layout(location = 1) out vec2 out_normal;
layout(location = 2) out vec2 out_geometric_normal;
layout(location = 3) out vec4 out_albedo;
layout(location = 4) out vec4 out_material;
layout(location = 5) out vec4 out_emission;
layout(location = 6) out uint out_instance;
#if SURFACE_TANGENTS
#if SURFACE_PLACES
layout(location = 7) out vec4 out_tangent;
#else
layout(location = 7) out float out_tangent;
#endif
#endif

#if SURFACE_PLACES
// r: the turn; gba: the place.
vec4 tangent_and_place(vec3 plane, vec2 uv_dx, vec2 uv_dy) {
  bool clamped = (material.flags & material_height_clamped) != 0u;
  vec2 uv = clamped ? clamp(surface_uv, vec2(0.0), vec2(1.0)) : fract(surface_uv);
  // The bitangent of normal maps points up the texture, against v.
  bool left_handed = tangent_ws.w >= 0.0;
  float level = texture_level(uv_dx, uv_dy, vec2(material.height_size));
  return vec4(frame_turn(plane, tangent_ws.xyz), gbuffer_place_pack(uv, level, left_handed));
}
#endif

void main() {
  vec2 uv_dx = dFdxFine(surface_uv);
  vec2 uv_dy = dFdyFine(surface_uv);

  vec4 base = surface_base(uv_dx, uv_dy);
#if MASKED
  if (base.a < material.alpha_cutoff) discard;
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
    s.normal = mapped_normal(s.normal, tangent, texel(normal_texture, uv_dx, uv_dy).rgb, material.normal_scale);
  }
  if ((textures & material_has_height_normals) != 0u) {
    vec4 tangent = vec4(tangent_ws.xyz, tangent_ws.w < 0.0 ? -1.0 : 1.0);
    s.normal = height_normal(s.normal, tangent, texel(height_slopes, uv_dx, uv_dy).rg);
  }
  s.normal *= side;

  vec2 metal_rough = surface_metal_rough(uv_dx, uv_dy);
  s.emission = material.emission;
  if ((textures & material_has_emissive_texture) != 0u) s.emission *= texel(emissive_texture, uv_dx, uv_dy).rgb;
#if COLOURS
  if ((material.flags & material_unlit) != 0u) s.emission *= surface_colour.rgb;
#endif

  s.base_colour = base.rgb;
  s.metallic = metal_rough.x;
  s.roughness = metal_rough.y;
  s.specular_factor = material.specular_factor;
  s.specular_colour = material.specular_factor > 0.0 ? material.specular_colour / material.specular_factor : vec3(1.0);
  s.ior = material.ior;
  s.flags = (material.flags & material_translucent) != 0u ? gbuffer_flag_translucent : 0u;
  if ((material.flags & material_specular_surface) != 0u) {
    s.flags = gbuffer_flag_specular | (gl_FrontFacing ? 0u : gbuffer_flag_back);
  }

  GBufferTexels texels = gbuffer_pack(s);
  out_depth = 1.0 / gl_FragCoord.w;
  out_normal = texels.normal;
  out_geometric_normal = texels.geometric_normal;
  out_albedo = texels.albedo;
  out_material = texels.material;
  out_emission = texels.emission;
  out_instance = surface_instance.x;
#if SURFACE_TANGENTS
  // About the normal as it is read back, around which the frame that the turn counts from flips at n.z = 0.
  vec2 stored = round(texels.normal * 32767.0) / 32767.0;
  float turn = frame_turn(octahedral_decode(stored), tangent_ws.xyz);
#if SURFACE_PLACES
  vec3 plane = octahedral_decode(round(texels.geometric_normal * 32767.0) / 32767.0);
  vec3 across = cross(plane, tangent_ws.xyz);
  bool finite = !any(isnan(surface_uv)) && !any(isinf(surface_uv));
  out_tangent = vec4(turn, 0.0, 0.0, 0.0);
  if (material.height >= 0 && gl_FrontFacing && finite && dot(across, across) > 0.0)
    out_tangent = tangent_and_place(plane, uv_dx, uv_dy);
#else
  out_tangent = turn;
#endif
#endif
}
