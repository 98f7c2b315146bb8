// What a compute pass that answers `visibility` starts from: its inputs (shadow::addVisibilityPass names them), the
// receiver of a pixel and the light of a layer.
//
// shadow::addVisibilityPass() defines what all lights of a dispatch have in common: glsl/shadow/alike_lights.glsl.
//
// Define WHOLE_BIAS 1 before including this to keep the whole bias where a light with extent grazes.
#ifndef LIMN_VISIBILITY_GLSL
#define LIMN_VISIBILITY_GLSL
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/light/light_view.glsl"
#include "glsl/shadow/alike_lights.glsl"
#include "glsl/shadow/map_space.glsl"
#include "glsl/shadow/shadow_kernel.glsl"
#include "glsl/shadow/shadow_view.glsl"

#ifndef WHOLE_BIAS
#define WHOLE_BIAS 0
#endif

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) buffer ShadowCoverage { uint uncovered_pixels; };
uniform float bias;        // texel footprints
uniform float light_size;  // metres or radians; < 0: the scene's

// The place in the request of the light that the work group answers for: its layer of the answer.
int light_layer() { return light_layers[gl_WorkGroupID.z]; }

// Whether the axis of the light is that of each of its views. (Directions of a disc have views of their own, where they are
// sampled.)
bool axis_along_view() {
#if defined(SHADOW_FACES) && defined(LIGHT_KIND)
  return uint(SHADOW_FACES) == shadow_faces_single && uint(LIGHT_KIND) == light_kind_rectangle;
#else
  return false;
#endif
}

// One pixel and one light.
struct VisibilityQuery {
  vec3 position;
  vec3 normal;  // geometric, unit, towards the camera
  LightView light;
  ShadowLight maps;
  ShadowView first;  // of those maps
  bool masked;  // V = 1: nothing there, or the light is wholly behind the surface
};

// maps: an index into shadow_lights, the same for the whole work group; called before invocations part ways, because
// software renderers load what is uniform once for all of them.
VisibilityQuery visibility_query(ivec2 at, uint maps) {
  VisibilityQuery q;
  q.maps = maps_at(maps);
  q.first = view_of_layer(q.maps.first_layer);
  float depth = pixel_depth(at);
  q.position = pixel_position(at, depth);
  q.normal = pixel_geometric_normal(at);
  Light light = lights[q.maps.light];
  q.light = light_view_of_kind(light, kind_of_light(light), q.position, q.normal, light_size);
  bool itself = pixel_shows_light(at, light);
  q.masked = depth == 0.0 || itself || q.light.masked;
  return q;
}

// The share of the bias that a receiver needs. shadow_receiver() takes the bias across the tangent plane; along the
// light's rays that is 1 / cosine times as long, and where the light grazes it lifts the plane above the light's centre,
// so that nothing blocks. But the slope is in the plane already: twice `bias` along the rays suffices (up to 60 degrees
// nothing changes), and of that a little for what depths and normals are rounded to.
float bias_share(ShadowView view, VisibilityQuery q) {
  if (WHOLE_BIAS == 1 && q.light.extended) return 1.0;
  vec3 r = q.position - view.origin;
  float cosine = view.projection == shadow_orthographic ? dot(q.normal, view.axis_z)
                                                        : dot(q.normal, r) / max(length(r), 1e-30);
  return clamp(-2.0 * cosine, 0.02, 1.0);
}

// The view that taps of a query land in; kept between taps, most of which land in the same one.
struct ShadowCursor {
  uint face;
  uint layer;
  ShadowView view;
  ShadowReceiver receiver;
  MapReceiver in_map;  // the same, in the view's map
};

ShadowCursor shadow_cursor_at(VisibilityQuery q, uint face) {
  ShadowCursor cursor;
  cursor.face = face;
  cursor.layer = q.maps.first_layer + face;
  cursor.view = q.first;
  if (face != 0u) cursor.view = view_of_layer(cursor.layer);
  cursor.receiver = shadow_receiver(cursor.view, q.position, q.normal, q.light.axis,
                                    bias * bias_share(cursor.view, q));
  cursor.in_map = map_receiver(cursor.view, cursor.receiver, axis_along_view());
  return cursor;
}

// Starts in the view that sees the receiver.
ShadowCursor shadow_cursor(VisibilityQuery q) {
#if ONE_VIEW
  return shadow_cursor_at(q, 0u);
#else
  return shadow_cursor_at(q, shadow_face(q.maps.faces, q.first, q.position));
#endif
}

// One texel of a shadow map against the receiver.
struct ShadowTap {
  bool blocked;
  vec2 texel;
  float depth;  // metres
};

