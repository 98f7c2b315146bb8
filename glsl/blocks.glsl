// Uniform blocks and storage layouts that C++ and GLSL share: this file is their only definition.
#ifndef LIMN_BLOCKS_GLSL
#define LIMN_BLOCKS_GLSL
#include "glsl/language.glsl"
#include "glsl/light.glsl"
#include "glsl/media.glsl"
LIMN_BEGIN

// The camera and the frame. World space in metres, view space looks down -Z, clip depth in [-1, 1].
LIMN_UNIFORM_BLOCK(FrameBlock, 0)
mat4 world_to_clip;
mat4 clip_to_world;
mat4 world_to_view;
vec4 camera_position;  // xyz world; w: 1
vec4 view_ray_origin;  // world direction of pixel (0,0)'s centre: direction(x, y) = origin + x * dx + y * dy
vec4 view_ray_dx;      // (not normalised; its component along the view axis is 1, so depth * direction is the offset)
vec4 view_ray_dy;
vec4 environment;      // x: rotation about +Y in radians; y: scale; z: 1 if there is an environment; w: scene radius, m
uvec4 frame_size;      // x, y: pixels; z: number of lights; w: frame index
vec4 medium_extinction;  // rgb: sigma_a + sigma_s per metre; w: 1 if there is a medium
vec4 medium_scattering;  // rgb: sigma_s per metre; w: g
vec4 medium_ball;        // xyz: centre of the ball that the medium fills; w: its radius, m
mat4 medium_to_box;      // from world space to the unit cube in which a medium with a grid has density
LIMN_END_UNIFORM_BLOCK(frame)

LIMN_FN Medium frame_medium(vec4 extinction, vec4 scattering, vec4 ball) {
  Medium m;
  m.extinction = vec3(extinction);
  m.scattering = vec3(scattering);
  m.g = scattering.w;
  m.ball = ball;
  return m;
}

// One drawn copy of a primitive (storage buffer element). The draw instance id equals its index.
struct Instance {
  mat4 object_to_world;
  mat4 normal_to_world;  // inverse transpose, upper 3x3
  uvec4 info;            // x: material, y: vertex offset, z: flags (1: double sided, 2: mirrored winding), w: first index
};

// Material constants (storage buffer element); textures are bound per draw.
struct Material {
  vec4 base_colour;       // linear, a: coverage
  vec4 emission;          // rgb radiance, W/(sr m^2); w: alpha cutoff (0: opaque)
  vec4 metal_rough;       // x: metallic, y: perceptual roughness, z: normal-map scale, w: IOR
  vec4 specular;          // rgb: KHR specular colour * factor (F0 tint), w: specularFactor (F90)
  vec4 transmission;      // x: transmission, y: thickness (m), z: attenuation distance (m, 0: infinite), w: unused
  vec4 attenuation;       // rgb attenuation colour
  uvec4 info;             // x: flags (material_*), yzw unused
};
LIMN_CONST uint material_double_sided = 1u;
LIMN_CONST uint material_has_base_colour_texture = 2u;
LIMN_CONST uint material_has_metal_rough_texture = 4u;
LIMN_CONST uint material_has_normal_texture = 8u;
LIMN_CONST uint material_has_emissive_texture = 16u;
LIMN_CONST uint material_specular_surface = 32u;  // transmission > 0, or metallic with roughness < 0.05

LIMN_FN Optics material_optics(Material m) {
  Optics o;
  o.base = clamp(vec3(m.base_colour), vec3(0.0f), vec3(1.0f));
  o.metallic = m.metal_rough.x;
  o.transmission = m.transmission.x;
  o.ior = clamp(m.metal_rough.w, 1.0f, 3.0f);
  o.thickness = m.transmission.y;
  o.attenuation = vec3(m.attenuation);
  o.attenuation_distance = m.transmission.z;
  return o;
}

LIMN_END
#endif
