// The piece of a caustic ray that the camera can see, and the beam around it: what decides how it is drawn. For shaders that have
// the caustic-ray buffer and the frame block. BEAMS 0: no beams.
#ifndef LIMN_RAY_SHAPE_GLSL
#define LIMN_RAY_SHAPE_GLSL
#include "glsl/caustics/caustic_line.glsl"
#include "glsl/caustics/ray_beam.glsl"
#include "glsl/caustics/ray_runs.glsl"
#include "glsl/media/medium_input.glsl"

uniform float near_plane;  // metres

const uint ray_kind_line = 0u;   // of one pixel
const uint ray_kind_point = 1u;  // shorter than a pixel
const uint ray_kind_quad = 2u;   // as wide as its beam, which is wider than a pixel

vec3 camera_space(vec3 world) {
  vec3 view = (frame.world_to_view * vec4(world, 1.0)).xyz;
  return vec3(view.xy, -view.z);
}
vec3 camera_direction(vec3 world) {
  vec3 view = mat3(frame.world_to_view) * world;
  return vec3(view.xy, -view.z);
}
float focal_length() { return 1.0 / length(frame.view_ray_dx.xyz); }  // pixels

// In camera space, metres.
struct RayPiece {
  vec3 origin;     // of the ray
  vec3 direction;
  vec2 range;      // along it, from and to; from >= to: there is nothing to see
  vec3 a;          // the ends
  vec3 b;
  vec2 axis;       // unit, on the view plane, from a to b
  float pixels;    // between them
};

RayPiece ray_piece(CausticRay ray) {
  RayPiece p;
  p.origin = camera_space(ray.start);
  p.direction = camera_direction(ray.direction);
  p.range = ray.kind == caustic_ray_none ? vec2(0.0) : vec2(0.0, ray.segment_length);
  // The part beyond the near plane.
  float to_near = (near_plane - p.origin.z) / p.direction.z;
  if (p.direction.z > 0.0) p.range.x = max(p.range.x, to_near);
  if (p.direction.z < 0.0) p.range.y = min(p.range.y, to_near);
  if (p.direction.z == 0.0 && p.origin.z < near_plane) p.range = vec2(0.0);
#if MEDIUM_STEPS > 0
  vec2 medium = medium_range(scene_medium(), ray.start, ray.direction);
  p.range = vec2(max(p.range.x, medium.x), min(p.range.y, medium.y));
#endif
  p.a = p.origin + p.range.x * p.direction;
  p.b = p.origin + p.range.y * p.direction;
  vec2 along = p.b.xy / p.b.z - p.a.xy / p.a.z;
  p.pixels = length(along) * focal_length();
  p.axis = p.pixels > 0.0 ? along / length(along) : vec2(1.0, 0.0);
  return p;
}

#if BEAMS

// Sides of the beam at the ends of the piece, camera space.
struct RayBeam {
  vec3 u_near;
  vec3 v_near;
  vec3 u_far;
  vec3 v_far;
};

RayBeam ray_beam(int index, CausticRay ray, RayPiece p) {
  BeamNeighbours to = beam_neighbours(index);
  RayBeam beam;
  beam.u_near = camera_direction(beam_side(ray, to.beside, p.range.x));
  beam.v_near = camera_direction(beam_side(ray, to.above, p.range.x));
  beam.u_far = camera_direction(beam_side(ray, to.beside, p.range.y));
  beam.v_far = camera_direction(beam_side(ray, to.above, p.range.y));
  return beam;
}

// Widths in pixels of the beam's sides u and v, at a share of the way from a to b; each goes through 0 to below where the side
// turns over.
vec2 beam_widths(RayBeam beam, RayPiece p, float share) {
  vec3 u = mix(beam.u_near, beam.u_far, share);
  vec3 v = mix(beam.v_near, beam.v_far, share);
  vec3 x = mix(p.a, p.b, share);
  vec3 normal = cross(p.direction, x);
  float size = length(normal);
  if (!(size > 0.0)) return vec2(0.0);
  normal /= size;
  vec2 across = vec2(-p.axis.y, p.axis.x);
  float per_metre = abs(dot(caustic_line_rate(x, normal), across)) * focal_length() / x.z;
  return vec2(dot(u, normal), dot(v, normal)) * per_metre;
}

float beam_width(RayBeam beam, RayPiece p, float share) {
  vec2 widths = abs(beam_widths(beam, p, share));
  return widths.x + widths.y;
}

#endif

#endif  // LIMN_RAY_SHAPE_GLSL
