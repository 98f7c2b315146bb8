// Photons as points: each where its ray meets a surface, as large as its kernel. CAUSTIC_MAP 0: on the screen; 1: in one
// layer of the light's map.
#include "glsl/caustics/ray_beam.glsl"
#include "glsl/medium_input.glsl"
#if CAUSTIC_MAP
#include "techniques/surface_caustics/caustic_map.glsl"

layout(std430, binding = 3) readonly buffer LayerLights { vec4 layer_lights[]; };  // x: of scene_lights
uniform int layer_count;  // of the rays
uniform int map_layer;
#endif

uniform float kernel;  // radius in distances between photons

layout(location = 0) flat out vec4 photon;      // xyz: place; w: radius of the kernel, m
layout(location = 1) flat out vec3 flux;        // W
layout(location = 2) flat out vec3 incidence;   // unit, of propagation

const float widest_point = 64.0;     // pixels
const float least_radius = 1.0;      // pixels

// Where a point is drawn; w <= 0: nowhere.
struct Target {
  vec4 clip;
  float pixel;  // side of a pixel there, m
};

Target target_of(int index, vec3 place) {
#if CAUSTIC_MAP
  ShadowLight maps = scene_lights[int(layer_lights[index / (buffer_size * buffer_size) % layer_count].x)];
  if (uint(map_layer) - maps.info.x >= shadow_face_count(maps.info.y)) return Target(vec4(0.0), 0.0);
  ShadowView view = scene_views[map_layer];
  // The viewport reaches half the widest point beyond the map, so that kernels which reach into it are not left out.
  float size = float(view.info.z);
  vec4 clip = shadow_clip(view, place);
  clip.xy *= size / (size + widest_point);
  return Target(clip, shadow_footprint(view, shadow_view_depth(view, place)));
#else
  vec4 clip = frame.world_to_clip * vec4(place, 1.0);
  return Target(clip, -(frame.world_to_view * vec4(place, 1.0)).z * length(frame.view_ray_dx.xyz));
#endif
}

void main() {
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = 1.0;
  int index = gl_VertexID;
  CausticRay ray = rays[index];
  photon = vec4(0.0);
  flux = vec3(0.0);
  incidence = ray.direction.xyz;
  if (ray.direction.w != caustic_ray_surface) return;
  vec3 place = ray.start.xyz + ray.start.w * ray.direction.xyz;
  Target target = target_of(index, place);
  if (!(target.clip.w > 0.0 && target.pixel > 0.0)) return;
  Medium medium = scene_medium();
  flux = ray.power.rgb * medium_transmittance(medium, medium_length(medium, ray.start.xyz, ray.direction.xyz, ray.start.w));

  int x = index % buffer_size;
  int y = index / buffer_size % buffer_size;
  CausticRay beside = rays[beam_neighbour(index, 1, x)];
  CausticRay above = rays[beam_neighbour(index, buffer_size, y)];
  float distance = max(length(beam_side(ray, beside, ray.start.w)), length(beam_side(ray, above, ray.start.w)));
  float radius = clamp(kernel * distance, least_radius * target.pixel, 0.5 * widest_point * target.pixel);
  photon = vec4(place, radius);
  gl_PointSize = 2.0 * radius / target.pixel + 2.0;
  gl_Position = vec4(target.clip.xy, 0.0, target.clip.w);
}
