// Irradiance of one photon on the surface that a pixel of the screen shows, or a texel of the light's map (CAUSTIC_MAP 1):
// Epanechnikov's kernel over the distance across the ray, in an ellipse as the rays beside it have it (photon differentials:
// Schjoeth et al. 2007). TRANSLUCENT 1: some surfaces of the screen are translucent.
#if CAUSTIC_MAP
#include "techniques/surface_caustics/caustic_map.glsl"

uniform int map_layer;
#else
#include "glsl/surface/gbuffer_input.glsl"
#endif
#if TRANSLUCENT
#include "glsl/diffusion/boundary.glsl"
#endif

layout(location = 0) flat in vec4 photon;
layout(location = 1) flat in vec3 peak;
layout(location = 2) flat in vec4 incidence;
layout(location = 3) flat in vec3 kernel_x;
layout(location = 4) flat in vec3 kernel_y;

layout(location = 0) out vec4 irradiance;

#if TRANSLUCENT

// How much of light at this cosine enters a translucent surface, over the mean of light from all sides, which reflect.comp.glsl
// takes. 1 for other surfaces.
float entering_over_mean(ivec2 pixel, float cosine) {
  vec4 constants = texelFetch(gbuffer_material, pixel, 0);
  if ((gbuffer_stored_flags(constants) & gbuffer_flag_translucent) == 0u) return 1.0;
  DiffusionBoundary boundary = diffusion_boundary(gbuffer_stored_ior(constants));
  return diffusion_entry(boundary, cosine) / boundary.entering;
}

#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
#if CAUSTIC_MAP
  MapSurface surface = map_surface(scene_views[map_layer], pixel);
  float cosine = surface.present ? incidence.w : 0.0;
  vec3 away = surface.position - photon.xyz;
#else
  float depth = pixel_depth(pixel);
  // From before the triangle, with the cosine of the shading normal (Veach 1997, section 5.3).
  bool lit = depth > 0.0 && dot(pixel_geometric_normal(pixel), incidence.xyz) < 0.0;
  float cosine = lit ? -dot(pixel_normal(pixel), incidence.xyz) : 0.0;
  vec3 away = pixel_position(pixel, depth) - photon.xyz;
#endif
  vec2 at = vec2(dot(away, kernel_x), dot(away, kernel_y));
  float square = dot(at, at);
  // Along the ray, no further than a plane goes within the kernel: not to what lies before or behind.
  bool near = abs(dot(away, incidence.xyz)) * incidence.w <= photon.w;
  if (!(cosine > 0.0 && near && square < 1.0)) discard;
#if TRANSLUCENT
  cosine *= entering_over_mean(pixel, cosine);
#endif
  irradiance = vec4(peak * (cosine * (1.0 - square)), 0.0);
}
