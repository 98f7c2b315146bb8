// The blocker search of glsl/shadow/blocker_samples.glsl with what a pixel fixes worked out once for it, which bounds measure: a
// sample is two numbers, of which place and height above the tangent plane are affine functions. One view sees all of the light,
// which is a rectangle.
//
// Define PATTERN 0: grid, 1: R2 sequence shifted per pixel; SEARCH: see glsl/shadow/blocker_reach.glsl, whose lookups are the
// technique's own.
#ifndef LIMN_SAMPLE_TAPS_GLSL
#define LIMN_SAMPLE_TAPS_GLSL
#include "glsl/numeric/sampling.glsl"
#include "glsl/shadow/blocker_reach.glsl"
#include "glsl/shadow/map_taps.glsl"
#include "glsl/shadow/visibility.glsl"

uniform int blocker_samples;

// Samples as they are counted: u in [0, 1)^2 is scale (number + middle).
struct Lattice {
#if PATTERN == 0
  int side;
  ivec2 next;
#else
  uvec2 next;
#endif
  int count;
  float scale;
  float middle;
};

Lattice lattice(int count, vec2 shift) {
#if PATTERN == 0
  int side = int(sqrt(float(count)) + 1e-3);
  return Lattice(side, ivec2(0), side * side, 1.0 / float(side), 0.5);
#else
  return Lattice(uvec2(fixed_point(shift.x), fixed_point(shift.y)), count, fixed_point_value(256u), 0.0);
#endif
}

vec2 next_number(inout Lattice points) {
#if PATTERN == 0
  vec2 number = vec2(points.next);
  points.next.x += 1;
  if (points.next.x == points.side) points.next = ivec2(0, points.next.y + 1);
#else
  vec2 number = vec2(ivec2(points.next >> 8u));
  points.next += r2_step;
#endif
  return number;
}

// An affine function of u as one of the numbers: the factors of both, and what remains.
vec3 of_numbers(Lattice points, vec3 f) {
  vec2 factors = points.scale * f.xy;
  return vec3(factors, f.z + points.middle * (factors.x + factors.y));
}

float affine(vec3 f, vec2 number) { return f.x * number.x + (f.y * number.y + f.z); }

// The texel at a place of the map, and whether it blocks.
struct Tap {
  vec2 texel;
  float stored;
  bool blocks;
};

Tap tap_at(ShadowCursor cursor, MapTest test, vec2 place) {
  Tap tap;
  ivec2 texel = ivec2(place);
  tap.texel = vec2(texel);
  tap.stored = texelFetch(shadow_depth, ivec3(texel, cursor.layer), 0).r;
  tap.blocks = map_test_blocks(test, affine(test.plane, tap.texel), tap.stored) && map_holds(cursor.view, place);
  return tap;
}

// Where the samples of a kernel at one depth lie in the map.
struct Places {
  vec3 x;
  vec3 y;
};

Places places_at(ShadowCursor cursor, Lattice points, MapKernel rays, float gap) {
  MapBox box = map_box(cursor.view, rays, gap);
  return Places(of_numbers(points, vec3(box.side_u.x, box.side_v.x, box.centre.x)),
                of_numbers(points, vec3(box.side_u.y, box.side_v.y, box.centre.y)));
}

// Mean distance from the blockers to the receiver along the light's axis, metres; 0: there are none, V = 1; negative: nothing
// else is there, V = 0.
float mean_gap(ShadowCursor cursor, VisibilityQuery q, MapTest test, MapKernel rays, vec3 rises, vec3 shift) {
  float reach;
  if (!blocker_reach(cursor, q, reach)) return reach;
  Lattice points = lattice(blocker_samples, shift.xy);
  vec3 rise = of_numbers(points, rises);
#if SEARCH == 1
  MapCone cone = map_cone(cursor.view, q.light, q.position, cursor.in_map, cursor.receiver.axis);
  uint height = fixed_point(shift.z);
  float height_scale = reach * fixed_point_value(256u);
  vec3 rays_x = of_numbers(points, vec3(rays.side_u.x, rays.side_v.x, rays.centre.x));
  vec3 rays_y = of_numbers(points, vec3(rays.side_u.y, rays.side_v.y, rays.centre.y));
  vec2 middle = float(cursor.view.size) * cursor.view.middle;
#else
  Places places = places_at(cursor, points, rays, reach);
#endif
  float sum = 0.0;
  float blockers = 0.0;
  for (int i = 0; i < points.count; ++i) {
    vec2 number = next_number(points);
#if SEARCH == 1
    float gap = height_scale * float(int(height >> 8u));
    height += r3_step_z;
    vec2 point = rays.receiver.xy + gap * vec2(affine(rays_x, number), affine(rays_y, number));
    vec2 place = middle + (1.0 / (rays.receiver.z - gap)) * point;
#else
    vec2 place = vec2(affine(places.x, number), affine(places.y, number));
#endif
    Tap tap = tap_at(cursor, test, place);
    bool counts = tap.blocks && affine(rise, number) > 0.0;
    float depth = shadow_metres(cursor.view, tap.stored);
    float found = cursor.in_map.depth - depth;
#if SEARCH == 1
    counts = counts && map_cone_contains(cursor.view, q.light, cone, tap.texel, depth, found,
                                         shadow_footprint(cursor.view, depth));
#endif
    sum += counts ? found : 0.0;
    blockers += counts ? 1.0 : 0.0;
  }
  return blockers > 0.0 ? sum / blockers : 0.0;
}

#endif  // LIMN_SAMPLE_TAPS_GLSL
