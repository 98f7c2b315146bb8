// What a compute pass that answers `visibility` starts from: its bindings (shadow::addVisibilityPass fills them), the
// receiver of a pixel and the light of a layer.
//
// Define WHOLE_BIAS 1 before including this to keep the whole bias where a light with extent grazes.
#ifndef LIMN_VISIBILITY_GLSL
#define LIMN_VISIBILITY_GLSL
#include "glsl/gbuffer_input.glsl"
#include "glsl/light_view.glsl"
#include "glsl/shadow_kernel.glsl"
#include "glsl/shadow_view.glsl"

#ifndef WHOLE_BIAS
#define WHOLE_BIAS 0
#endif

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 8) uniform sampler2DArray shadow_depth;
layout(std430, binding = 0) readonly buffer Lights { Light lights[]; };
layout(std430, binding = 1) readonly buffer ShadowViews { ShadowView shadow_views[]; };
layout(std430, binding = 2) readonly buffer ShadowLights { ShadowLight shadow_lights[]; };
layout(std430, binding = 3) buffer ShadowCoverage { uint uncovered_pixels; };
uniform float bias;        // texel footprints
uniform float light_size;  // metres or radians; < 0: the scene's

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
  q.maps = shadow_lights[maps];
  q.first = shadow_views[q.maps.info.x];
  float depth = pixel_depth(at);
  q.position = pixel_position(at, depth);
  q.normal = pixel_geometric_normal(at);
  Light light = lights[q.maps.info.z];
  q.light = light_view(light, q.position, q.normal, light_size);
  bool itself = light.info.z != no_instance && pixel_instance(at) == light.info.z;
  q.masked = depth == 0.0 || itself || q.light.masked;
  return q;
}

// The share of the bias that a receiver needs. shadow_receiver() takes the bias across the tangent plane; along the
// light's rays that is 1 / cosine times as long, and where the light grazes it lifts the plane above the light's centre,
// so that nothing blocks. But the slope is in the plane already: twice `bias` along the rays suffices (up to 60 degrees
// nothing changes), and of that a little for what depths and normals are rounded to.
float bias_share(ShadowView view, VisibilityQuery q) {
  if (WHOLE_BIAS == 1 && q.light.extended) return 1.0;
  vec3 r = q.position - view.origin.xyz;
  vec3 ray = view.info.x == shadow_orthographic ? view.axis_z.xyz : r / max(length(r), 1e-30);
  return clamp(-2.0 * dot(q.normal, ray), 0.02, 1.0);
}

// The view that taps of a query land in; kept between taps, most of which land in the same one.
struct ShadowCursor {
  uint face;
  uint layer;
  ShadowView view;
  ShadowReceiver receiver;
};

ShadowCursor shadow_cursor_at(VisibilityQuery q, uint face) {
  ShadowCursor cursor;
  cursor.face = face;
  cursor.layer = q.maps.info.x + face;
  cursor.view = q.first;
  if (face != 0u) cursor.view = shadow_views[cursor.layer];
  cursor.receiver = shadow_receiver(cursor.view, q.position, q.normal, q.light.axis,
                                    bias * bias_share(cursor.view, q));
  return cursor;
}

// Starts in the view that sees the receiver.
ShadowCursor shadow_cursor(VisibilityQuery q) {
  return shadow_cursor_at(q, shadow_face(q.maps.info.y, q.first, q.position));
}

// One texel of a shadow map against the receiver.
struct ShadowTap {
  bool blocked;
  vec3 offset;  // from the view's origin to what the map holds, in the view's axes
};

// A texel of the cursor's view, which lies in the map.
ShadowTap shadow_texel(ShadowCursor cursor, ivec2 texel) {
  float stored = texelFetch(shadow_depth, ivec3(texel, cursor.layer), 0).r;
  ShadowTap tap;
  tap.offset = shadow_texel_offset(cursor.view, texel, stored);
  tap.blocked = stored < 1.0 && shadow_blocks(cursor.receiver, tap.offset);
  return tap;
}

// The texel that holds the direction of world point p.
ShadowTap shadow_tap(inout ShadowCursor cursor, VisibilityQuery q, vec3 p) {
  if (q.maps.info.y != shadow_faces_single) {
    uint face = shadow_face(q.maps.info.y, q.first, p);
    // A loop of at most one round: software renderers run both sides of an `if`, but leave a loop that nobody is in.
    while (face != cursor.face) cursor = shadow_cursor_at(q, face);
  }
  ShadowTap tap;
  tap.blocked = false;
  ShadowPoint at = shadow_project(cursor.view, p);
  if (!shadow_inside(at)) return tap;
  return shadow_texel(cursor, min(ivec2(at.uv * float(cursor.view.info.z)), ivec2(cursor.view.info.z) - 1));
}

// The four texels of the cursor's view around the direction of p, weighted bilinearly: the lit share.
float shadow_tap_2x2(ShadowCursor cursor, vec3 p) {
  ShadowPoint at = shadow_project(cursor.view, p);
  if (!shadow_inside(at)) return 1.0;
  vec2 corner = at.uv * float(cursor.view.info.z) - 0.5;
  vec2 weight = fract(corner);
  float lit = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 texel = clamp(ivec2(floor(corner)) + step, ivec2(0), ivec2(cursor.view.info.z) - 1);
    vec2 w = mix(1.0 - weight, weight, vec2(step));
    if (!shadow_texel(cursor, texel).blocked) lit += w.x * w.y;
  }
  return lit;
}

// Pixels whose receiver no map of the light covers have V = 1 and are counted.
bool shadow_covers_receiver(ShadowCursor cursor, VisibilityQuery q) {
  if (shadow_inside(shadow_project(cursor.view, q.position))) return true;
  atomicAdd(uncovered_pixels, 1u);
  return false;
}

// From the receiver to the near plane along the light's axis, metres: the gap of the initial kernel as published. The
// near plane lies that far from the view's origin for directional lights, from the light for all others.
float shadow_near_gap(ShadowCursor cursor, VisibilityQuery q) {
  if (cursor.view.info.x == shadow_orthographic && !q.light.cone) {
    // The map looks along the centre of the distant rectangle, which is not across the rectangle's plane.
    float gap = shadow_view_depth(cursor.view, q.position) - cursor.view.origin.w;
    return max(gap, 0.0) / -dot(cursor.view.axis_z.xyz, q.light.centre);
  }
  float depth = q.light.cone ? dot(q.light.axis, q.position - cursor.view.origin.xyz) : q.light.depth;
  return max(depth - cursor.view.origin.w, 0.0);
}

// Techniques that filter boxes go through all views of a light, and weight what they find by ShadowKernel::weight:
//   for (uint face = 0u; face < shadow_face_count(q.maps.info.y); ++face)
//     if (shadow_kernel_in_face(cursor, q, face, gap, kernel)) ...
// which moves the cursor to a view that the kernel lies in.
bool shadow_kernel_in_face(inout ShadowCursor cursor, VisibilityQuery q, uint face, float gap,
                           out ShadowKernel kernel) {
  while (face != cursor.face) cursor = shadow_cursor_at(q, face);
  return shadow_kernel(cursor.view, q.light, q.position, gap, q.maps.info.y == shadow_faces_single, kernel);
}

#endif  // LIMN_VISIBILITY_GLSL
