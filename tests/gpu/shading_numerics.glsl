// One evaluation of every shading function, the same text for the compute shader and for the CPU.
#ifndef LIMN_SHADING_NUMERICS_GLSL
#define LIMN_SHADING_NUMERICS_GLSL
#include "glsl/surface/gbuffer.glsl"
#include "glsl/light/unshadowed_light.glsl"
LIMN_BEGIN

struct NumericsInput {
  vec3 base_colour;
  float metallic;
  float roughness;
  float specular_factor;
  float ior;
  float unused_0;
  vec3 random;  // for samplers
  float unused_1;
  vec4 normal;  // shading normal; geometric normal is +z
  vec4 view;
  vec4 incident;
  Light light;  // a rectangle
};

// Each vector is compared as a whole.
struct NumericsResult {
  vec4 reflected;   // brdf and pdf
  vec4 direction;   // sampled direction and specular probability
  vec4 rectangle;   // irradiance, solid angle, share above the horizon, vertices
  vec4 point;       // sample on the part above the horizon
  vec4 unshadowed;  // of the rectangle
  vec4 shape;       // of the table
  vec4 reflectance;
  vec4 colour;  // and roughness, through the G-buffer packing
};

LIMN_FN NumericsResult numerics(NumericsInput i) {
  NumericsResult r;
  vec3 n = vec3(i.normal);
  vec3 v = vec3(i.view);
  SurfaceBrdf s = surface_brdf(i.base_colour, i.metallic, i.roughness, i.specular_factor, vec3(1.0f), i.ior);
  r.reflected = vec4(brdf(s, n, v, vec3(i.incident)), brdf_pdf(s, n, v, vec3(i.incident)));
  r.direction = vec4(brdf_sample(s, n, v, i.random), brdf_specular_probability(s, dot(n, v)));
  Rectangle shape = rectangle_from(i.light, vec3(0.0f));
  RectanglePart part = rectangle_above(shape, n);
  r.rectangle = vec4(rectangle_irradiance(shape, n), rectangle_solid_angle(shape, part),
                     rectangle_part_share(part), float(part.count));
  vec2 ab = rectangle_part_sample(part, vec2(i.random.x, i.random.y));
  r.point = part.count > 0 ? vec4(rectangle_point(shape, ab), 1.0f) : vec4(0.0f);
  r.unshadowed = vec4(unshadowed_light(i.light, s, vec3(0.0f), n, vec3(0.0f, 0.0f, 1.0f), v), 0.0f);
  LtcTerms terms = ltc_lookup(dot(n, v), s.alpha);
  r.shape = terms.shape;
  r.reflectance = terms.reflectance;
  GBufferSurface surface;
  surface.normal = n;
  surface.geometric_normal = v;
  surface.base_colour = i.base_colour;
  surface.metallic = i.metallic;
  surface.roughness = i.roughness;
  surface.specular_factor = i.specular_factor;
  surface.specular_colour = i.base_colour;
  surface.ior = i.ior;
  surface.emission = i.base_colour;
  surface.flags = 1u;
  GBufferSurface unpacked = gbuffer_unpack(gbuffer_pack(surface));
  r.colour = vec4(unpacked.specular_colour + unpacked.base_colour + unpacked.normal, unpacked.roughness);
  return r;
}

LIMN_END
#endif
