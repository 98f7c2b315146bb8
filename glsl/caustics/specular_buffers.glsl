// The specular buffers of a layer as passes search them that follow light through objects. EXIT_STEPS: points of the search
// for where light leaves an object.
#ifndef LIMN_SPECULAR_BUFFERS_GLSL
#define LIMN_SPECULAR_BUFFERS_GLSL
#include "glsl/shadow/shadow_view.glsl"

uniform sampler2DArray front_surface;  // xyz: normal; w: +-(instance + 1)
uniform sampler2DArray front_depth;
uniform sampler2DArray back_surface;
uniform sampler2DArray back_depth;

// Depth at uv, interpolated among the texels of the instance; < 0: the instance is not there.
float buffer_depth(sampler2DArray surfaces, sampler2DArray depths, vec2 uv, int layer, float instance) {
  ivec2 size = textureSize(surfaces, 0).xy;
  vec2 corner = uv * vec2(size) - 0.5;
  vec2 weight = fract(corner);
  float sum = 0.0;
  float total = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 texel = ivec2(floor(corner)) + step;
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) continue;
    if (abs(texelFetch(surfaces, ivec3(texel, layer), 0).w) != instance) continue;
    vec2 w = mix(1.0 - weight, weight, vec2(step));
    sum += w.x * w.y * texelFetch(depths, ivec3(texel, layer), 0).x;
    total += w.x * w.y;
  }
  return total >= 0.5 ? sum / total : -1.0;
}

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

// Where the world point p is, relative to an object.
int body_side(ShadowView view, vec3 p, int layer, float instance, float tolerance) {
  ShadowPoint q = shadow_project(view, p);
  if (!shadow_inside(q)) return body_back;
  float depth = shadow_normalise(view, q.depth);
  float far = buffer_depth(back_surface, back_depth, q.uv, layer, instance);
  if (far < 0.0 || depth >= far) return body_back;
  float near = buffer_depth(front_surface, front_depth, q.uv, layer, instance);
  return near >= 0.0 && depth < near - tolerance ? body_front : body_inside;
}

// Whether p lies between the nearest and the farthest surface of an object, by the texel that holds it.
bool within_object(ShadowView view, vec3 p, int layer) {
  ShadowPoint q = shadow_project(view, p);
  if (!shadow_inside(q)) return false;
  ivec3 texel = ivec3(min(ivec2(q.uv * float(view.size)), ivec2(view.size) - 1), layer);
  if (texelFetch(front_surface, texel, 0).w == 0.0) return false;
  float depth = shadow_normalise(view, q.depth);
  float tolerance = shadow_footprint(view, q.depth) / (view.far - view.near);
  return depth > texelFetch(front_depth, texel, 0).x + tolerance &&
         depth < texelFetch(back_depth, texel, 0).x - tolerance;
}

// Where light inside an object leaves it.
struct BodyExit {
  float distance;  // metres from the start
  vec3 normal;     // unit, out of the body; 0: not found
  bool front;      // on the nearest surface, not on the farthest
  vec2 uv;         // where
};

const int exit_steps = EXIT_STEPS;
const int exit_refinements = 10;

// The first place on start + t direction, 0 < t < reach, that lies outside.
BodyExit body_exit(ShadowView view, vec3 start, vec3 direction, float reach, int layer, float instance) {
  float tolerance = shadow_footprint(view, shadow_view_depth(view, start)) / (view.far - view.near);
  float inside = 0.0;
  float outside = reach;
  int side = body_back;
  for (int i = 1; i <= exit_steps; ++i) {
    float t = reach * float(i) / float(exit_steps);
    side = body_side(view, start + t * direction, layer, instance, tolerance);
    if (side != body_inside) {
      outside = t;
      break;
    }
    inside = t;
  }
  for (int i = 0; i < exit_refinements; ++i) {
    float t = 0.5 * (inside + outside);
    int there = body_side(view, start + t * direction, layer, instance, tolerance);
    if (there == body_inside) {
      inside = t;
    } else {
      outside = t;
      side = there;
    }
  }
  BodyExit e;
  e.distance = 0.5 * (inside + outside);
  e.uv = shadow_project(view, start + inside * direction).uv;
  e.front = side == body_front;
  e.normal = e.front ? buffer_normal(front_surface, e.uv, layer, instance)
                     : buffer_normal(back_surface, e.uv, layer, instance);
  return e;
}

#endif  // LIMN_SPECULAR_BUFFERS_GLSL
