// The picture of the scene without its specular surfaces, as rays see it: the first place where a ray passes from before
// the picture's depth to behind it (McGuire and Mara 2014, Efficient GPU Screen-Space Ray Tracing, JCGT 3(4): evenly
// spaced on the screen), on the plane of the triangle that is seen there.
#ifndef LIMN_SCENE_RAY_GLSL
#define LIMN_SCENE_RAY_GLSL
#include "glsl/scene/blocks.glsl"
#include "glsl/surface/gbuffer.glsl"

uniform sampler2D matte_depth;   // metres along the view axis; 0: nothing
uniform sampler2D matte_normal;  // of the triangle, octahedral
uniform sampler2D matte_radiance;

const int ray_refinements = 6;
const int ray_candidates = 4;      // crossings that are looked at
const float least_facing = 1e-3;   // cosine between ray and surface
const float near_plane_part = 1e-3;  // of the ray's first depth

// Place on the screen (pixels; whole numbers are centres) and depth of a point before the camera.
vec3 screen_place(vec4 clip) {
  return vec3((0.5 * clip.xy / clip.w + 0.5) * vec2(frame.frame_size) - 0.5, clip.w);
}

vec3 screen_ray(vec2 place) {
  return frame.view_ray_origin.xyz + place.x * frame.view_ray_dx.xyz + place.y * frame.view_ray_dy.xyz;
}

// Narrows range to where value + t slope >= 0.
void clip_range(float value, float slope, inout vec2 range) {
  float t = -value / slope;
  if (slope > 0.0) {
    range.x = max(range.x, t);
  } else if (slope < 0.0) {
    range.y = min(range.y, t);
  } else if (value < 0.0) {
    range = vec2(1.0, -1.0);
  }
}

// The part of the ray that is on the screen.
struct ScreenRay {
  vec2 range;  // t in [x, y]; x > y: none
  vec3 from;   // at range.x: place, 1 / depth
  vec3 to;     // at range.y
};

ScreenRay screen_ray_of(vec3 origin, vec3 direction, float reach) {
  vec4 a = frame.world_to_clip * vec4(origin, 1.0);
  vec4 d = frame.world_to_clip * vec4(direction, 0.0);
  ScreenRay ray;
  ray.range = a.w > 0.0 ? vec2(0.0, reach) : vec2(1.0, -1.0);
  clip_range(a.w * (1.0 - near_plane_part), d.w, ray.range);
  clip_range(a.w + a.x, d.w + d.x, ray.range);
  clip_range(a.w - a.x, d.w - d.x, ray.range);
  clip_range(a.w + a.y, d.w + d.y, ray.range);
  clip_range(a.w - a.y, d.w - d.y, ray.range);
  vec3 from = screen_place(a + ray.range.x * d);
  vec3 to = screen_place(a + ray.range.y * d);
  ray.from = vec3(from.xy, 1.0 / from.z);
  ray.to = vec3(to.xy, 1.0 / to.z);
  return ray;
}

// A point of it: evenly spaced s are evenly spaced on the screen.
struct ScreenPoint {
  vec2 place;
  float depth;
  float t;
};

ScreenPoint screen_point(ScreenRay ray, float s) {
  ScreenPoint p;
  vec3 at = mix(ray.from, ray.to, s);
  p.place = at.xy;
  p.depth = 1.0 / at.z;
  p.t = mix(ray.range.x * ray.from.z, ray.range.y * ray.to.z, s) * p.depth;
  return p;
}

ivec2 nearest_pixel(vec2 place) { return clamp(ivec2(floor(place + 0.5)), ivec2(0), ivec2(frame.frame_size) - 1); }

bool behind_scene(ScreenPoint p) {
  float depth = texelFetch(matte_depth, nearest_pixel(p.place), 0).x;
  return depth > 0.0 && p.depth > depth;
}

struct SceneHit {
  float t;      // metres; < 0: none
  ivec2 pixel;  // that shows the surface
  vec2 place;
  vec3 normal;  // of the triangle, against the ray
};

