// Caustic rays: each texel of the specular buffers is a light ray, which is reflected at the front, or refracted there and
// again where it leaves the object, and ends where it meets the rest of the scene (thesis, section 8.3.2).
// PATHS: caustic_reflection | caustic_refraction; PATH_COUNT: how many these are. OBJECT_FACES 1: some points have several views of
// the specular objects.
#include "glsl/caustics/caustic_ray.glsl"
#include "glsl/caustics/specular_buffers.glsl"
#include "glsl/surface/gbuffer.glsl"
#include "glsl/light/light_intensity.glsl"
#include "glsl/light/light_texture.glsl"
#include "glsl/media/medium_input.glsl"
#include "glsl/indirect/reflective_map.glsl"
#include "glsl/shadow/map_path.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2DArray scene_depth;  // without specular objects
uniform sampler2DArray front_geometric_normal;
#if PATHS & 2
uniform sampler2DArray back_geometric_normal;
#endif
layout(std430) readonly buffer Lights { Light lights[]; };
layout(std430) readonly buffer Views { ShadowView views[]; };
layout(std430) readonly buffer Layers { CausticLayer layers[]; };
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Materials { Material materials[]; };
layout(std430) readonly buffer SceneViews { ShadowView scene_views[]; };
layout(std430) readonly buffer SceneLights { ShadowLight scene_lights[]; };
layout(std430) writeonly buffer Rays { CausticRay rays[]; };
uniform int light_samples;
uniform int steps;

const float least_cosine = 1e-4;
// Bisections: as many as halve the stride to an eighth of a texel of the scene's map, which are more where the scene reaches far.
const int least_end_refinements = 8;
const int most_end_refinements = 24;
const float shadow_bias = 2.0;  // texel footprints

// Place of what a texel of the scene's map shows, in the view's axes.
vec3 map_place(ShadowView view, ivec2 texel, uint layer) {
  return shadow_texel_offset(view, texel, texelFetch(scene_depth, ivec3(texel, layer), 0).x);
}

// The scene's maps of one light.
struct SceneMaps {
  ShadowView first;
  uint faces;
  uint layer;  // of the first view
};

// How far a place on a path through the maps lies behind what the light sees in the scene without specular objects, metres;
// < 0: before it, or nothing known.
float behind_scene(SceneMaps maps, MapPath path, float t) {
  MapPlace place = map_path_place(path, maps.first.projection, maps.faces, t);
  float stored = texelFetch(scene_depth, ivec3(map_path_texel(path, place), maps.layer + place.face), 0).x;
  return map_path_inside(path, place) && stored < 1.0 ? map_path_behind(path, place, stored) : -1.0;
}

bool light_blocked(SceneMaps maps, vec3 p) {
  float bias = shadow_bias * shadow_footprint(maps.first, length(p - maps.first.origin));
  return behind_scene(maps, map_path(maps.first, p, vec3(0.0)), 0.0) > bias;
}

// What a place on a ray is to the light's views.
const int place_free = 0;
const int place_scene = 1;   // behind the scene
const int place_object = 2;  // within a specular object

// A ray in the scene's maps, and in the views of the specular objects.
struct TracedRay {
  MapPath scene;
  MapPath objects;
  vec2 start;  // texel in these views
};

const float leaving_texels = 2.0;  // from the start of a ray, in which it has not left its object for certain

int place_of(SceneMaps maps, ObjectViews objects, TracedRay ray, float t) {
  MapPlace place = map_path_place(ray.objects, objects.first.projection, objects.faces, t);
  int layer = objects.layer + int(place.face);
  bool leaving = length(place.texel - ray.start) < leaving_texels;
  bool within = within_object(ray.objects, place, layer, shadow_footprint(objects.first, place.depth), leaving);
  return behind_scene(maps, ray.scene, t) > 0.0 ? place_scene : (within ? place_object : place_free);
}

// Normal of the scene at p, where a ray ends on it, against the ray: of the plane through the texels about p, towards the
// nearer neighbour on each axis, so that no edge is crossed where the scene goes on to either side.
vec3 end_normal(SceneMaps maps, vec3 p, vec3 direction) {
  uint layer = maps.layer + shadow_face(maps.faces, maps.first, p);
  ShadowView view = scene_views[layer];
  int last = int(view.size) - 1;
  ivec2 texel = clamp(ivec2(shadow_project(view, p).uv * float(view.size)), ivec2(0), ivec2(last));
  vec3 here = map_place(view, texel, layer);
  vec3 side[2];
  for (int axis = 0; axis < 2; ++axis) {
    ivec2 step = ivec2(1 - axis, axis);
    vec3 low = here - map_place(view, max(texel - step, ivec2(0)), layer);
    vec3 high = map_place(view, min(texel + step, ivec2(last)), layer) - here;
    bool forward = dot(low, low) == 0.0 || (dot(high, high) > 0.0 && dot(high, high) < dot(low, low));
    side[axis] = forward ? high : low;
  }
  vec3 normal = shadow_world_offset(view, cross(side[0], side[1]));
  float size = length(normal);
  if (size == 0.0) return -direction;
  return normal * ((dot(normal, direction) < 0.0 ? 1.0 : -1.0) / size);
}

