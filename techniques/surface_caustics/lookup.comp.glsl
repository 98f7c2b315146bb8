// Irradiance of the caustics on what the camera sees, from the lights' caustic maps: interpolated among those texels that
// show the same surface.
#include "glsl/surface/gbuffer_input.glsl"
#include "techniques/surface_caustics/caustic_map.glsl"
#include "techniques/surface_caustics/on_plane.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2DArray caustic_map;  // W/m^2
layout(rgba32f) writeonly uniform image2D irradiance;
uniform int light_count;  // of scene_lights

const int points = 2;            // per side of a pixel, over which the map is averaged: it may be finer than the picture
const float least_cosine = 0.1;  // the pixel's plane is stretched no further than by its inverse
const float plane_bias = 2.0;    // texel footprints by which a texel's surface may leave the receiver's plane

vec3 map_irradiance(ShadowLight maps, vec3 position, vec3 normal) {
  vec3 towards = maps.finite > 0.0 ? maps.origin - position : maps.origin;
  if (!(dot(normal, towards) > 0.0)) return vec3(0.0);
  ShadowView view = scene_views[maps.first_layer + shadow_face(maps.faces, scene_views[maps.first_layer], position)];
  ShadowPoint q = shadow_project(view, position);
  if (!shadow_inside(q)) return vec3(0.0);
  int size = int(view.size);
  vec2 corner = q.uv * float(size) - 0.5;
  vec2 weight = fract(corner);
  float bias = plane_bias * shadow_footprint(view, q.depth);
  vec3 sum = vec3(0.0);
  float total = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 texel = ivec2(floor(corner)) + step;
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(size)))) continue;
    MapSurface surface = map_surface(view, texel);
    if (!surface.present || abs(dot(normal, surface.position - position)) > bias) continue;
    vec2 w = mix(1.0 - weight, weight, vec2(step));
    sum += w.x * w.y * texelFetch(caustic_map, ivec3(texel, view.layer), 0).rgb;
    total += w.x * w.y;
  }
  return total > 0.0 ? sum / total : vec3(0.0);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  vec3 sum = vec3(0.0);
  if (depth > 0.0) {
    vec3 position = pixel_position(pixel, depth);
    vec3 normal = pixel_geometric_normal(pixel);
    vec3 ray = normalize(pixel_ray(pixel));
    for (int p = 0; p < points * points; ++p) {
      vec2 offset = (vec2(p % points, p / points) + 0.5) / float(points) - 0.5;
      vec3 across = depth * (offset.x * frame.view_ray_dx.xyz + offset.y * frame.view_ray_dy.xyz);
      vec3 place = position + on_plane(across, normal, ray, least_cosine);
      for (int i = 0; i < light_count; ++i) {
        // Samples of a light without extent share its map.
        if (i > 0 && scene_lights[i].first_layer == scene_lights[i - 1].first_layer) continue;
        sum += map_irradiance(scene_lights[i], place, normal);
      }
    }
  }
  imageStore(irradiance, pixel, vec4(sum / float(points * points), 0.0));
}
