// Irradiance of one photon on the surface that a pixel shows: Epanechnikov's kernel over the distance in space.
#include "glsl/gbuffer_input.glsl"

layout(location = 0) flat in vec4 photon;
layout(location = 1) flat in vec3 flux;
layout(location = 2) flat in vec3 incidence;

layout(location = 0) out vec4 irradiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = pixel_depth(pixel);
  vec3 away = pixel_position(pixel, depth) - photon.xyz;
  float square = dot(away, away) / (photon.w * photon.w);
  if (depth == 0.0 || !(square < 1.0) || dot(pixel_geometric_normal(pixel), incidence) >= 0.0) discard;
  irradiance = vec4(flux * (2.0 * inverse_pi / (photon.w * photon.w) * (1.0 - square)), 0.0);
}
