// Uniform blocks and storage layouts that C++ and GLSL share: this file is their only definition.
#ifndef LIMN_BLOCKS_GLSL
#define LIMN_BLOCKS_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/scene/light.glsl"
#include "glsl/scene/media.glsl"
LIMN_BEGIN

// The camera and the frame. World space in metres, view space looks down -Z, clip depth in [-1, 1].
LIMN_UNIFORM_BLOCK(FrameBlock)
mat4 world_to_clip;
mat4 world_to_view;
vec4 camera_position;  // world, homogeneous
vec4 view_ray_origin;  // world direction of pixel (0,0)'s centre: direction(x, y) = origin + x * dx + y * dy
vec4 view_ray_dx;      // (not normalised; its component along the view axis is 1, so depth * direction is the offset)
vec4 view_ray_dy;
float environment_rotation;  // about +Y, radians
float environment_scale;
uvec2 frame_size;            // pixels
float scene_radius;          // m
uint frame_index;
uvec2 unused_0;
vec3 medium_extinction;  // sigma_a + sigma_s per metre
float medium_asymmetry;  // g
vec3 medium_scattering;  // sigma_s per metre
float unused_1;
Ball medium_ball;        // what the medium fills, m
mat4 medium_to_box;      // from world space to the unit cube in which a medium with a grid has density
LIMN_END_UNIFORM_BLOCK(frame)

LIMN_FN Medium frame_medium(vec3 extinction, vec3 scattering, float asymmetry, Ball ball) {
  Medium m;
  m.extinction = extinction;
  m.scattering = scattering;
  m.g = asymmetry;
  m.ball = ball;
  return m;
}

// One drawn copy of a primitive (storage buffer element). The draw instance id equals its index.
struct Instance {
  mat4 object_to_world;
  mat4 normal_to_world;  // cofactors: the direction of the inverse transpose, upper 3x3
  uint material;
  uint first_vertex;
  uint flags;  // instance_*
  uint first_index;
};
LIMN_CONST uint instance_mirrored = 1u;  // its triangles are wound the other way round than those of its mesh

// Material constants (storage buffer element); textures are bound per draw.
struct Material {
  vec4 base_colour;       // linear, a: coverage
  vec3 emission;          // radiance, W/(sr m^2)
  float alpha_cutoff;     // 0: opaque
  float metallic;
  float roughness;     // perceptual
  float normal_scale;  // of the normal map
  float ior;
  vec3 specular_colour;   // KHR specular colour * factor (F0 tint)
  float specular_factor;  // F90
  float transmission;
  float thickness;             // in the space of the mesh; 0: a thin wall
  float attenuation_distance;  // m, 0: infinite
  uint unused_0;
  vec3 attenuation;  // colour
  int height;         // index of the height map, -1: none
  uint flags;  // material_*
  uint unused_2;
  uvec2 height_size;  // texels of the height map
};
LIMN_CONST uint material_double_sided = 1u;
LIMN_CONST uint material_has_base_colour_texture = 2u;
LIMN_CONST uint material_has_metal_rough_texture = 4u;
LIMN_CONST uint material_has_normal_texture = 8u;
LIMN_CONST uint material_has_emissive_texture = 16u;
LIMN_CONST uint material_specular_surface = 32u;  // transmission > 0, or metallic with roughness < 0.05

LIMN_CONST uint material_has_model = 64u;  // the constants are those of the metal next to it
LIMN_CONST uint material_has_height_normals = 128u;  // from a height map: there is no normal texture
LIMN_CONST uint material_height_clamped = 256u;  // the height map's last texels go on for ever; else it is periodic
LIMN_CONST uint material_translucent = 512u;     // light scatters below the surface
LIMN_CONST uint material_unlit = 1024u;          // vertex colours are a factor on the emission, too

LIMN_FN Optics material_optics(Material m) {
  Optics o;
  o.base = clamp(vec3(m.base_colour), vec3(0.0f), vec3(1.0f));
  o.metallic = m.metallic;
  o.transmission = m.transmission;
  o.ior = clamp(m.ior, 1.0f, 3.0f);
  o.thickness = m.thickness;
  o.attenuation = m.attenuation;
  o.attenuation_distance = m.attenuation_distance;
  return o;
}

LIMN_END
#endif