// Ends the ray where it passes from before the scene to behind it, or into a specular object, as the light sees them.
void find_end(SceneMaps maps, ObjectViews objects, inout CausticRay ray) {
  MapPath in_objects = map_path(objects.first, ray.start, ray.direction);
  MapPlace start = map_path_place(in_objects, objects.first.projection, objects.faces, 0.0);
  TracedRay traced = TracedRay(map_path(maps.first, ray.start, ray.direction), in_objects, start.texel);
  float stride = ray.segment_length / float(steps);
  float before = 0.0;
  float behind = -1.0;
  int met = place_free;
  bool was_free = false;  // the crossing must be seen to happen
  for (int i = 0; i <= steps; ++i) {
    float t = stride * float(i);
    met = place_of(maps, objects, traced, t);
    if (met != place_free && was_free) {
      behind = t;
      break;
    }
    was_free = met == place_free;
    before = t;
  }
  if (behind < 0.0) return;
  float fine = 0.125 * shadow_footprint(maps.first, length(ray.start - maps.first.origin));
  for (int i = 0; i < most_end_refinements; ++i) {
    if (i >= least_end_refinements && behind - before <= fine) break;
    float t = 0.5 * (before + behind);
    int there = place_of(maps, objects, traced, t);
    if (there == place_free) {
      before = t;
    } else {
      behind = t;
      met = there;
    }
  }
  ray.segment_length = 0.5 * (before + behind);
  if (met != place_scene) return;
  vec3 end = ray.start + ray.segment_length * ray.direction;
  ray.kind = caustic_ray_surface;
  ray.normal = packSnorm2x16(octahedral_encode(end_normal(maps, end, ray.direction)));
}

CausticRay no_ray() { return CausticRay(vec3(0.0), 0.0, vec3(0.0, 0.0, 1.0), caustic_ray_none, vec3(0.0), 0u); }

// The light of one texel at the front of a specular object.
struct Incident {
  ShadowView view;
  int layer;
  ObjectViews objects;  // that view, and the others from the same point
  vec3 position;
  vec3 direction;  // unit, of propagation
  vec3 flux;       // W
  vec3 normal;     // unit, against the direction
  vec3 geometric;  // normal of the triangle, either side
  float instance;  // + 1
  bool inside;     // the light comes from within the body
  Optics optics;
};

CausticRay ray_from(Medium medium, SceneMaps maps, Incident at, vec3 start, vec3 direction, vec3 power) {
  float reach = ball_range(medium.ball, start, direction).y;
  if (!(reach > 0.0) || all(equal(power, vec3(0.0)))) return no_ray();
  CausticRay ray = CausticRay(start, reach, direction, caustic_ray_open, power, 0u);
  find_end(maps, at.objects, ray);
  return ray;
}

vec3 geometric_normal_at(sampler2DArray normals, ivec3 texel) { return octahedral_decode(texelFetch(normals, texel, 0).xy); }

CausticRay reflected_ray(Medium medium, SceneMaps maps, Incident at, SpecularEvent event) {
  if (at.inside && at.optics.thickness > 0.0) return no_ray();  // a sheet has no within
  float adjoint = shading_flux(at.normal, at.geometric, at.direction, event.reflected);
  return ray_from(medium, maps, at, at.position, event.reflected, at.flux * event.reflectance * adjoint);
}

#if PATHS & 2

// Of the triangle on which light leaves a body. By the edge of the body's picture the nearest texel may be beside it, where it has
// the normal of another body or none: then the shading normal, which neighbours gave.
vec3 exit_triangle(BodyExit leaves, float instance) {
  ivec2 size = textureSize(front_geometric_normal, 0).xy;
  ivec3 texel = ivec3(clamp(ivec2(leaves.uv * vec2(size)), ivec2(0), size - 1), leaves.layer);
  float shown = leaves.front ? texelFetch(front_surface, texel, 0).w : texelFetch(back_surface, texel, 0).w;
  if (abs(shown) != instance) return leaves.normal;
  return leaves.front ? geometric_normal_at(front_geometric_normal, texel)
                      : geometric_normal_at(back_geometric_normal, texel);
}

