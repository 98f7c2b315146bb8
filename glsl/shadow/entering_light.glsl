// The light that enters translucent bodies at places of their surfaces, for techniques that need it where pixels are not:
// core/shadow/entering_light.h declares what is read. Places that the camera sees take it from the picture, with all that lights
// it. The others are lit by the lights alone, each through the nearest texel of a shadow map from its centre. LIGHT_COUNT: lights
// with maps. MEDIUM 1: the medium takes of their light.
#ifndef LIMN_ENTERING_LIGHT_GLSL
#define LIMN_ENTERING_LIGHT_GLSL
#include "glsl/diffusion/boundary.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#if LIGHT_COUNT
#include "glsl/light/light_texture.glsl"
#include "glsl/light/light_view.glsl"
#include "glsl/media/light_transmittance.glsl"
#include "glsl/shadow/alike_lights.glsl"
#endif

uniform sampler2D entering;  // E / pi
#if LIGHT_COUNT
uniform float bias;  // texel footprints
#endif

struct EntryPlace {
  vec3 position;  // world, m
  vec3 normal;    // unit, outwards
  uint instance;  // draw instance
  float reach;    // m: side of the area that the place stands for
};

// Whether the camera sees the place, at `pixel`: what is seen there lies as near as pixels and places can tell.
bool seen_at(EntryPlace place, out ivec2 pixel) {
  vec4 clip = frame.world_to_clip * vec4(place.position, 1.0);
  vec2 at = (0.5 + 0.5 * clip.xy / clip.w) * vec2(frame.frame_size);
  pixel = ivec2(floor(at));
  bool inside = clip.w > 0.0 && all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(frame.frame_size)));
  if (!inside) return false;
  float depth = pixel_depth(pixel);
  if (depth == 0.0 || pixel_instance(pixel) != place.instance) return false;
  vec3 way = pixel_position(pixel, depth) - place.position;
  float apart = max(place.reach, 2.0 * depth * length(frame.view_ray_dx.xyz));
  return dot(way, way) <= apart * apart && dot(place.normal, frame.camera_position.xyz - place.position) > 0.0;
}

#if LIGHT_COUNT
// E / pi of one light without occlusion, W/(sr m^2).
vec3 entering_unshadowed(Light light, DiffusionBoundary boundary, vec3 p, vec3 n) {
  bool distant = light_is_distant_rectangle(light) && (light.flags & light_flag_centre) == 0u;
  if (light.type == light_rectangle || distant) {
    if (!rectangle_emits_towards(light, p)) return vec3(0.0);
    Rectangle r = rectangle_from(light, p);
    vec3 towards = rectangle_vector_irradiance(r, rectangle_above(r, n));
    float size = length(towards);
    float irradiance = abs(dot(towards, n));
    float entry = size > 0.0 ? diffusion_entry(boundary, irradiance / size) : 0.0;
    return rectangle_radiance(light) * (receiver_factor(light, p) * min(inverse_pi * irradiance, 1.0) * entry);
  }
  vec3 way = light.type == light_directional ? -light.direction : light.position - p;
  float size = length(way);
  float cosine = size > 0.0 ? dot(n, way) / size : 0.0;
  if (cosine <= 0.0) return vec3(0.0);
  return punctual_irradiance(light, p) * (inverse_pi * cosine * diffusion_entry(boundary, cosine));
}

// Whether the map of a light shows the point lit (Williams 1978).
bool lit_by_map(ShadowLight maps, Light light, vec3 p, vec3 n) {
  LightView towards = light_view(light, p, n, -1.0);
  if (towards.masked) return false;
  uint layer = maps.first_layer + shadow_face(maps.faces, view_of_layer(maps.first_layer), p);
  ShadowView view = view_of_layer(layer);
  ShadowPoint place = shadow_project(view, p);
  if (!shadow_inside(place)) return true;
  ivec2 texel = min(ivec2(place.uv * float(view.size)), ivec2(view.size) - 1);
  float stored = texelFetch(shadow_depth, ivec3(texel, layer), 0).r;
  ShadowReceiver receiver = shadow_receiver(view, p, n, towards.axis, bias);
  return stored >= 1.0 || !shadow_blocks(receiver, shadow_texel_offset(view, texel, stored));
}

vec3 entering_of(ShadowLight maps, DiffusionBoundary boundary, vec3 p, vec3 n) {
  Light light = lights[maps.light];
  vec3 arriving = entering_unshadowed(light, boundary, p, n);
  if (arriving == vec3(0.0) || !lit_by_map(maps, light, p, n)) return vec3(0.0);
  return arriving * light_transmittance(light, p) * light_texture(light, p);
}
#endif

// E / pi at a place of a body with this index of refraction, W/(sr m^2).
vec3 light_that_enters(EntryPlace place, float eta) {
  ivec2 pixel;
  if (seen_at(place, pixel)) return texelFetch(entering, pixel, 0).rgb;
  vec3 sum = vec3(0.0);
#if LIGHT_COUNT
  DiffusionBoundary boundary = diffusion_boundary(eta);
  for (uint i = 0u; i < uint(LIGHT_COUNT); ++i) sum += entering_of(maps_at(i), boundary, place.position, place.normal);
#endif
  return sum;
}

#endif  // LIMN_ENTERING_LIGHT_GLSL
