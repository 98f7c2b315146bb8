// Airlight: each viewing ray is cut into stretches that are even in the angle from the light; of each, the part that the
// light reaches is integrated (glsl/media/airlight_path.glsl). In a medium with a grid, what it takes on the way to the eye is
// summed along the stretches, and what it takes on the way from the light is looked up at each node.
//
// A dispatch adds a part: of the maps of its lights, one after another, or of the stretches under one of them.
#include "glsl/media/airlight_path.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/light/light_texture.glsl"
#include "glsl/media/medium_input.glsl"
#include "glsl/shadow/alike_lights.glsl"
#include "glsl/shadow/map_path.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
uniform int light_samples;
uniform int steps;  // stretches of a ray
// Of the part: the first one, and the one after the last.
uniform int first_map;
uniform int end_map;
uniform int first_stretch;
uniform int end_stretch;

const int refinements = 6;  // of the place where a ray enters or leaves a shadow

// A viewing ray as one light, or a point on it, sees it.
struct LitRay {
  AirlightPath path;
  MapPath maps;
  uint projection;
  uint faces;
  uint first_layer;
  uint kind;
  vec3 source;  // as AirlightRay's
};

bool lit_at(LitRay ray, float q) {
  MapPlace place = map_path_place(ray.maps, ray.projection, ray.faces, q);
  ivec3 texel = ivec3(map_path_texel(ray.maps, place), ray.first_layer + place.face);
  float stored = texelFetch(shadow_depth, texel, 0).x;
  return !(map_path_inside(ray.maps, place) && stored < 1.0 && map_path_behind(ray.maps, place, stored) > 0.0);
}

#if MEDIUM_STEPS > 0

// Metres of medium of density 1 in the stretch from a to b (Gauss-Legendre, two nodes).
float stretch_length(AirlightPath path, float a, float b) {
  float middle = 0.5 * (a + b);
  float step = 0.5 * (b - a) * gauss_node;
  return 0.5 * (b - a) * (medium_density(airlight_path_place(path, middle - step)) +
                          medium_density(airlight_path_place(path, middle + step)));
}

#endif

// Radiance per unit of the variable from one node over path.sent. start: of the stretch; before: metres of medium of density 1
// between it and the eye, where the medium has a grid.
vec3 airlight_node(Medium medium, Light light, LitRay ray, float q, float start, float before) {
  vec3 factor = vec3(airlight_path_factor(ray.path, ray.kind, q));
#if LIGHT_TEXTURES
  factor *= light_texture(light, airlight_path_place(ray.path, q));
#endif
#if MEDIUM_STEPS > 0
  vec3 place = airlight_path_place(ray.path, q);
  factor *= medium_density(place);
  if (factor == vec3(0.0)) return vec3(0.0);
  before += (q - start) * medium_density(airlight_path_place(ray.path, 0.5 * (start + q)));
  float to_light = airlight_parallel(ray.kind) ? medium_length(medium, place, -light.direction, 3.0e38)
                                               : medium_length_between(medium, ray.source, place);
  return factor * medium_transmittance(medium, before + to_light);
#else
  return factor * medium_transmittance(medium, airlight_path_length(ray.path, ray.kind, q));
#endif
}

// From the part of a stretch that the nodes stand for, over path.sent.
vec3 airlight_part_of(Medium medium, Light light, LitRay ray, vec2 start, vec2 end, AirlightNodes nodes, float before) {
  float start_q = airlight_place_of(start);
  return nodes.weight *
         (airlight_node(medium, light, ray, airlight_between(start, end, nodes.shares.x), start_q, before) +
          airlight_node(medium, light, ray, airlight_between(start, end, nodes.shares.y), start_q, before));
}

