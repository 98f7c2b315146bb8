// Caustic rays as primitives. KIND 0: lines of one pixel; 1: points, for lines shorter than a pixel; 2: quads as wide as
// their beam, for those wider than a pixel. Each kind leaves the others' rays out. BEAMS 0: no quads, lines stand for all.
#include "glsl/caustic_line.glsl"
#include "glsl/caustics/ray_beam.glsl"
#include "glsl/medium_input.glsl"

layout(std430, binding = 1) readonly buffer LineRule { uint line_fragments; };
uniform float near_plane;  // metres

layout(location = 0) flat out int ray_index;
layout(location = 1) flat out vec3 line_origin;     // camera space, metres
layout(location = 2) flat out vec3 line_direction;
layout(location = 3) flat out vec2 line_axis;       // unit, on the view plane: along the line, or along its larger component
layout(location = 4) flat out vec3 line_range;      // x, y: from and to, metres along the ray; z: weight of a point
layout(location = 5) out vec2 line_width;  // width in pixels times depth, and depth: their ratio is linear on the screen

const float widest_point = 64.0;

vec3 camera_space(vec3 world) {
  vec3 view = (frame.world_to_view * vec4(world, 1.0)).xyz;
  return vec3(view.xy, -view.z);
}
vec3 camera_direction(vec3 world) {
  vec3 view = mat3(frame.world_to_view) * world;
  return vec3(view.xy, -view.z);
}

#if KIND == 0
// In [-1/2, 1/2), even among rays that are neighbours in the buffer (Roberts 2018, as r2_sequence).
float share_of_column(int index) {
  uint at = uint(index % buffer_size) * 3242174889u + uint(index / buffer_size) * 2447445414u;
  return float(at >> 8) * 5.9604644775390625e-8 - 0.5;
}
#endif

void leave_out() { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); }

// `slope`: place on the view plane at distance 1.
vec4 clip_position(vec2 slope, float depth) {
  vec2 half_size = 0.5 * vec2(frame.frame_size.xy) * vec2(length(frame.view_ray_dx.xyz), length(frame.view_ray_dy.xyz));
  return vec4(slope / half_size * depth, 0.0, depth);
}

// Width in pixels of the beam at l metres along the ray, seen from the camera; across: unit, on the view plane.
struct BeamWidth {
  vec3 u_near;
  vec3 v_near;
  vec3 u_far;
  vec3 v_far;
};

float width_of(BeamWidth beam, float share, vec3 x, vec3 direction, vec2 across, float focal) {
  vec3 u = mix(beam.u_near, beam.u_far, share);
  vec3 v = mix(beam.v_near, beam.v_far, share);
  vec3 normal = cross(direction, x);
  float size = length(normal);
  if (!(size > 0.0)) return 0.0;
  normal /= size;
  float per_metre = abs(dot(caustic_line_rate(x, normal), across)) * focal / x.z;
  return (abs(dot(u, normal)) + abs(dot(v, normal))) * per_metre;
}

