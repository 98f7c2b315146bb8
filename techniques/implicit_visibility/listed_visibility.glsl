// V of a point by the triangles of a list (limn::radiosity::BlockerLists): which points of the light no triangle hides. The
// planes through the receiver and a triangle's edges are linear in where on the light a point lies, so that a triangle hides an
// interval of each row of points, which costs the same for 32 points as for one.
#ifndef LIMN_LISTED_VISIBILITY_GLSL
#define LIMN_LISTED_VISIBILITY_GLSL
#include "glsl/indirect/surface_leaf.glsl"
#include "glsl/light/light_view.glsl"

layout(std430) readonly buffer Leaves { Leaf leaves[]; };
layout(std430) readonly buffer Corners { uint corners[]; };
layout(std430) readonly buffer Lists { uint lists[]; };
layout(std430) readonly buffer Ranges { uvec2 ranges[]; };  // first and number, light after light
uniform float reach;  // as light_visibility.comp.glsl has it
uniform float unit;   // metres

const uint unlisted = 0xffffffffu;
const uint both_sides = 0x80000000u;  // of a triangle in a list: its back hides, too
const int light_rows = 8;
const int light_columns = 32;  // bits of a row

// Triangles whose plane is nearer to the receiver are its own: places are known to some 2^-21 of their size.
const float listed_clearance = 1.52587890625e-5;  // 2^-16

// The light's part that counts as a square of unit sides: place (u, v) is low + u * size_u + v * size_v in slopes. Row k of the
// points is (u, (k + u) / light_rows): tilted, so that outlines along the sides cross all heights.
struct LightSquare {
  vec3 low;
  vec3 size_u;
  vec3 size_v;
};

// Points of a row from x = column low to high, which may lie outside it.
uint row_bits(float low, float high) {
  uint first = uint(clamp(ceil(low), 0.0, float(light_columns)));
  uint end = uint(clamp(floor(high) + 1.0, 0.0, float(light_columns)));
  if (first >= end) return 0u;
  return 0xffffffffu >> (uint(light_columns) - (end - first)) << first;
}

// Half planes at + u * by_u + v * by_v >= 0 of the square: where they bound rows.
struct RowBounds {
  vec4 column;  // of row 0
  vec4 step;    // from row to row
  bvec4 lower;
};

RowBounds row_bounds(vec4 at, vec4 by_u, vec4 by_v) {
  const float rows = float(light_rows);
  const float columns = float(light_columns);
  vec4 along = by_u + by_v / rows;
  along = mix(along, vec4(1e-30), equal(along, vec4(0.0)));
  RowBounds b;
  b.column = -columns * at / along - 0.5;
  b.step = -(columns / rows) * by_v / along;
  b.lower = greaterThan(along, vec4(0.0));
  return b;
}

uint bounded_bits(RowBounds b, int row) {
  vec4 x = b.column + float(row) * b.step;
  vec4 low = mix(vec4(-1e30), x, b.lower);
  vec4 high = mix(x, vec4(1e30), b.lower);
  return row_bits(max(max(low.x, low.y), max(low.z, low.w)), min(min(high.x, high.y), min(high.z, high.w)));
}

// The part of a row within the disc of diameter 1 around the middle of [-1/2, 1/2]^2, to which the square is mapped by v.low
// and v.high.
uint disc_bits(LightView v, int row) {
  const float rows = float(light_rows);
  vec2 from = v.low + vec2(0.0, float(row) / rows) * (v.high - v.low);
  vec2 along = vec2(1.0, 1.0 / rows) * (v.high - v.low);
  float a = max(dot(along, along), 1e-30);
  float middle = -dot(from, along) / a;
  float square = middle * middle - (dot(from, from) - 0.25) / a;
  if (square < 0.0) return 0u;
  float half_width = sqrt(square);
  const float columns = float(light_columns);
  return row_bits(columns * (middle - half_width) - 0.5, columns * (middle + half_width) - 0.5);
}

float listed_visibility(Light light, vec3 position, vec3 normal, uvec2 range) {
  LightView v = light_view(light, position, normal, -1.0);
  if (v.masked || range.y == 0u) return 1.0;
  float scale = v.cone ? light_view_cone_scale(v, 1.0) : 1.0;
  vec2 extent = scale * (v.high - v.low);
  LightSquare square;
  square.low = v.centre + scale * (v.low.x * v.side_u + v.low.y * v.side_v);
  square.size_u = v.extended ? extent.x * v.side_u : vec3(0.0);
  square.size_v = v.extended ? extent.y * v.side_v : vec3(0.0);
  if (!v.extended) square.low = v.centre;

  // What lies above the tangent plane.
  RowBounds above = row_bounds(vec4(dot(square.low, v.normal)), vec4(dot(square.size_u, v.normal)),
                               vec4(dot(square.size_v, v.normal)));
  uint open[light_rows];
  uint any_open = 0u;
  int total = 0;
  for (int row = 0; row < light_rows; ++row) {
    open[row] = bounded_bits(above, row);
    if (v.cone && v.extended) open[row] &= disc_bits(v, row);
    any_open |= open[row];
    total += bitCount(open[row]);
  }
  if (total == 0) return 1.0;

  // In units of the scene: cubes of metres may be too small.
  float scaled = 1.0 / unit;
  float size = max(max(abs(position.x), abs(position.y)), abs(position.z)) * scaled + 1.0;
  float clearance2 = listed_clearance * listed_clearance * size * size;
  // A disc's depth is measured from the world's origin: the light is beyond all.
  float limit = reach * (v.cone ? 1e30 : min(v.depth * scaled, 1e30));
  for (uint t = range.x; t < range.x + range.y && any_open != 0u; ++t) {
    uint corner = 3u * (lists[t] & ~both_sides);
    vec3 a = scaled * (leaves[corners[corner]].vertex - position);
    vec3 b = scaled * (leaves[corners[corner + 1u]].vertex - position);
    vec3 c = scaled * (leaves[corners[corner + 2u]].vertex - position);
    vec3 ab = cross(a, b);
    vec3 bc = cross(b, c);
    vec3 ca = cross(c, a);
    vec3 across = ab + bc + ca;
    float volume = dot(a, bc);
    if (volume * volume <= clearance2 * dot(across, across)) continue;
    // From within a body, where rounding may put a place on its surface, ways only leave: nothing hides there.
    if (volume > 0.0 && (lists[t] & both_sides) == 0u) continue;
    float side = volume < 0.0 ? -1.0 : 1.0;
    // Within the three edges, and nearer than the light: a ray of slope s meets the plane at depth volume / dot(across, s).
    vec4 at = side * vec4(dot(ab, square.low), dot(bc, square.low), dot(ca, square.low), dot(across, square.low));
    vec4 by_u = side * vec4(dot(ab, square.size_u), dot(bc, square.size_u), dot(ca, square.size_u), dot(across, square.size_u));
    vec4 by_v = side * vec4(dot(ab, square.size_v), dot(bc, square.size_v), dot(ca, square.size_v), dot(across, square.size_v));
    at.w -= abs(volume) / limit;
    if (any(lessThan(at + max(by_u, 0.0) + max(by_v, 0.0), vec4(0.0)))) continue;
    RowBounds hidden = row_bounds(at, by_u, by_v);
    any_open = 0u;
    for (int row = 0; row < light_rows; ++row) {
      open[row] &= ~bounded_bits(hidden, row);
      any_open |= open[row];
    }
  }
  int lit = 0;
  for (int row = 0; row < light_rows; ++row) lit += bitCount(open[row]);
  return float(lit) / float(total);
}

#endif  // LIMN_LISTED_VISIBILITY_GLSL
