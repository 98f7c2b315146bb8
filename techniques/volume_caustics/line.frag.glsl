// Light of a caustic ray that the medium scatters towards the camera. STEPS: regular points of the viewing ray that share
// it (thesis, section 8.3.3); 1: the light ray's own point.
#include "glsl/caustics/line_fragment.glsl"

// Density at `distance` on the viewing ray, times the transmittance from there to the camera.
vec3 scattering_seen(Medium medium, vec3 direction, float distance) {
  vec3 eye = frame.camera_position.xyz;
  float density = medium_density(eye + distance * direction);
  if (density == 0.0) return vec3(0.0);
  return density * medium_transmittance(medium, medium_length(medium, eye, direction, distance));
}

#if STEPS > 1
uniform float step_size;      // scene radii
uniform float filter_radius;  // steps

// Mean of density and transmittance to the camera over the STEPS regular points of the viewing ray around `distance`, by a
// Gaussian of standard deviation filter_radius / 2 that is divided by the sum of its weights.
vec3 shared_scattering(Medium medium, vec3 direction, float distance) {
  float size = step_size * frame.scene_radius;
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
    sum += weight * scattering_seen(medium, direction, at * size);
    total += weight;
  }
  return sum / total;
}
#endif

vec3 scattered_at(Medium medium, CausticRay ray, LineFragment f) {
  vec3 place = ray.start + f.along * ray.direction;
  vec3 from_eye = place - frame.camera_position.xyz;
  float distance = length(from_eye);
  vec3 direction = from_eye / distance;
#if STEPS > 1
  vec3 seen = shared_scattering(medium, direction, distance);
#else
  vec3 seen = scattering_seen(medium, direction, distance);
#endif
  if (seen == vec3(0.0)) return vec3(0.0);
  vec3 arriving = ray.power * medium_transmittance(medium, line_medium_length(medium, ray, f));
  float phase = phase_function(medium.g, ray.direction, -direction);
  return arriving * medium.scattering * seen * (phase * line_weight(f));
}