// Whether the ray meets the surface that is seen at p, rather than passing behind it. step: change of the ray's depth over the
// interval in which it went behind.
SceneHit met_surface(vec3 origin, vec3 direction, ScreenPoint p, float step) {
  SceneHit hit;
  hit.t = -1.0;
  hit.pixel = nearest_pixel(p.place);
  hit.place = p.place;
  float depth = texelFetch(matte_depth, hit.pixel, 0).x;
  hit.normal = octahedral_decode(texelFetch(matte_normal, hit.pixel, 0).xy);
  float facing = dot(hit.normal, direction);
  if (depth == 0.0 || facing > -least_facing) return hit;
  vec3 eye = frame.camera_position.xyz;
  vec3 surface = eye + depth * screen_ray(vec2(hit.pixel));
  // The plane's depth where the ray is, and its change over a pixel.
  float height = dot(hit.normal, surface - eye);
  float plane = height / dot(hit.normal, screen_ray(p.place));
  vec2 next = vec2(height / dot(hit.normal, screen_ray(p.place + vec2(1.0, 0.0))),
                   height / dot(hit.normal, screen_ray(p.place + vec2(0.0, 1.0))));
  float slope = length(next - plane);
  float pixel_side = depth * length(frame.view_ray_dx.xyz);
  if (!(abs(p.depth - plane) <= 2.0 * abs(step) + slope + pixel_side)) return hit;
  hit.t = p.t;
  float on_plane = dot(hit.normal, surface - origin) / facing;
  vec4 clip = frame.world_to_clip * vec4(origin + on_plane * direction, 1.0);
  if (!(on_plane > 0.0 && clip.w > 0.0)) return hit;
  vec2 place = screen_place(clip).xy;
  if (length(place - p.place) > 1.5) return hit;
  hit.t = on_plane;
  hit.place = place;
  return hit;
}

// The first surface on origin + t direction, 0 < t < reach, as far as the screen knows. direction: unit.
SceneHit scene_hit(vec3 origin, vec3 direction, float reach, int steps) {
  SceneHit none = SceneHit(-1.0, ivec2(0), vec2(0.0), vec3(0.0));
  ScreenRay ray = screen_ray_of(origin, direction, reach);
  if (!(ray.range.x < ray.range.y)) return none;
  vec2 way = abs(ray.to.xy - ray.from.xy);
  int count = clamp(int(ceil(min(max(way.x, way.y), 65536.0))), 1, steps);
  bool behind = false;
  int i = 0;
  for (int candidate = 0; candidate < ray_candidates && i <= count; ++candidate) {
    bool crossed = false;
    for (; i <= count; ++i) {
      bool now = behind_scene(screen_point(ray, float(i) / float(count)));
      crossed = now && !behind;
      behind = now;
      if (crossed) break;
    }
    if (!crossed) break;
    float before = float(max(i - 1, 0)) / float(count);
    float after = float(i) / float(count);
    for (int r = 0; r < ray_refinements; ++r) {
      float middle = 0.5 * (before + after);
      if (behind_scene(screen_point(ray, middle))) {
        after = middle;
      } else {
        before = middle;
      }
    }
    ScreenPoint p = screen_point(ray, after);
    SceneHit hit = met_surface(origin, direction, p, p.depth - screen_point(ray, before).depth);
    if (hit.t >= 0.0) return hit;
    ++i;
  }
  return none;
}

// Radiance of the picture at a hit: interpolated among the pixels that show the same plane.
vec3 radiance_at(SceneHit hit, vec3 position) {
  float footprint = length(frame.view_ray_dx.xyz) * texelFetch(matte_depth, hit.pixel, 0).x;
  ivec2 corner = ivec2(floor(hit.place));
  vec2 weight = hit.place - vec2(corner);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 pixel = corner + step;
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) continue;
    float depth = texelFetch(matte_depth, pixel, 0).x;
    vec3 surface = frame.camera_position.xyz + depth * screen_ray(vec2(pixel));
    if (depth == 0.0 || !(abs(dot(hit.normal, surface - position)) <= footprint)) continue;
    vec2 w = mix(1.0 - weight, weight, vec2(step));
    sum += w.x * w.y * vec4(texelFetch(matte_radiance, pixel, 0).rgb, 1.0);
  }
  return sum.a >= 0.25 ? sum.rgb / sum.a : texelFetch(matte_radiance, hit.pixel, 0).rgb;
}

#endif  // LIMN_SCENE_RAY_GLSL
