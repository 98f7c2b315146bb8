// The specular buffers of a layer as passes search them that follow light through objects. EXIT_STEPS: points of the search
// for where light leaves an object.
#ifndef LIMN_SPECULAR_BUFFERS_GLSL
#define LIMN_SPECULAR_BUFFERS_GLSL
#include "glsl/shadow/map_path.glsl"
#include "glsl/shadow/shadow_view.glsl"

uniform sampler2DArray front_surface;  // xyz: normal; w: +-(instance + 1)
uniform sampler2DArray front_depth;
uniform sampler2DArray back_surface;
uniform sampler2DArray back_depth;

// Depths of the nearest and the farthest surface of an object at a place (texels), as stored, interpolated among the texels of
// the instance; < 0: the instance is not there.
vec2 body_depths(vec2 place, int layer, float instance) {
  ivec2 size = textureSize(front_surface, 0).xy;
  vec2 corner = place - 0.5;
  vec2 low = floor(corner);
  vec2 weight = corner - low;
  vec2 sum = vec2(0.0);
  vec2 total = vec2(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec3 texel = ivec3(ivec2(low) + step, layer);
    if (any(lessThan(texel.xy, ivec2(0))) || any(greaterThanEqual(texel.xy, size))) continue;
    vec2 w = mix(1.0 - weight, weight, vec2(step));
    bool front = abs(texelFetch(front_surface, texel, 0).w) == instance;
    bool back = abs(texelFetch(back_surface, texel, 0).w) == instance;
    vec2 share = w.x * w.y * vec2(front, back);
    sum += share * vec2(texelFetch(front_depth, texel, 0).x, texelFetch(back_depth, texel, 0).x);
    total += share;
  }
  return vec2(total.x >= 0.5 ? sum.x / total.x : -1.0, total.y >= 0.5 ? sum.y / total.y : -1.0);
}

// The views of the objects from one point. A body may lie in several of them.
struct ObjectViews {
  ShadowView first;
  uint faces;  // shadow_faces_*, a constant where all points have one view
  int layer;   // of the first view
};

// body_depths() where a view sees p.
vec2 body_depths_at(ShadowView view, vec3 p, int layer, float instance) {
  return body_depths(float(view.size) * shadow_project(view, p).uv, layer, instance);
}

// Whether a surface with these depths bounds no body: light stays in the medium behind it.
bool is_sheet(vec2 depths) { return !(depths.y - depths.x > 1e-6); }

// Normal at uv: interpolated where the surface is smooth, that of the nearest texel across an edge; 0: nothing there.
vec3 buffer_normal(sampler2DArray surfaces, vec2 uv, int layer, float instance) {
  const float smooth_cosine = 0.97;
  ivec2 size = textureSize(surfaces, 0).xy;
  vec4 nearest = texelFetch(surfaces, ivec3(clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1), layer), 0);
  if (abs(nearest.w) != instance) nearest = vec4(0.0);
  vec2 corner = uv * vec2(size) - 0.5;
  vec2 weight = fract(corner);
  vec3 sum = vec3(0.0);
  bool whole = true;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 texel = clamp(ivec2(floor(corner)) + step, ivec2(0), size - 1);
    vec4 surface = texelFetch(surfaces, ivec3(texel, layer), 0);
    if (abs(surface.w) != instance) continue;
    if (dot(surface.xyz, nearest.xyz) < smooth_cosine) whole = false;
    vec2 w = mix(1.0 - weight, weight, vec2(step));
    sum += w.x * w.y * surface.xyz;
  }
  if (nearest.w != 0.0 && !whole) return nearest.xyz;
  float size_of_sum = length(sum);
  return size_of_sum > 0.0 ? sum / size_of_sum : vec3(0.0);
}

const int body_inside = 0;
const int body_back = 1;   // behind the farthest surface, or beside the object
const int body_front = 2;  // before the nearest surface

