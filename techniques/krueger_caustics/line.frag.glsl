// A line of light as Krueger et al. draw it: all fragments of all lines have one weight, wherever they lie and however the
// line runs, and the medium scatters alike in all directions. ATTENUATION 1: it takes light along the line and on the way to
// the eye, as the thesis adds it (section 8.5.1).
#include "glsl/caustics/line_fragment.glsl"
#include "glsl/caustics/line_rule.glsl"

uniform float objects_distance;  // of the specular objects from the camera, metres
uniform float scale;

vec3 scattered_at(Medium medium, CausticRay ray, LineFragment f) {
  vec3 place = ray.start + f.along * ray.direction;
  vec3 arriving = ray.power * medium_density(place);
#if ATTENUATION
  vec3 eye = frame.camera_position.xyz;
  float inside = line_medium_length(medium, ray, f) + medium_length_between(medium, eye, place);
  arriving *= medium_transmittance(medium, inside);
#endif
  float focal = 1.0 / length(frame.view_ray_dx.xyz);
  float weight = scale * f.share * caustic_even_weight(objects_distance, focal, lines_are_rectangles());
  return arriving * medium.scattering * (weight * 0.25 * inverse_pi);
}
