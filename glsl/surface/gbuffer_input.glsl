// The G-buffer as the compute passes of the frame read it: samplers, the surface of a pixel, its position.
#ifndef LIMN_GBUFFER_INPUT_GLSL
#define LIMN_GBUFFER_INPUT_GLSL
#include "glsl/scene/blocks.glsl"
#include "glsl/surface/gbuffer.glsl"

uniform sampler2D gbuffer_depth;
uniform sampler2D gbuffer_normal;
uniform sampler2D gbuffer_geometric_normal;
uniform sampler2D gbuffer_albedo;
uniform sampler2D gbuffer_material;
uniform sampler2D gbuffer_emission;
uniform usampler2D gbuffer_instance;

// Metres along the view axis; 0: no coverage.
float pixel_depth(ivec2 pixel) { return texelFetch(gbuffer_depth, pixel, 0).x; }

GBufferSurface pixel_surface(ivec2 pixel) {
  GBufferTexels t;
  t.normal = texelFetch(gbuffer_normal, pixel, 0).xy;
  t.geometric_normal = texelFetch(gbuffer_geometric_normal, pixel, 0).xy;
  t.albedo = texelFetch(gbuffer_albedo, pixel, 0);
  t.material = texelFetch(gbuffer_material, pixel, 0);
  t.emission = texelFetch(gbuffer_emission, pixel, 0);
  return gbuffer_unpack(t);
}

// Index of the draw instance, no_instance where there is none.
uint pixel_instance(ivec2 pixel) { return texelFetch(gbuffer_instance, pixel, 0).x; }

// Whether the pixel shows the light's own surface. Its instance is fetched only where the light has one.
bool pixel_shows_light(ivec2 pixel, Light light) {
  return light.own_instance != no_instance && light_is_instance(light, pixel_instance(pixel));
}

vec3 pixel_normal(ivec2 pixel) { return octahedral_decode(texelFetch(gbuffer_normal, pixel, 0).xy); }
vec3 pixel_geometric_normal(ivec2 pixel) {
  return octahedral_decode(texelFetch(gbuffer_geometric_normal, pixel, 0).xy);
}

// World direction through a pixel's centre, not normalised: one metre long along the view axis.
vec3 pixel_ray(ivec2 pixel) {
  return frame.view_ray_origin.xyz + float(pixel.x) * frame.view_ray_dx.xyz + float(pixel.y) * frame.view_ray_dy.xyz;
}

vec3 pixel_position(ivec2 pixel, float depth) { return frame.camera_position.xyz + depth * pixel_ray(pixel); }

#endif
