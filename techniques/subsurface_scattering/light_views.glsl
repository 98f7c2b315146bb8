// Light that enters where the camera does not look, from the reflective maps of the lights that it comes from.
//
// B(x) / C is the integral of R(|x - p|) E(p) dA over the body, with R = Rd / C the profile's density. Of what the camera does not
// show, all that a light reaches is in its map, and E = 0 elsewhere. A light at o sends I dw into the solid angle dw, of which
// F_t enters: E dA = F_t(n.w) I dw, without the quotient dA / dw = |p - o|^2 / n.w, which is large where light grazes. Points p'
// are drawn with density q in the plane through x across the light's direction, and p is what the light sees behind or before p':
//     dw = |x - o| / |p' - o|^3 dA',   B(x) / C = 1/N sum R(|x - p|) / q(|x - p'|) F_t I |x - o| / |p' - o|^3
// For parallel light I is its irradiance, and the last factor is 1; there |x - p| >= |x - p'|, so that points drawn from the
// profile have weights of 1 at most. Each place of the body is counted once: by the points in the image where the camera shows it,
// else here, once for each light. Means over hits and by weights (NORMALISE 1 and 2) already stand for what would be seen beside
// the picture.
//
// It needs of its includer: planes, points, Drawing and drawn_point().
// MAP_POINTS: points on each light that maps are drawn from; the points around a pixel are dealt out to them. MEDIUM 1: the medium
// takes of the light.
#ifndef LIGHT_VIEWS_GLSL
#define LIGHT_VIEWS_GLSL
#include "glsl/indirect/reflective_texel.glsl"
#if MEDIUM
#include "glsl/media/medium_input.glsl"
#endif
#include "techniques/subsurface_scattering/diffusion_body.glsl"

uniform usampler2DArray reflective_instance;
layout(std430) readonly buffer MapLights { ShadowLight map_lights[]; };  // light by light, point by point
uniform int map_light_count;

// A place less than so many pixels' widths behind what the camera shows there is what it shows.
const float same_surface = 2.0;

// A place that a light's map shows.
struct LitPlace {
  vec3 position;  // world, m
  vec3 normal;    // geometric, on the light's side
  vec3 light;     // E / pi times the quotient of its area and that of the plane that points are drawn in
  bool met;       // it is on the body
};

// What the ray from the light through `drawn` meets; `across` is the distance of the drawing plane from the light.
LitPlace lit_place(ShadowView view, vec3 drawn, float across, uint instance, DiffusionBoundary boundary) {
  bool parallel = view.projection == shadow_orthographic;
  ShadowPoint q = shadow_project(view, drawn);
  LitPlace p;
  p.met = shadow_inside(q);
  ivec3 texel = ivec3(p.met ? ivec2(q.uv * float(view.size)) : ivec2(0), view.layer);
  p.met = p.met && texelFetch(reflective_instance, texel, 0).x == instance;
  float stored = texelFetch(reflective_depth, texel, 0).r;
  p.normal = octahedral_decode(texelFetch(reflective_normal, texel, 0).xy);
  // The ray meets the plane of the texel: light would be created where all that it covers were at its centre.
  vec3 ray = drawn - view.origin;
  float length2 = dot(ray, ray);
  vec3 along = parallel ? view.axis_z : ray * inversesqrt(max(length2, 1e-30));
  vec3 centre = shadow_world_offset(view, shadow_texel_offset(view, texel.xy, stored));
  vec3 at = shadow_world_offset(view, shadow_unproject_local(view, q.uv, shadow_metres(view, stored)));
  float cosine = max(-dot(p.normal, along), reflective_map_least_cosine);
  at -= along * (dot(p.normal, centre - at) / cosine);
  p.position = view.origin + at;
  float measure = parallel ? 1.0 : across * inversesqrt(max(length2, 1e-30)) / max(length2, 1e-30);
  ReflectiveTexel lit;
  lit.position = p.position;
  lit.normal = p.normal;
  vec3 intensity = texel_intensity(view, lit);
#if MAP_POINTS > 1
  // Points on a disc have what passes a place between them; what a surface gets of it follows from the directions of them all.
  intensity *= light_fluence(lights[view.light]);
#endif
  p.light = intensity * (inverse_pi * diffusion_entry(boundary, cosine) * measure);
#if MEDIUM
  Medium medium = scene_medium();
  float inside = parallel ? medium_length(medium, p.position, -view.axis_z, 3.0e38)
                          : medium_length_between(medium, view.origin, p.position);
  p.light *= medium_transmittance(medium, inside);
#endif
  return p;
}

// Whether the camera shows that place of the body, by which way it faces and by depth. `screen`: screen_of_places().
bool is_shown(LitPlace p, uint instance, mat3 screen) {
  vec3 from_eye = p.position - frame.camera_position.xyz;
  vec3 shown = screen * from_eye;
  vec2 at = shown.xy / max(shown.z, 1e-30) + 0.5;
  bool inside = shown.z > 0.0 && all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(frame.frame_size)));
  uvec4 met = texelFetch(planes, inside ? ivec2(at) : ivec2(0), 0);
  float farther = dot(uintBitsToFloat(met.xyz), from_eye);
  bool nearest = met.w == instance && farther < 1.0 + same_surface * length(frame.view_ray_dx.xyz);
  return dot(p.normal, from_eye) < 0.0 && (inside ? nearest : NORMALISE != 0);
}

// The part of the mean of E / pi over the profile that the camera does not show, around `place`, from the eye. `sub_buffer`: the
// place in the pattern whose points are drawn.
vec3 hidden_light(Drawing from, DiffusionBody body, DiffusionBoundary boundary, vec3 place, uint instance, uint sub_buffer,
                  mat3 screen) {
  uint first_point = body.first_point + sub_buffer * uint(SAMPLES);
  vec3 x = frame.camera_position.xyz + place;
  vec3 sum = vec3(0.0);
  for (int l = 0; l < map_light_count; ++l) {
    for (int m = 0; m < MAP_POINTS; ++m) {
      ShadowLight maps = map_lights[l * MAP_POINTS + m];
      ShadowView first = views[maps.first_layer];
      vec3 way = first.projection == shadow_orthographic ? first.axis_z : x - first.origin;
      float across = max(length(way), 1e-30);
      Frame plane = frame_around(way / across);
      for (int i = (m + int(sub_buffer)) % MAP_POINTS; i < SAMPLES; i += MAP_POINTS) {
        DrawnPoint point = drawn_point(from, i, first_point + uint(i));
        vec3 drawn = x + body.unit * (point.offset.x * plane.t + point.offset.y * plane.b);
        ShadowView view = first;
        uint face = shadow_face(maps.faces, first, drawn);
        if (face != 0u) view = views[maps.first_layer + face];
        LitPlace p = lit_place(view, drawn, across, instance, boundary);
        if (!p.met || is_shown(p, instance, screen)) continue;
        float r = max(distance(p.position, x) / body.unit, 1e-12);
        sum += diffusion_density(from.colours, r) * point.inverse_density * p.light;
      }
    }
  }
  return sum / float(SAMPLES);
}

#endif  // LIGHT_VIEWS_GLSL
