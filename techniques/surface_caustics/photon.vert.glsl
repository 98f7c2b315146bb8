// Photons as triangles: each lies on the surface that its ray meets, around its kernel. CAUSTIC_MAP 0: on the screen; 1: in one
// layer of the light's map.
#include "glsl/caustics/listed_ray.glsl"
#include "glsl/caustics/ray_beam.glsl"
#include "glsl/surface/gbuffer.glsl"
#include "glsl/media/medium_input.glsl"
#include "techniques/surface_caustics/on_plane.glsl"
#if CAUSTIC_MAP
#include "techniques/surface_caustics/caustic_map.glsl"

uniform int map_layer;
#else
#include "glsl/caustics/sample_shift.glsl"
#endif

uniform float kernel;  // half-diameters in distances between photons

// The kernel is Epanechnikov's over an ellipse across the ray: at an offset from the photon the irradiance across the ray is
// peak (1 - (offset . kernel_x)^2 - (offset . kernel_y)^2).
layout(location = 0) flat out vec4 photon;      // xyz: place; w: longer half-axis, m
layout(location = 1) flat out vec3 peak;        // W/m^2, across the ray
layout(location = 2) flat out vec4 incidence;   // xyz: unit, of propagation; w: |cosine| of incidence
layout(location = 3) flat out vec3 kernel_x;    // the ellipse's axes over the squares of their halves, 1/m
layout(location = 4) flat out vec3 kernel_y;

const float box_radius = 0.7071;  // of the kernel with the second moments of a square pixel, in its sides
const float least_cosine = 0.02;  // no kernel and no pixel is stretched further than by its inverse

const vec2 corners[3] = vec2[3](vec2(2.0, 0.0), vec2(-1.0, 1.7320509), vec2(-1.0, -1.7320509));  // around the unit circle

// What the picture or the map shows about a place.
struct Target {
  vec3 eye_ray;   // unit, towards the place
  vec3 pixel_x;   // sides of a pixel on a plane through the place that faces the eye, m
  vec3 pixel_y;
};

#if CAUSTIC_MAP
Target target_at(vec3 place) {
  ShadowView view = scene_views[map_layer];
  float across = shadow_footprint(view, shadow_view_depth(view, place));
  vec3 ray = view.projection == shadow_orthographic ? view.axis_z : normalize(place - view.origin);
  return Target(ray, across * view.axis_x, across * view.axis_y);
}
vec4 target_clip(vec3 place) { return shadow_clip(scene_views[map_layer], place); }
#else
Target target_at(vec3 place) {
  float depth = -(frame.world_to_view * vec4(place, 1.0)).z;
  return Target(normalize(place - frame.camera_position.xyz), depth * frame.view_ray_dx.xyz, depth * frame.view_ray_dy.xyz);
}
vec4 target_clip(vec3 place) { return frame.world_to_clip * vec4(place, 1.0); }
#endif

// An ellipse in the plane across a ray.
struct Ellipse {
  vec3 axis;  // unit, the longer one
  vec2 size;  // half-axes, m, the longer one first
};

// Of the second moments that `sides` have together: two alone are conjugate half-diameters. Eigenvectors and eigenvalues of the
// sum of their squares in the plane across `direction`, onto which they are projected along it. The determinant is summed from
// squares (Cauchy and Binet), so that a thin ellipse is not lost to rounding.
Ellipse ellipse(vec3 sides[4], vec3 direction) {
  vec3 s = normalize(cross(direction, abs(direction.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  vec3 t = cross(direction, s);
  float xx = 0.0;
  float xy = 0.0;
  float yy = 0.0;
  float determinant = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec2 a = vec2(dot(sides[i], s), dot(sides[i], t));
    xx += a.x * a.x;
    xy += a.x * a.y;
    yy += a.y * a.y;
    for (int j = 0; j < i; ++j) {
      float area = a.x * dot(sides[j], t) - a.y * dot(sides[j], s);
      determinant += area * area;
    }
  }
  float half_difference = 0.5 * (xx - yy);
  float larger = 0.5 * (xx + yy) + sqrt(half_difference * half_difference + xy * xy);
  vec2 way = xx >= yy ? vec2(larger - yy, xy) : vec2(xy, larger - xx);
  float size = length(way);
  vec3 axis = size > 0.0 ? (way.x * s + way.y * t) / size : s;
  return Ellipse(axis, sqrt(vec2(larger, determinant / larger)));
}

void main() {
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  int index = listed_ray(0u, gl_VertexID / 3);
  CausticRay ray = rays[index];
  photon = vec4(0.0);
  peak = vec3(0.0);
  incidence = vec4(ray.direction, 0.0);
  kernel_x = vec3(0.0);
  kernel_y = vec3(0.0);
  vec3 place = ray.start + ray.segment_length * ray.direction;
  vec3 normal = octahedral_decode(unpackSnorm2x16(ray.normal));
  incidence.w = -dot(normal, ray.direction);
  Target target = target_at(place);
#if !CAUSTIC_MAP
  // What a sample of a pixel sees lies aside of what its middle shows: as far as this moves the photon on its surface.
  vec2 pixels = sample_shift() / length(frame.view_ray_dx.xyz);
  place += on_plane(pixels.x * target.pixel_x + pixels.y * target.pixel_y, normal, target.eye_ray, least_cosine);
#endif
  Medium medium = scene_medium();
  vec3 flux = ray.power * medium_transmittance(medium, medium_length(medium, ray.start, ray.direction, ray.segment_length));

  BeamNeighbours to = beam_neighbours(index);
  vec3 pixel_x = box_radius * on_plane(target.pixel_x, normal, target.eye_ray, least_cosine);
  vec3 pixel_y = box_radius * on_plane(target.pixel_y, normal, target.eye_ray, least_cosine);
  vec3 beside = kernel * beam_side(ray, to.beside, ray.segment_length);
  vec3 above = kernel * beam_side(ray, to.above, ray.segment_length);
  Ellipse e = ellipse(vec3[4](beside, above, pixel_x, pixel_y), ray.direction);
  if (!(e.size.y > 0.0)) return;
  vec3 other_axis = cross(ray.direction, e.axis);
  photon = vec4(place, e.size.x);
  peak = flux * (2.0 * inverse_pi / (e.size.x * e.size.y));
  kernel_x = e.axis / e.size.x;
  kernel_y = other_axis / e.size.y;
  vec2 corner = corners[gl_VertexID % 3];
  vec3 across = corner.x * e.size.x * e.axis + corner.y * e.size.y * other_axis;
  vec4 clip = target_clip(place + on_plane(across, normal, ray.direction, least_cosine));
  gl_Position = vec4(clip.xy, 0.0, clip.w);
}
