// Airlight: each viewing ray is cut into stretches that are even in the angle from the light; of each, the part that the
// light reaches is integrated (glsl/airlight.glsl).
#include "glsl/airlight.glsl"
#include "glsl/gbuffer_input.glsl"
#include "glsl/medium_input.glsl"
#include "glsl/shadow_view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f, binding = 0) uniform image2D radiance;
layout(binding = 8) uniform sampler2DArray shadow_depth;
layout(std430, binding = 0) readonly buffer Lights { Light lights[]; };
layout(std430, binding = 1) readonly buffer ShadowViews { ShadowView shadow_views[]; };
layout(std430, binding = 2) readonly buffer ShadowLights { ShadowLight shadow_lights[]; };
uniform int light_count;
uniform int light_samples;
uniform int steps;

const int refinements = 6;  // of the place where a ray enters or leaves a shadow

bool lit(ShadowLight maps, ShadowView first, vec3 p) {
  ShadowView view = first;
  uint layer = maps.info.x;
  if (maps.info.y != shadow_faces_single) {
    layer += shadow_face(maps.info.y, first, p);
    view = shadow_views[layer];
  }
  ShadowPoint q = shadow_project(view, p);
  if (!shadow_inside(q)) return true;
  ivec2 texel = min(ivec2(q.uv * float(view.info.z)), ivec2(view.info.z) - 1);
  float stored = texelFetch(shadow_depth, ivec3(texel, layer), 0).x;
  return !(stored < 1.0 && shadow_metres(view, stored) < q.depth);
}

bool lit_at(ShadowLight maps, ShadowView first, AirlightRay ray, float variable) {
  return lit(maps, first, ray.eye + airlight_metres(ray, variable) * ray.direction);
}

// From one light or a point on it, between a and b metres along the ray.
vec3 airlight(Medium medium, Light light, ShadowLight maps, vec3 direction, float a, float b) {
  ShadowView first = shadow_views[maps.info.x];
  AirlightRay ray = airlight_ray(medium, light, maps.origin.xyz, frame.camera_position.xyz, direction);
  float from = airlight_variable(ray, a);
  float to = airlight_variable(ray, b);
  vec3 sum = vec3(0.0);
  float start = from;
  bool start_lit = lit_at(maps, first, ray, from);
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
    while (lit_stretch-- > 0) sum += airlight_stretch(medium, light, ray, lit_from, lit_to, light_samples);
    start = end;
    start_lit = end_lit;
  }
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size.xy)))) return;
  Medium medium = scene_medium();
  vec3 ray = pixel_ray(pixel);
  float metres_per_depth = length(ray);
  vec3 direction = ray / metres_per_depth;
  vec2 range = ball_range(medium.ball, frame.camera_position.xyz, direction);
  float depth = pixel_depth(pixel);
  if (depth > 0.0) range.y = min(range.y, depth * metres_per_depth);
  range.x = max(range.x, 0.0);
  if (!(range.x < range.y)) return;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < light_count * light_samples; ++i) {
    ShadowLight maps = shadow_lights[i];
    Light light = lights[maps.info.z];
    if (!light_has_extent(light) && i % light_samples != 0) continue;  // one map for all samples
    sum += airlight(medium, light, maps, direction, range.x, range.y);
  }
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(sum, 0.0));
}