// From one light or a point on it, between a and b metres along the ray.
vec3 airlight(Medium medium, Light light, ShadowLight maps, vec3 direction, float a, float b) {
  ShadowView first = view_of_layer(maps.first_layer);
  LitRay ray;
  ray.kind = kind_of_light(light);
  ray.path = airlight_path(medium, light, ray.kind,
                           airlight_ray(medium, light, maps.origin, airlight_part(light, light_samples),
                                        frame.camera_position.xyz, direction),
                           light_samples);
  ray.maps = map_path(first, ray.path.base, direction);
  ray.projection = first.projection;
  ray.faces = maps.faces;
  ray.first_layer = maps.first_layer;
  ray.source = maps.origin;
  vec2 cone = light_cone_range(light, frame.camera_position.xyz, direction);
  vec2 ball = light_ball_range(light, frame.camera_position.xyz, direction);
  a = max(a, max(cone.x, ball.x));
  b = min(b, min(cone.y, ball.y));
  if (!(a < b)) return vec3(0.0);
  float from = airlight_path_variable(ray.path, ray.kind, a);
  float to = airlight_path_variable(ray.path, ray.kind, b);
  float stretch = (to - from) / float(steps);
  AirlightNodes whole = airlight_nodes(ray.kind, 0.5 * stretch, -1.0, 1.0);
  vec3 sum = vec3(0.0);
  vec2 start = airlight_end(ray.path, ray.kind, from + float(first_stretch) * stretch);
  bool start_lit = lit_at(ray, airlight_place_of(start));
  float before = 0.0;
#if MEDIUM_STEPS > 0
  before = medium_length(medium, frame.camera_position.xyz, direction, a);  // between the eye and the stretch
  for (int i = 0; i < first_stretch; ++i) {
    vec2 earlier = airlight_end(ray.path, ray.kind, from + float(i) * stretch);
    vec2 later = airlight_end(ray.path, ray.kind, from + float(i + 1) * stretch);
    before += stretch_length(ray.path, airlight_place_of(earlier), airlight_place_of(later));
  }
#endif
  vec2 end = start;
  // Two loops, whole stretches up to the next border and then the border: in one, each border of one ray would hold up all rays
  // that are followed at once.
  for (int i = first_stretch; i < end_stretch;) {
    bool border = false;
    while (i < end_stretch) {
      ++i;
      end = airlight_end(ray.path, ray.kind, i < steps ? from + float(i) * stretch : to);
      border = lit_at(ray, airlight_place_of(end)) != start_lit;
      if (border) break;
      if (start_lit) sum += airlight_part_of(medium, light, ray, start, end, whole, before);
#if MEDIUM_STEPS > 0
      before += stretch_length(ray.path, airlight_place_of(start), airlight_place_of(end));
#endif
      start = end;
    }
    if (!border) break;
    vec2 shares = vec2(-1.0, 1.0);
    for (int r = 0; r < refinements; ++r) {
      float middle = 0.5 * (shares.x + shares.y);
      bool before_border = lit_at(ray, airlight_between(start, end, middle)) == start_lit;
      shares = before_border ? vec2(middle, shares.y) : vec2(shares.x, middle);
    }
    float at = 0.5 * (shares.x + shares.y);
    AirlightNodes nodes = airlight_nodes(ray.kind, 0.5 * stretch, start_lit ? -1.0 : at, start_lit ? at : 1.0);
    sum += airlight_part_of(medium, light, ray, start, end, nodes, before);
#if MEDIUM_STEPS > 0
    before += stretch_length(ray.path, airlight_place_of(start), airlight_place_of(end));
#endif
    start = end;
    start_lit = !start_lit;
  }
  return ray.path.sent * sum;
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
  for (int i = first_map; i < end_map; ++i) {
    ShadowLight maps = maps_at(uint(light_layers[i / light_samples] * light_samples + i % light_samples));
    Light light = lights[maps.light];
    if (!light_has_extent(light) && i % light_samples != 0) continue;  // one map for all samples
    sum += airlight(medium, light, maps, direction, range.x, range.y);
  }
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(sum, 0.0));
}
