// What the camera sees in a specular surface: light that is mirrored at its front, and light that comes through the object
// behind it (Wyman 2005, An Approximate Image-Space Approach for Interactive Refraction, with the true way to the back
// instead of an estimated thickness). Both end in the picture of the scene without specular surfaces, else in the
// environment, else in the dark.
//
// INTERFACES: most smooth interfaces of a path. ENVIRONMENT 1: there is a map. MEDIUM 1: there is a medium.
#include "glsl/caustics/caustic_ray.glsl"
#include "glsl/numeric/equirectangular.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/media/medium_input.glsl"
#include "glsl/caustics/specular_buffers.glsl"
#include "techniques/image_space_refraction/scene_ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) writeonly uniform image2D seen;
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Materials { Material materials[]; };
layout(std430) readonly buffer Views { ShadowView views[]; };
#if ENVIRONMENT
uniform sampler2D environment_map;
#endif
uniform float diameter;  // of the widest specular object, metres
uniform int steps;

const float least_cosine = 1e-4;

// Light that comes against `direction` (unit) to `origin`, off every surface that is not specular, as the camera has it: squared
// indices of refraction of where it is and of where these surfaces are. The environment is outside of all bodies.
vec3 scene_radiance(vec3 origin, vec3 direction, float at_camera, float here) {
  float reach = max(ball_range(frame.medium_ball, origin, direction).y, 0.0);
  SceneHit hit = scene_hit(origin, direction, reach, steps);
  vec3 light = vec3(0.0);
  if (hit.t >= 0.0) {
    light = at_camera / here * radiance_at(hit, origin + hit.t * direction);
  } else {
#if ENVIRONMENT
    vec2 uv = equirectangular_uv(environment_lookup_direction(direction, frame.environment_rotation));
    light = at_camera * frame.environment_scale * textureLod(environment_map, uv, 0.0).rgb;
#endif
  }
#if MEDIUM
  Medium medium = scene_medium();
  float end = hit.t >= 0.0 ? hit.t : 3.0e38;
  light *= medium_transmittance(medium, medium_length(medium, origin, direction, end));
#endif
  return light;
}

// Light on its way out of an object, followed against its direction.
struct Way {
  vec3 origin;
  vec3 direction;  // unit, away from the object
  vec3 weight;     // share of it that reaches the viewer; 0: none is found
};

// From the front of a body at `origin` along `direction` (unit) to where it is left: at most INTERFACES - 1 interfaces further on.
Way through_body(Optics optics, vec3 origin, vec3 direction, vec3 weight, float instance) {
  Way way = Way(origin, direction, weight);
  bool inside = true;
  for (int i = 1; i < INTERFACES && inside; ++i) {
    ObjectViews objects = ObjectViews(views[0], shadow_faces_single, 0);
    BodyExit leaves = body_exit(objects, way.origin, way.direction, diameter, instance);
    if (!(dot(leaves.normal, way.direction) > least_cosine)) break;
    SpecularEvent event = specular_event(optics, way.direction, -leaves.normal, true);
    way.origin += leaves.distance * way.direction;
    way.weight *= optics_absorption(optics, leaves.distance);
    inside = event.refracted == vec3(0.0);
    way.direction = inside ? event.reflected : event.refracted;
    way.weight *= inside ? event.reflectance : event.transmittance;
  }
  if (inside) way.weight = vec3(0.0);
  return way;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  GBufferSurface s = pixel_surface(pixel);
  if (depth == 0.0 || (s.flags & gbuffer_flag_specular) == 0u) {
    imageStore(seen, pixel, vec4(0.0, 0.0, 0.0, 1.0));
    return;
  }
  uint instance = pixel_instance(pixel);
  Optics optics = material_optics(materials[instances[instance].material]);
  optics.base = s.base_colour;
  optics.metallic = s.metallic;
  vec3 position = pixel_position(pixel, depth);
  vec3 view = -normalize(pixel_ray(pixel));
  vec3 normal = dot(s.normal, view) > least_cosine ? s.normal : s.geometric_normal;
  bool inside = (s.flags & gbuffer_flag_back) != 0u;
  SpecularEvent event = specular_event(optics, -view, normal, inside);
  float at_camera = squared_index(optics, inside);
  vec3 light = vec3(0.0);
  if (event.reflectance != vec3(0.0)) {
    light += event.reflectance * scene_radiance(position, event.reflected, at_camera, at_camera);
  }
  Way way = Way(position, event.refracted, event.refracted == vec3(0.0) ? vec3(0.0) : event.transmittance);
  float object = float(instance + 1u);
  bool bends = !inside && optics.thickness > 0.0;
  vec2 depths = bends ? body_depths_at(views[0], position, 0, object) : vec2(-1.0);
  bool through = bends && !is_sheet(depths);
  if (through && way.weight != vec3(0.0)) way = through_body(optics, way.origin, way.direction, way.weight, object);
  // Light of what lies behind a sheet has one interface to pass; of the edge of a body that the buffers lack, as many as elsewhere.
  float here = squared_index(optics, !through && depths.x >= 0.0);
  if (way.weight != vec3(0.0)) light += way.weight * scene_radiance(way.origin, way.direction, at_camera, here);
  imageStore(seen, pixel, vec4(light, 1.0));
}
