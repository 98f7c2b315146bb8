// Airlight: each viewing ray is cut into stretches that are even in the angle from the light; of each, the part that the
// light reaches is integrated (glsl/media/airlight.glsl). MARCH: where the medium or the light is not that simple, what the medium
// takes on the way to the eye is summed along the stretches, what it takes on the way from the light is looked up at each node.
#include "glsl/media/airlight.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/light/light_texture.glsl"
#include "glsl/media/medium_input.glsl"
#include "glsl/shadow/shadow_view.glsl"

#define MARCH (MEDIUM_STEPS > 0 || LIGHT_TEXTURES)

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
uniform sampler2DArray shadow_depth;
layout(std430) readonly buffer Lights { Light lights[]; };
layout(std430) readonly buffer ShadowViews { ShadowView shadow_views[]; };
layout(std430) readonly buffer ShadowLights { ShadowLight shadow_lights[]; };
uniform int light_count;
uniform int light_samples;
uniform int steps;

const int refinements = 6;  // of the place where a ray enters or leaves a shadow

bool lit(ShadowLight maps, ShadowView first, vec3 p) {
  ShadowView view = first;
  uint layer = maps.first_layer;
  if (maps.faces != shadow_faces_single) {
    layer += shadow_face(maps.faces, first, p);
    view = shadow_views[layer];
  }
  ShadowPoint q = shadow_project(view, p);
  if (!shadow_inside(q)) return true;
  ivec2 texel = min(ivec2(q.uv * float(view.size)), ivec2(view.size) - 1);
  float stored = texelFetch(shadow_depth, ivec3(texel, layer), 0).x;
  return !(stored < 1.0 && shadow_metres(view, stored) < q.depth);
}

bool lit_at(ShadowLight maps, ShadowView first, AirlightRay ray, float variable) {
  return lit(maps, first, ray.eye + airlight_metres(ray, variable) * ray.direction);
}

#if MARCH

// Metres of medium of density 1 in the stretch from a to b metres along the ray (Gauss-Legendre, two nodes).
float stretch_length(AirlightRay ray, float a, float b) {
  float middle = 0.5 * (a + b);
  float step = 0.5 * (b - a) * gauss_node;
  return 0.5 * (b - a) * (medium_density(ray.eye + (middle - step) * ray.direction) +
                          medium_density(ray.eye + (middle + step) * ray.direction));
}

// Radiance per unit of the variable from one node; before: metres of medium of density 1 between eye and node.
vec3 airlight_node(Medium medium, Light light, AirlightRay ray, float t, float before) {
  AirlightPoint p = airlight_point(light, ray, t, light_samples);
  p.sent *= light_texture(light, p.place);
  float density = medium_density(p.place);
  if (density == 0.0 || p.sent == vec3(0.0)) return vec3(0.0);
  float to_light = ray.parallel ? medium_length(medium, p.place, -p.from, 3.0e38)
                                : medium_length_between(medium, ray.source, p.place);
  return density * airlight_scattered(medium, ray, p, before + to_light);
}

// The lit part [a, b] of a stretch that begins at `start` metres, behind `before` metres of medium of density 1.
vec3 airlight_lit(Medium medium, Light light, AirlightRay ray, float a, float b, float start, float before) {
  vec3 sum = vec3(0.0);
  for (int i = -1; i <= 1; i += 2) {
    float t = airlight_metres(ray, 0.5 * (a + b) + float(i) * 0.5 * (b - a) * gauss_node);
    float within = (t - start) * medium_density(ray.eye + 0.5 * (start + t) * ray.direction);
    sum += airlight_node(medium, light, ray, t, before + within);
  }
  return 0.5 * (b - a) * sum;
}

#endif

// From one light or a point on it, between a and b metres along the ray.
vec3 airlight(Medium medium, Light light, ShadowLight maps, vec3 direction, float a, float b) {
  ShadowView first = shadow_views[maps.first_layer];
  AirlightRay ray = airlight_ray(medium, light, maps.origin, airlight_part(light, light_samples),
                                 frame.camera_position.xyz, direction);
  vec2 cone = light_cone_range(light, ray.eye, direction);
  a = max(a, cone.x);
  b = min(b, cone.y);
  if (!(a < b)) return vec3(0.0);
  float from = airlight_variable(ray, a);
  float to = airlight_variable(ray, b);
  vec3 sum = vec3(0.0);
  float start = from;
  bool start_lit = lit_at(maps, first, ray, from);
#if MARCH
  float before = medium_length(medium, ray.eye, direction, a);  // of density 1, between the eye and the stretch
#endif
  for (int i = 1; i <= steps; ++i) {
    float end = mix(from, to, float(i) / float(steps));
    bool end_lit = lit_at(maps, first, ray, end);
    float low = start;
    float high = end;
    // Only where a shadow begins or ends; a loop, because software renderers run both sides of an `if`.
    int left = start_lit != end_lit ? refinements : 0;
    while (left-- > 0) {
      float middle = 0.5 * (low + high);
      bool middle_lit = lit_at(maps, first, ray, middle);
      low = middle_lit == start_lit ? middle : low;
      high = middle_lit == start_lit ? high : middle;
    }
    float border = 0.5 * (low + high);
    float lit_from = start_lit ? start : border;
    float lit_to = end_lit ? end : border;
    int lit_stretch = start_lit || end_lit ? 1 : 0;
#if MARCH
    float metres = airlight_metres(ray, start);
    while (lit_stretch-- > 0) sum += airlight_lit(medium, light, ray, lit_from, lit_to, metres, before);
    before += stretch_length(ray, metres, airlight_metres(ray, end));
#else
    while (lit_stretch-- > 0) sum += airlight_stretch(medium, light, ray, lit_from, lit_to, light_samples);
#endif
    start = end;
    start_lit = end_lit;
  }
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  Medium medium = scene_medium();
  vec3 ray = pixel_ray(pixel);
  float metres_per_depth = length(ray);
  vec3 direction = ray / metres_per_depth;
  vec2 range = medium_range(medium, frame.camera_position.xyz, direction);
  float depth = pixel_depth(pixel);
  if (depth > 0.0) range.y = min(range.y, depth * metres_per_depth);
  range.x = max(range.x, 0.0);
  if (!(range.x < range.y)) return;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < light_count * light_samples; ++i) {
    ShadowLight maps = shadow_lights[i];
    Light light = lights[maps.light];
    if (!light_has_extent(light) && i % light_samples != 0) continue;  // one map for all samples
    sum += airlight(medium, light, maps, direction, range.x, range.y);
  }
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(sum, 0.0));
}
