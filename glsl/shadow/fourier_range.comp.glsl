// What of each shadow map's depth the Fourier series is to span: one work group per layer, on a coarse level of the
// min-max pyramid. FIT 0: all of it; 1: from the least depth to the greatest; 2: the same relative to a plane over the
// map, where that is less. The plane is fitted to the greatest depths, which receivers have, and again with less weight
// on what lies off it.
#include "glsl/shadow/fourier_shadow.glsl"

#define THREADS 256
layout(local_size_x = THREADS) in;
layout(std430) writeonly buffer Ranges { FourierRange ranges[]; };
#if FIT >= 1
uniform sampler2DArray pyramid;  // MinMaxPyramid
uniform int level;
#endif
uniform float span;  // of the series' depths: R

const float least_range = 1.0 / 64.0;  // of the map's own, so that rounding is not spread over the whole series

#if FIT >= 1
#include "glsl/numeric/work_group.glsl"

ivec2 cell(int i, ivec2 size) { return ivec2(i % size.x, i / size.x); }
vec2 bounds(ivec2 at, int of_level) { return texelFetch(pyramid, ivec3(at, int(gl_WorkGroupID.x)), of_level).xy; }

// What texel `at` of a level stands for in a finer one: the first texel, and the one after the last. The last of a level reach the
// map's edge.
ivec4 within(ivec2 at, int of_level, int finer) {
  ivec2 size = textureSize(pyramid, of_level).xy;
  ivec2 end = textureSize(pyramid, finer).xy;
  int step = of_level - finer;
  return ivec4(at << step, at.x == size.x - 1 ? end.x : (at.x + 1) << step, at.y == size.y - 1 ? end.y : (at.y + 1) << step);
}

// Where a cell's edges lie, uv from the map's centre.
vec4 edges(ivec2 at) { return vec4(within(at, level, 0)) / vec4(textureSize(pyramid, 0).xyxy) - 0.5; }

// The greatest depth of what is there in a cell that holds emptiness as well: from its texels, except in those parts of the cell
// half way down to them in which all is there, or nothing.
float greatest_there(ivec2 at) {
  int half_way = level / 2;
  float most = 0.0;
  ivec4 parts = within(at, level, half_way);
  for (int y = parts.y; y < parts.w; ++y) {
    for (int x = parts.x; x < parts.z; ++x) {
      vec2 z = bounds(ivec2(x, y), half_way);
      if (z.y < 1.0) most = max(most, z.y);
      if (z.x >= 1.0 || z.y < 1.0) continue;
      ivec4 texels = within(ivec2(x, y), half_way, 0);
      for (int v = texels.y; v < texels.w; ++v) {
        for (int u = texels.x; u < texels.z; ++u) {
          float depth = bounds(ivec2(u, v), 0).x;
          most = depth < 1.0 ? max(most, depth) : most;
        }
      }
    }
  }
  return most;
}

// (depth at the centre, slope): weighted least squares of the cells' greatest depths.
vec3 fitted(ivec2 size, vec3 before, float scatter) {
  vec4 a = vec4(0.0);  // sums of w, w x, w y, w z
  vec4 b = vec4(0.0);  // w x x, w x y, w y y
  vec4 c = vec4(0.0);  // w x z, w y z
  for (int i = int(gl_LocalInvocationID.x); i < size.x * size.y; i += THREADS) {
    ivec2 at = cell(i, size);
    float z = bounds(at, level).y;
    if (z >= 1.0) continue;
    vec4 e = edges(at);
    vec2 p = 0.5 * (e.xy + e.zw);
    float off = (z - before.x - dot(before.yz, p)) / scatter;
    float w = 1.0 / (1.0 + off * off);
    a += w * vec4(1.0, p, z);
    b += w * vec4(p.x * p.x, p.x * p.y, p.y * p.y, 0.0);
    c += w * vec4(p * z, 0.0, 0.0);
  }
  a = total(a);
  b = total(b);
  c = total(c);
  if (a.x <= 0.0) return before;
  vec2 mean = a.yz / a.x;
  float xx = b.x - a.y * mean.x;
  float xy = b.y - a.y * mean.y;
  float yy = b.z - a.z * mean.y;
  vec2 r = c.xy - a.w * mean;
  float determinant = xx * yy - xy * xy;
  if (determinant <= 1e-6 * a.x * a.x) return before;
  vec2 slope = vec2(yy * r.x - xy * r.y, xx * r.y - xy * r.x) / determinant;
  return vec3(a.w / a.x - dot(slope, mean), slope);
}

// Bounds of depth less the plane over all that is there, negated at the upper end; of two planes.
vec4 range_of(ivec2 size, vec3 first, vec3 second) {
  vec4 result = vec4(1.0e30);
  for (int i = int(gl_LocalInvocationID.x); i < size.x * size.y; i += THREADS) {
    ivec2 at = cell(i, size);
    vec2 z = bounds(at, level);
    if (z.x >= 1.0) continue;
    if (z.y >= 1.0) z.y = greatest_there(at);
    vec4 e = edges(at);
    vec2 p = 0.5 * (e.xy + e.zw);
    vec2 half_cell = 0.5 * (e.zw - e.xy);
    vec2 spread = vec2(dot(abs(first.yz), half_cell), dot(abs(second.yz), half_cell));
    vec2 origin = vec2(first.x + dot(first.yz, p), second.x + dot(second.yz, p));
    result = min(result, vec4(z.x - origin - spread, origin - z.y - spread));
  }
  return least(result);
}

#endif

void main() {
  FourierRange range = FourierRange(0.0, 0.0, 0.0, span);
#if FIT >= 1
  ivec2 size = textureSize(pyramid, level).xy;
  vec3 flat_plane = vec3(0.0);
  vec3 tilted = flat_plane;
#if FIT == 2
  tilted = fitted(size, flat_plane, 1.0e6);
  for (int i = 0; i < 3; ++i) tilted = fitted(size, tilted, 0.02);
#endif
  vec4 r = range_of(size, flat_plane, tilted);  // least of both, then the greatest, negated
  if (r.x < 1.0e30) {
    vec2 extent = max(-r.zw - r.xy, vec2(least_range));
    bool tilt = extent.y < extent.x;
    range = tilt ? FourierRange(tilted.x + r.y, tilted.y, tilted.z, span / extent.y)
                 : FourierRange(r.x, 0.0, 0.0, span / extent.x);
  }
#endif
  if (gl_LocalInvocationID.x == 0u) ranges[gl_WorkGroupID.x] = range;
}