CausticRay refracted_ray(Medium medium, SceneMaps maps, Incident at, SpecularEvent event, float diameter) {
  if (event.refracted == vec3(0.0)) return no_ray();
  vec3 flux = at.flux * event.transmittance * shading_flux(at.normal, at.geometric, at.direction, event.refracted);
  if (flux == vec3(0.0)) return no_ray();
  if (at.inside || !(at.optics.thickness > 0.0) || is_sheet(body_depths_at(at.view, at.position, at.layer, at.instance)))
    return ray_from(medium, maps, at, at.position, event.refracted, flux);
  BodyExit leaves = body_exit(at.objects, at.position, event.refracted, diameter, at.instance);
  if (!(dot(leaves.normal, event.refracted) > least_cosine)) return no_ray();
  SpecularEvent second = specular_event(at.optics, event.refracted, -leaves.normal, true);
  if (second.refracted == vec3(0.0)) return no_ray();
  flux *= second.transmittance * optics_absorption(at.optics, leaves.distance);
  flux *= shading_flux(leaves.normal, exit_triangle(leaves, at.instance), event.refracted, second.refracted);
  return ray_from(medium, maps, at, at.position + leaves.distance * event.refracted, second.refracted, flux);
}

#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ShadowView view = views[at.z];
  CausticLayer layer = layers[at.z];
  ShadowLight scene = scene_lights[uint(layer.light)];
  SceneMaps maps = SceneMaps(scene_views[scene.first_layer], scene.faces, scene.first_layer);
  Light light = lights[scene.light];
  Medium medium = scene_medium();
  int side = int(view.size);
  if (any(greaterThanEqual(at.xy, ivec2(side)))) return;
  vec4 front = texelFetch(front_surface, at, 0);
  CausticRay reflection = no_ray();
  CausticRay refraction = no_ray();
  if (front.w != 0.0) {
    vec2 uv = (vec2(at.xy) + 0.5) / float(side);
    vec3 local = shadow_unproject_local(view, uv, shadow_metres(view, texelFetch(front_depth, at, 0).x));
    Incident incident;
    incident.view = view;
    incident.layer = at.z;
#if OBJECT_FACES
    incident.objects = ObjectViews(views[layer.first], layer.faces, int(layer.first));
#else
    incident.objects = ObjectViews(view, shadow_faces_single, at.z);
#endif
    incident.position = view.origin + shadow_world_offset(view, local);
    bool parallel = view.projection == shadow_orthographic;
    incident.direction = parallel ? view.axis_z : normalize(incident.position - view.origin);
    incident.instance = abs(front.w);
    incident.inside = front.w < 0.0;
    incident.normal = incident.inside ? -front.xyz : front.xyz;
    incident.geometric = geometric_normal_at(front_geometric_normal, at);
    incident.optics = material_optics(materials[instances[uint(incident.instance) - 1u].material]);
    incident.flux = light_point_intensity(light, view.origin, incident.position, light_samples) *
                    (light_fluence(light) * reflective_map_measure(view, uv) / (float(side) * float(side)));
    incident.flux *= light_texture(light, incident.position);
    if (incident.inside && !parallel && incident.optics.thickness > 0.0) {
      incident.flux *= optics_absorption(incident.optics, length(incident.position - view.origin));  // no medium fills a body
    } else {
      float inside = parallel ? medium_length(medium, incident.position, -incident.direction, 3.0e38)
                              : medium_length_between(medium, view.origin, incident.position);
      incident.flux *= medium_transmittance(medium, inside);
    }
    bool dark = incident.flux == vec3(0.0) || !(dot(incident.normal, -incident.direction) > least_cosine);
    if (!dark && !light_blocked(maps, incident.position)) {
      SpecularEvent event = specular_event(incident.optics, incident.direction, incident.normal, incident.inside);
#if PATHS & 1
      reflection = reflected_ray(medium, maps, incident, event);
#endif
#if PATHS & 2
      refraction = refracted_ray(medium, maps, incident, event, layer.diameter);
#endif
    }
  }
  int index = (at.z * side + at.y) * side + at.x;
#if PATHS & 1
  rays[index] = reflection;
#endif
#if PATHS & 2
  rays[index + (PATH_COUNT - 1) * int(gl_NumWorkGroups.z) * side * side] = refraction;
#endif
}