// A texel of the cursor's view, which lies in the map.
ShadowTap shadow_texel(ShadowCursor cursor, ivec2 texel) {
  float stored = texelFetch(shadow_depth, ivec3(texel, cursor.layer), 0).r;
  ShadowTap tap;
  tap.texel = vec2(texel);
  tap.depth = shadow_metres(cursor.view, stored);
  tap.blocked = stored < 1.0 && map_blocks(cursor.view, cursor.in_map, tap.texel, tap.depth);
  return tap;
}

// The texel that holds a place of the map; none where it lies outside.
ShadowTap shadow_tap_at(ShadowCursor cursor, vec2 place) {
  ShadowTap tap = shadow_texel(cursor, ivec2(place));
  tap.blocked = tap.blocked && map_holds(cursor.view, place);
  return tap;
}

// Where the cursor's map holds the direction of world point p, texels.
vec2 shadow_place(ShadowCursor cursor, vec3 p) {
  return map_texel(cursor.view, map_axes(cursor.view, shadow_local(cursor.view, p)));
}

// Moves the cursor to the view that sees world point p.
void shadow_cursor_towards(inout ShadowCursor cursor, VisibilityQuery q, vec3 p) {
#if !ONE_VIEW
  uint face = shadow_face(q.maps.faces, q.first, p);
  if (face != cursor.face) cursor = shadow_cursor_at(q, face);
#endif
}

// The texel that holds the direction of world point p.
ShadowTap shadow_tap(inout ShadowCursor cursor, VisibilityQuery q, vec3 p) {
  shadow_cursor_towards(cursor, q, p);
  return shadow_tap_at(cursor, shadow_place(cursor, p));
}

// The view that sees the ray from the receiver to point p of a light (light_view_choose) at some gap.
uint face_of_light_point(VisibilityQuery q, LightView light, vec2 p, float gap) {
  vec3 slope = light.centre + (p.x * light.side_u + p.y * light.side_v);
  return shadow_face(q.maps.faces, q.first, q.position + gap * slope);
}

// The four texels around the direction of p in the view that sees it, weighted bilinearly: the lit share.
float shadow_tap_2x2(inout ShadowCursor cursor, VisibilityQuery q, vec3 p) {
  shadow_cursor_towards(cursor, q, p);
  vec2 place = shadow_place(cursor, p);
  if (!map_holds(cursor.view, place)) return 1.0;
  vec2 corner = place - 0.5;
  vec2 weight = fract(corner);
  float lit = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 texel = clamp(ivec2(floor(corner)) + step, ivec2(0), ivec2(cursor.view.size) - 1);
    vec2 w = mix(1.0 - weight, weight, vec2(step));
    if (!shadow_texel(cursor, texel).blocked) lit += w.x * w.y;
  }
  return lit;
}

// Whether the maps of the light hold the receiver. Where they do not, V = 1 and the pixel is counted.
bool shadow_covers_receiver(ShadowCursor cursor, VisibilityQuery q) {
  return map_holds(cursor.view, shadow_place(cursor, q.position));
}

// From the receiver to the near plane along the light's axis, metres: the gap of the initial kernel as published. The
// near plane lies that far from the view's origin for directional lights, from the light for all others; where the faces of
// a rectangle share it, what counts is where its rays reach it.
float shadow_near_gap(ShadowCursor cursor, VisibilityQuery q) {
  if (cursor.view.projection == shadow_orthographic && !q.light.cone) {
    // The map looks along the centre of the distant rectangle, which is not across the rectangle's plane.
    float gap = shadow_view_depth(cursor.view, q.position) - cursor.view.near;
    return max(gap, 0.0) / -dot(cursor.view.axis_z, q.light.centre);
  }
  float depth = q.light.cone ? dot(q.light.axis, q.position - cursor.view.origin) : q.light.depth;
  float near = cursor.view.near;
#if !ONE_VIEW
  bool faces = q.maps.faces == shadow_faces_hemicube || q.maps.faces == shadow_faces_cube;
  if (faces && kind_of_light(lights[q.maps.light]) == light_kind_rectangle) {
    near = shadow_faces_nearest(q.first, q.light, q.position);
  }
#endif
  return max(depth - near, 0.0);
}

// Techniques that filter boxes go through all views of a light, and weight what they find by ShadowKernel::weight:
//   for (uint face = 0u; face < shadow_face_count(q.maps.faces); ++face)
//     if (shadow_kernel_in_face(cursor, q, face, gap, least, kernel)) ...
// which moves the cursor to a view that the kernel lies in.
bool shadow_kernel_in_face(inout ShadowCursor cursor, VisibilityQuery q, uint face, float gap, float least,
                           out ShadowKernel kernel) {
#if !ONE_VIEW
  if (face != cursor.face) cursor = shadow_cursor_at(q, face);
#endif
  return shadow_kernel(cursor.view, q.light, q.position, gap, shadow_views_apart(q.maps.faces), least, kernel);
}

#endif  // LIMN_VISIBILITY_GLSL