// Where a place on a path through the views is, relative to an object. tolerance: metres.
int body_side(ObjectViews objects, MapPath path, float t, float instance, float tolerance) {
  MapPlace place = map_path_place(path, objects.first.projection, objects.faces, t);
  vec2 depths = body_depths(place.texel, objects.layer + int(place.face), instance);
  bool before = depths.x >= 0.0 && map_path_behind(path, place, depths.x) < -tolerance;
  bool behind = depths.y < 0.0 || map_path_behind(path, place, depths.y) >= 0.0;
  if (behind || !map_path_inside(path, place)) return body_back;
  return before ? body_front : body_inside;
}

// Whether a place on a path through the view lies between the nearest and the farthest surface of a texel. Where there is nothing,
// both depths are 1.
bool between_surfaces(MapPath path, MapPlace place, ivec3 texel, float tolerance) {
  return map_path_behind(path, place, texelFetch(front_depth, texel, 0).x) > tolerance &&
         map_path_behind(path, place, texelFetch(back_depth, texel, 0).x) < -tolerance;
}

// Whether such a place lies within an object: by the texel that holds it, and where light is just `leaving` one by each of the four
// texels around it, since by one alone it would still be within where the surface is steep.
bool within_object(MapPath path, MapPlace place, int layer, float tolerance, bool leaving) {
  if (!map_path_inside(path, place)) return false;
  if (!between_surfaces(path, place, ivec3(map_path_texel(path, place), layer), tolerance)) return false;
  ivec2 low = ivec2(floor(place.texel - 0.5));
  for (int i = 0; i < (leaving ? 4 : 0); ++i) {
    ivec2 texel = clamp(low + ivec2(i & 1, i >> 1), ivec2(0), ivec2(path.size) - 1);
    if (!between_surfaces(path, place, ivec3(texel, layer), tolerance)) return false;
  }
  return true;
}

// Where light inside an object leaves it.
struct BodyExit {
  float distance;  // metres from the start
  vec3 normal;     // unit, out of the body; 0: not found
  bool front;      // on the nearest surface, not on the farthest
  vec2 uv;         // where
  int layer;
};

const int exit_steps = EXIT_STEPS;
// Bisections: as many as halve the stride to an eighth of a texel, which are more where `reach` spans much more than the object.
const int least_exit_refinements = 10;
const int most_exit_refinements = 24;

// The first place on start + t direction, 0 < t < reach, that lies outside.
BodyExit body_exit(ObjectViews objects, vec3 start, vec3 direction, float reach, float instance) {
  MapPath path = map_path(objects.first, start, direction);
  MapPlace entry = map_path_place(path, objects.first.projection, objects.faces, 0.0);
  float tolerance = shadow_footprint(objects.first, entry.depth);
  float stride = reach / float(exit_steps);
  float inside = 0.0;
  float outside = reach;
  int side = body_back;
  for (int i = 1; i <= exit_steps; ++i) {
    float t = stride * float(i);
    side = body_side(objects, path, t, instance, tolerance);
    if (side != body_inside) {
      outside = t;
      break;
    }
    inside = t;
  }
  for (int i = 0; i < most_exit_refinements; ++i) {
    if (i >= least_exit_refinements && outside - inside <= 0.125 * tolerance) break;
    float t = 0.5 * (inside + outside);
    int there = body_side(objects, path, t, instance, tolerance);
    if (there == body_inside) {
      inside = t;
    } else {
      outside = t;
      side = there;
    }
  }
  BodyExit e;
  e.distance = 0.5 * (inside + outside);
  MapPlace place = map_path_place(path, objects.first.projection, objects.faces, inside);
  e.uv = place.texel / path.size;
  e.layer = objects.layer + int(place.face);
  e.front = side == body_front;
  e.normal = e.front ? buffer_normal(front_surface, e.uv, e.layer, instance)
                     : buffer_normal(back_surface, e.uv, e.layer, instance);
  return e;
}

#endif  // LIMN_SPECULAR_BUFFERS_GLSL
