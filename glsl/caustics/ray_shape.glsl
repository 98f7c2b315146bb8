// The piece of a caustic ray that the camera can see, and the beam around it: what decides how it is drawn. For shaders that have
// the caustic-ray buffer and the frame block. BEAMS 0: no beams.
#ifndef LIMN_RAY_SHAPE_GLSL
#define LIMN_RAY_SHAPE_GLSL
#include "glsl/caustics/caustic_line.glsl"
#include "glsl/caustics/ray_beam.glsl"
#include "glsl/caustics/ray_runs.glsl"
#include "glsl/caustics/sample_shift.glsl"
#include "glsl/media/medium_input.glsl"

uniform float near_plane;  // metres

const uint ray_kind_line = 0u;   // of one pixel
const uint ray_kind_point = 1u;  // shorter than a pixel
const uint ray_kind_quad = 2u;   // as wide as its beam, which is wider than a pixel

vec3 camera_axes(vec3 view) { return vec3(view.xy - sample_shift() * view.z, -view.z); }
vec3 camera_space(vec3 world) { return camera_axes((frame.world_to_view * vec4(world, 1.0)).xyz); }
vec3 camera_direction(vec3 world) { return camera_axes(mat3(frame.world_to_view) * world); }
float focal_length() { return 1.0 / length(frame.view_ray_dx.xyz); }  // pixels
// Of the picture, half of it, on the view plane at distance 1.
vec2 picture_reach() {
  return 0.5 * vec2(frame.frame_size) * vec2(length(frame.view_ray_dx.xyz), length(frame.view_ray_dy.xyz));
}

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

// Metres along the ray, from and to; from >= to: there is nothing to see.
vec2 ray_range(CausticRay ray) {
  vec3 origin = camera_space(ray.start);
  vec3 direction = camera_direction(ray.direction);
  vec2 range = ray.kind == caustic_ray_none ? vec2(0.0) : vec2(0.0, ray.segment_length);
  // The part beyond the near plane.
  float to_near = (near_plane - origin.z) / direction.z;
  if (direction.z > 0.0) range.x = max(range.x, to_near);
  if (direction.z < 0.0) range.y = min(range.y, to_near);
  if (direction.z == 0.0 && origin.z < near_plane) range = vec2(0.0);
#if MEDIUM_STEPS > 0
  vec2 medium = medium_range(scene_medium(), ray.start, ray.direction);
  range = vec2(max(range.x, medium.x), min(range.y, medium.y));
#endif
  return range;
}

RayPiece ray_piece(CausticRay ray, vec2 range) {
  RayPiece p;
  p.origin = camera_space(ray.start);
  p.direction = camera_direction(ray.direction);
  p.range = range;
  p.a = p.origin + p.range.x * p.direction;
  p.b = p.origin + p.range.y * p.direction;
  vec2 along = p.b.xy / p.b.z - p.a.xy / p.a.z;
  p.pixels = length(along) * focal_length();
  p.axis = p.pixels > 0.0 ? along / length(along) : vec2(1.0, 0.0);
  return p;
}

#if BEAMS

// Sides of the beam at the ends of the piece, camera space.
struct BeamSides {
  vec3 u_near;
  vec3 v_near;
  vec3 u_far;
  vec3 v_far;
};

BeamSides beam_sides(int index, CausticRay ray, RayPiece p) {
  BeamNeighbours to = beam_neighbours(index);
  BeamSides sides;
  sides.u_near = camera_direction(beam_side(ray, to.beside, p.range.x));
  sides.v_near = camera_direction(beam_side(ray, to.above, p.range.x));
  sides.u_far = camera_direction(beam_side(ray, to.beside, p.range.y));
  sides.v_far = camera_direction(beam_side(ray, to.above, p.range.y));
  return sides;
}

// Whether some of a beam lies on the inner side of each plane through the eye and a side of the picture. beam_widths() takes the
// picture of a beam to be even in its sides, which is wrong where they reach past the eye: of an eye among parallel beams, those
// to the left and right of it would each cover the whole picture, which would be twice or three times as bright as it is.
bool beam_in_picture(BeamSides sides, RayPiece p) {
  vec2 reach = picture_reach();
  for (int i = 0; i < 4; ++i) {
    float side = (i & 1) == 0 ? 1.0 : -1.0;
    vec3 inwards = i < 2 ? vec3(side, 0.0, reach.x) : vec3(0.0, side, reach.y);
    float near = dot(inwards, p.a) + 0.5 * (abs(dot(inwards, sides.u_near)) + abs(dot(inwards, sides.v_near)));
    float far = dot(inwards, p.b) + 0.5 * (abs(dot(inwards, sides.u_far)) + abs(dot(inwards, sides.v_far)));
    if (max(near, far) <= 0.0) return false;
  }
  return true;
}

// Unit, perpendicular to the plane through the eye and the line; 0: the line goes through the eye.
vec3 line_normal(RayPiece p) {
  vec3 normal = cross(p.direction, 0.5 * (p.a + p.b));
  float size = length(normal);
  return size > 0.0 ? normal / size : vec3(0.0);
}

RayBeam ray_beam(BeamSides sides, RayPiece p) {
  vec3 normal = line_normal(p);
  vec2 u = vec2(dot(sides.u_near, normal), dot(sides.u_far, normal));
  vec2 v = vec2(dot(sides.v_near, normal), dot(sides.v_far, normal));
  return RayBeam(p.range, caustic_beam_narrowest(u, v), 0.0, vec4(u.x, v.x, u.y, v.y));
}

// Widths in pixels of the beam's sides u and v, at a share of the way from a to b; each goes through 0 to below where the side
// turns over.
vec2 beam_widths(RayBeam beam, RayPiece p, float share) {
  vec3 x = mix(p.a, p.b, share);
  vec2 across = vec2(-p.axis.y, p.axis.x);
  float per_metre = abs(dot(caustic_line_rate(x, line_normal(p)), across)) * focal_length() / x.z;
  return mix(beam.sides.xy, beam.sides.zw, share) * per_metre;
}

float beam_width(RayBeam beam, RayPiece p, float share) {
  vec2 widths = abs(beam_widths(beam, p, share));
  return widths.x + widths.y;
}

#endif

#endif  // LIMN_RAY_SHAPE_GLSL
