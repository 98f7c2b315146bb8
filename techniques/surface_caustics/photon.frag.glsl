// Irradiance of one photon on the surface that a pixel of the screen shows, or a texel of the light's map (CAUSTIC_MAP 1):
// Epanechnikov's kernel over the distance in space.
#if CAUSTIC_MAP
#include "techniques/surface_caustics/caustic_map.glsl"

uniform int map_layer;
#else
#include "glsl/gbuffer_input.glsl"
#endif

layout(location = 0) flat in vec4 photon;
layout(location = 1) flat in vec3 flux;
layout(location = 2) flat in vec3 incidence;

layout(location = 0) out vec4 irradiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
#if CAUSTIC_MAP
  MapSurface surface = map_surface(scene_views[map_layer], pixel);
  bool lit = surface.present;
  vec3 away = surface.position - photon.xyz;
#else
  float depth = pixel_depth(pixel);
  bool lit = depth > 0.0 && dot(pixel_geometric_normal(pixel), incidence) < 0.0;
  vec3 away = pixel_position(pixel, depth) - photon.xyz;
#endif
  float square = dot(away, away) / (photon.w * photon.w);
  if (!(lit && square < 1.0)) discard;
  irradiance = vec4(flux * (2.0 * inverse_pi / (photon.w * photon.w) * (1.0 - square)), 0.0);
}