void main() {
#if KIND == 0
  int index = gl_VertexID >> 1;
  int column = gl_VertexID & 1;
#elif KIND == 1
  int index = gl_VertexID;
  int column = 0;
#else
  int index = gl_InstanceID;
  int column = gl_VertexID >> 1;
#endif
  CausticRay ray = rays[index];
  ray_index = index;
  line_range = vec3(0.0, ray.start.w, 0.0);
  line_origin = camera_space(ray.start.xyz);
  line_direction = camera_direction(ray.direction.xyz);
  line_axis = vec2(1.0, 0.0);
  line_width = vec2(1.0);
  leave_out();
  if (ray.direction.w == caustic_ray_none || !(ray.start.w > 0.0)) return;

  // The part beyond the near plane.
  float to_near = (near_plane - line_origin.z) / line_direction.z;
  if (line_direction.z > 0.0) line_range.x = max(line_range.x, to_near);
  if (line_direction.z < 0.0) line_range.y = min(line_range.y, to_near);
  if (line_direction.z == 0.0 && line_origin.z < near_plane) return;
#if MEDIUM_STEPS > 0
  vec2 medium = medium_range(scene_medium(), ray.start.xyz, ray.direction.xyz);
  line_range.xy = vec2(max(line_range.x, medium.x), min(line_range.y, medium.y));
#endif
  if (!(line_range.x < line_range.y)) return;
  vec3 a = line_origin + line_range.x * line_direction;
  vec3 b = line_origin + line_range.y * line_direction;
  float focal = 1.0 / length(frame.view_ray_dx.xyz);
  vec2 from = a.xy / a.z;
  vec2 along = b.xy / b.z - from;
  float pixels = length(along) * focal;
  bool point = !(pixels >= 1.0);

  float width_a = 0.0;
  float width_b = 0.0;
  vec2 axis = pixels > 0.0 ? along / length(along) : vec2(1.0, 0.0);
#if BEAMS
  int x = index % buffer_size;
  int y = index / buffer_size % buffer_size;
  CausticRay beside = rays[beam_neighbour(index, 1, x)];
  CausticRay above = rays[beam_neighbour(index, buffer_size, y)];
  BeamWidth beam;
  beam.u_near = camera_direction(beam_side(ray, beside, line_range.x));
  beam.v_near = camera_direction(beam_side(ray, above, line_range.x));
  beam.u_far = camera_direction(beam_side(ray, beside, line_range.y));
  beam.v_far = camera_direction(beam_side(ray, above, line_range.y));
  vec2 across = vec2(-axis.y, axis.x);
  width_a = width_of(beam, 0.0, a, line_direction, across, focal);
  width_b = width_of(beam, 1.0, b, line_direction, across, focal);
#endif
  bool wide = max(width_a, width_b) > 1.0 && !point;

#if KIND == 0
  if (point || wide) return;
  vec2 forwards = vec2(axis.x < 0.0 ? -1.0 : 1.0, axis.y < 0.0 ? -1.0 : 1.0);
  bool steep = abs(axis.x) < abs(axis.y);
  bool rectangle = line_fragments > 850u;
  line_axis = rectangle ? axis : forwards * (steep ? vec2(0.0, 1.0) : vec2(1.0, 0.0));
  // In pixels along the larger component: a pixel beyond the end, so that every pixel that the line touches has a fragment.
  float beyond = column == 0 ? -1.0 : 1.0;
  vec2 step = axis / (focal * max(abs(axis.x), abs(axis.y)));
  // A fragment is in the row where the line passes the middle of its column, however much of it is in the next row. So
  // each line is moved across by what it rises over a share of a column, an even spread among neighbours: together they lie
  // in the pixels where their light does.
  vec2 rise = rectangle ? vec2(0.0) : step - dot(step, line_axis) * line_axis;
  vec3 end = column == 0 ? a : b;
  gl_Position = clip_position(end.xy / end.z + beyond * step + rise * share_of_column(index), end.z);
#elif KIND == 1
  if (!point) return;
  vec3 middle = 0.5 * (a + b);
  float size = 1.0;
#if BEAMS
  vec3 u = 0.5 * (beam.u_near + beam.u_far);
  vec3 v = 0.5 * (beam.v_near + beam.v_far);
  size = clamp(sqrt(length(cross(u, v))) * focal / middle.z, 1.0, widest_point);
#endif
  line_range.z = caustic_point_weight(a, b, focal) / (size * size);
  gl_PointSize = size;
  gl_Position = clip_position(middle.xy / middle.z, middle.z);
#else
  if (!wide) return;
  line_axis = axis;
  // Three columns of two corners: the ends, half a pixel further, and where the beam is narrowest.
  float share = column == 0 ? 0.0 : 1.0;
#if BEAMS
  if (column == 1) {
    vec3 normal = normalize(cross(line_direction, 0.5 * (a + b)));
    vec2 u = vec2(dot(beam.u_near, normal), dot(beam.u_far, normal));
    vec2 v = vec2(dot(beam.v_near, normal), dot(beam.v_far, normal));
    float at_u = u.x != u.y ? clamp(u.x / (u.x - u.y), 0.0, 1.0) : 0.5;
    float at_v = v.x != v.y ? clamp(v.x / (v.x - v.y), 0.0, 1.0) : 0.5;
    float sum_u = abs(mix(u.x, u.y, at_u)) + abs(mix(v.x, v.y, at_u));
    float sum_v = abs(mix(u.x, u.y, at_v)) + abs(mix(v.x, v.y, at_v));
    share = sum_u < sum_v ? at_u : at_v;
  }
  vec3 corner = mix(a, b, share);
  float size = max(width_of(beam, share, corner, line_direction, across, focal), 1.0);
  line_width = vec2(size * corner.z, corner.z);
  float side = (gl_VertexID & 1) == 0 ? 0.5 : -0.5;
  vec2 beyond = axis * (0.5 * float(column - 1));
  gl_Position = clip_position(corner.xy / corner.z + (beyond + across * (side * size)) / focal, corner.z);
#endif
#endif
}
