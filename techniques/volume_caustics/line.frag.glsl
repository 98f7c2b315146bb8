// Light of a caustic ray that the medium scatters towards the camera. STEPS: regular points of the viewing ray that share
// it (thesis, section 8.3.3); 1: the light ray's own point.
#include "glsl/caustics/line_fragment.glsl"

#if STEPS > 1
uniform float step_size;      // scene radii
uniform float filter_radius;  // steps

// Mean transmittance to the camera over the STEPS regular points of the viewing ray around `distance`, by a Gaussian of
// standard deviation filter_radius / 2 that is divided by the sum of its weights.
vec3 shared_transmittance(Medium medium, vec3 direction, float distance) {
  float size = step_size * frame.environment.w;
  float first = floor(distance / size - 0.5 * float(STEPS) + 1.0);
  vec3 sum = vec3(0.0);
  float total = 0.0;
  float nearest = 1e30;
  for (int i = 0; i < STEPS; ++i) nearest = min(nearest, abs(first + float(i) - distance / size));
  for (int i = 0; i < STEPS; ++i) {
    float at = max(first + float(i), 0.0);
    float away = (at - distance / size) / filter_radius;
    float closest = nearest / filter_radius;
    float weight = exp(-2.0 * (away * away - closest * closest));
    sum += weight * medium_transmittance(medium, ball_length(medium.ball, frame.camera_position.xyz, direction, at * size));
    total += weight;
  }
  return sum / total;
}
#endif

void main() {
  LineFragment f = line_fragment();
  if (f.hidden) discard;
  CausticRay ray = rays[ray_index];
  Medium medium = scene_medium();
  vec3 place = ray.start.xyz + f.along * ray.direction.xyz;
  vec3 from_eye = place - frame.camera_position.xyz;
  float distance = length(from_eye);
  vec3 direction = from_eye / distance;
#if STEPS > 1
  vec3 to_eye = shared_transmittance(medium, direction, distance);
#else
  vec3 to_eye = medium_transmittance(medium, ball_length(medium.ball, frame.camera_position.xyz, direction, distance));
#endif
  vec3 arriving = ray.power.rgb * medium_transmittance(medium, f.along);
  float phase = phase_function(medium.g, ray.direction.xyz, -direction);
  radiance = vec4(arriving * medium.scattering * to_eye * (phase * line_weight(f)), 0.0);
}
