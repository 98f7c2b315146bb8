// Photons as points: each where its ray meets a surface, as large as its kernel on the screen.
#include "glsl/caustics/ray_beam.glsl"
#include "glsl/medium_input.glsl"

uniform float kernel;  // radius in distances between photons

layout(location = 0) flat out vec4 photon;      // xyz: place; w: radius of the kernel, m
layout(location = 1) flat out vec3 flux;        // W
layout(location = 2) flat out vec3 incidence;   // unit, of propagation

const float widest_point = 64.0;     // pixels
const float least_radius = 1.0;      // pixels

void main() {
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = 1.0;
  int index = gl_VertexID;
  CausticRay ray = rays[index];
  photon = vec4(0.0);
  flux = vec3(0.0);
  incidence = ray.direction.xyz;
  if (ray.direction.w != caustic_ray_surface) return;
  vec3 place = ray.start.xyz + ray.start.w * ray.direction.xyz;
  float depth = -(frame.world_to_view * vec4(place, 1.0)).z;
  if (!(depth > 0.0)) return;
  Medium medium = scene_medium();
  flux = ray.power.rgb * medium_transmittance(medium, medium_length(medium, ray.start.xyz, ray.direction.xyz, ray.start.w));

  int x = index % buffer_size;
  int y = index / buffer_size % buffer_size;
  CausticRay beside = rays[beam_neighbour(index, 1, x)];
  CausticRay above = rays[beam_neighbour(index, buffer_size, y)];
  float distance = max(length(beam_side(ray, beside, ray.start.w)), length(beam_side(ray, above, ray.start.w)));
  float pixel = depth * length(frame.view_ray_dx.xyz);
  float radius = clamp(kernel * distance, least_radius * pixel, 0.5 * widest_point * pixel);
  photon = vec4(place, radius);
  gl_PointSize = 2.0 * radius / pixel + 2.0;
  vec4 clip = frame.world_to_clip * vec4(place, 1.0);
  gl_Position = vec4(clip.xy, 0.0, clip.w);
}
