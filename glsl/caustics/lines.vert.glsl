// Caustic rays as primitives. KIND 0: lines of one pixel; 1: points, for lines shorter than a pixel; 2: quads as wide as
// their beam, for those wider than a pixel. Each draws the rays of its own list (line_kinds.comp.glsl). BEAMS 0: no quads, lines
// stand for all.
#include "glsl/caustics/line_rule.glsl"
#include "glsl/caustics/listed_ray.glsl"
#include "glsl/caustics/ray_shape.glsl"
#include "glsl/numeric/sampling.glsl"

#if KIND == 2
layout(std430) readonly buffer RayBeams { RayBeam beams[]; };
#endif

layout(location = 0) flat out int ray_index;
layout(location = 1) flat out vec3 line_origin;     // camera space, metres
layout(location = 2) flat out vec3 line_direction;
layout(location = 3) flat out vec2 line_axis;       // unit, on the view plane: along the line, or along its larger component
layout(location = 4) flat out vec3 line_range;      // x, y: from and to, metres along the ray; z: weight of a point
layout(location = 5) out vec3 line_width;  // x, y: beam_widths() times depth, and z: depth, all three linear along the ray

const float widest_point = 64.0;

#if KIND == 0
// In [-1/2, 1/2), even among rays that are neighbours in the buffer (Roberts 2018, as r2_sequence).
float share_of_column(int index) {
  uint at = uint(index % buffer_size) * r2_step.x + uint(index / buffer_size) * r2_step.y;
  return float(at >> 8) * 5.9604644775390625e-8 - 0.5;
}
#endif

// `slope`: place on the view plane at distance 1.
vec4 clip_position(vec2 slope, float depth) { return vec4(slope / picture_reach() * depth, 0.0, depth); }

void main() {
#if KIND == 0
  int index = listed_ray(ray_kind_line, gl_VertexID >> 1);
  int column = gl_VertexID & 1;
#elif KIND == 1
  int index = listed_ray(ray_kind_point, gl_VertexID);
#else
  int index = listed_ray(ray_kind_quad, gl_InstanceID);
  int column = gl_VertexID >> 1;
#endif
  CausticRay ray = rays[index];
#if KIND == 2
  RayBeam beam = beams[index];
  RayPiece piece = ray_piece(ray, beam.range);
#else
  RayPiece piece = ray_piece(ray, ray_range(ray));
#endif
  vec3 a = piece.a;
  vec3 b = piece.b;
  float focal = focal_length();
  ray_index = index;
  line_origin = piece.origin;
  line_direction = piece.direction;
  line_axis = piece.axis;
  line_range = vec3(piece.range, 0.0);
  line_width = vec3(1.0);

#if KIND == 0
  vec2 forwards = vec2(piece.axis.x < 0.0 ? -1.0 : 1.0, piece.axis.y < 0.0 ? -1.0 : 1.0);
  bool steep = abs(piece.axis.x) < abs(piece.axis.y);
  bool rectangle = lines_are_rectangles();
  line_axis = rectangle ? piece.axis : forwards * (steep ? vec2(0.0, 1.0) : vec2(1.0, 0.0));
  // In pixels along the larger component: a pixel beyond the end, so that every pixel that the line touches has a fragment.
  float beyond = column == 0 ? -1.0 : 1.0;
  vec2 step = piece.axis / (focal * max(abs(piece.axis.x), abs(piece.axis.y)));
  // A fragment is in the row where the line passes the middle of its column, however much of it is in the next row. So
  // each line is moved across by what it rises over a share of a column, an even spread among neighbours: together they lie
  // in the pixels where their light does.
  vec2 rise = rectangle ? vec2(0.0) : step - dot(step, line_axis) * line_axis;
  vec3 end = column == 0 ? a : b;
  gl_Position = clip_position(end.xy / end.z + beyond * step + rise * share_of_column(index), end.z);
#elif KIND == 1
  vec3 middle = 0.5 * (a + b);
  float size = 1.0;
#if BEAMS
  BeamSides sides = beam_sides(index, ray, piece);
  vec3 u = 0.5 * (sides.u_near + sides.u_far);
  vec3 v = 0.5 * (sides.v_near + sides.v_far);
  size = clamp(sqrt(length(cross(u, v))) * focal / middle.z, 1.0, widest_point);
#endif
  line_range.z = caustic_point_weight(a, b, focal) / (size * size);
  gl_PointSize = size;
  gl_Position = clip_position(middle.xy / middle.z, middle.z);
#else
  // Three columns of two corners: the ends, half a pixel further, and where the beam is narrowest.
  float share = column == 0 ? 0.0 : column == 1 ? beam.narrowest : 1.0;
  vec3 corner = mix(a, b, share);
  vec2 widths = beam_widths(beam, piece, share);
  float size = abs(widths.x) + abs(widths.y) + 1.0;  // as far as caustic_beam_profile() reaches
  line_width = vec3(widths * corner.z, corner.z);
  float side = (gl_VertexID & 1) == 0 ? 0.5 : -0.5;
  vec2 across = vec2(-piece.axis.y, piece.axis.x);
  vec2 beyond = piece.axis * (0.5 * float(column - 1));
  gl_Position = clip_position(corner.xy / corner.z + (beyond + across * (side * size)) / focal, corner.z);
#endif
}
