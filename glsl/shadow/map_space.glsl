// The space of one shadow map: texels across, metres of depth. In it the comparisons of shadow_blocks() are planes, and the
// points of a light are a parallelogram on a plane at each gap from the receiver, so all that a receiver fixes is worked out
// once and a tap costs a few multiply-adds. The same answers as glsl/shadow/shadow_view.glsl and light_view_sample() give,
// for perspective and orthographic views.
#ifndef LIMN_MAP_SPACE_GLSL
#define LIMN_MAP_SPACE_GLSL
#include "glsl/light/light_view.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/shadow/shadow_view.glsl"
LIMN_BEGIN

// --- A dot product with what texels show ---

// n . b of what a texel (by its number) shows at `depth` metres, b in the view's axes, is depth (g.x x + g.y y + g.z) in a
// perspective and g.x x + g.y y + g.z + g.w depth in an orthographic view.
LIMN_FN vec4 map_gradient(ShadowView view, vec3 n) {
  vec2 across = view.footprint * vec2(n.x, n.y);
  vec2 first = vec2(0.5f) - float(view.size) * view.middle;  // of texel 0, from the axis
  float constant = dot(across, first);
  if (view.projection == shadow_perspective) constant += n.z;
  return vec4(across.x, across.y, constant, n.z);
}

LIMN_FN float map_dot(ShadowView view, vec4 gradient, vec2 texel, float depth) {
  float across = gradient.x * texel.x + (gradient.y * texel.y + gradient.z);
  return view.projection == shadow_orthographic ? across + gradient.w * depth : across * depth;
}

// --- What a receiver compares texels with: ShadowReceiver in the map's space ---

struct MapReceiver {
  vec4 plane;    // gradient along the receiver's normal
  vec4 axis;     // and along the light's axis
  float height;  // as ShadowReceiver's
  float depth;
};

// along_z: the light's axis is the view's, so that the receiver's depth is what the map holds.
LIMN_FN MapReceiver map_receiver(ShadowView view, ShadowReceiver receiver, bool along_z) {
  MapReceiver r;
  r.plane = map_gradient(view, receiver.normal);
  r.axis = map_gradient(view, receiver.axis);
  if (along_z) r.axis = vec4(0.0f, 0.0f, view.projection == shadow_orthographic ? 0.0f : 1.0f, 1.0f);
  r.height = receiver.height;
  r.depth = receiver.depth;
  return r;
}

// shadow_blocks() of what a texel shows at `depth` metres.
LIMN_FN bool map_blocks(ShadowView view, MapReceiver receiver, vec2 texel, float depth) {
  return map_dot(view, receiver.plane, texel, depth) > receiver.height &&
         map_dot(view, receiver.axis, texel, depth) < receiver.depth;
}

// Metres from it to the receiver along the light's axis.
LIMN_FN float map_gap(ShadowView view, MapReceiver receiver, vec2 texel, float depth) {
  return receiver.depth - map_dot(view, receiver.axis, texel, depth);
}

// Whether the light's centre lies beneath the receiver's tangent plane, raised by the bias. Rays from it then come up through the
// plane: what blocks lies between the plane and the receiver's depth, below no one depth.
LIMN_FN bool map_from_beneath(ShadowView view, MapReceiver receiver) {
  return view.projection == shadow_orthographic ? receiver.plane.w >= 0.0f : receiver.height >= 0.0f;
}

// Metres of depth at a place, texels (of which a texel's middle is at its number + 1/2): where the tangent plane, raised by the
// bias, lies there, and where the light's axis has the receiver's depth.
LIMN_FN vec2 map_limits(ShadowView view, MapReceiver receiver, vec2 place) {
  float x = place.x - 0.5f;
  float y = place.y - 0.5f;
  float along = receiver.axis.x * x + (receiver.axis.y * y + receiver.axis.z);
  float rise = receiver.plane.x * x + (receiver.plane.y * y + receiver.plane.z);
  float behind = receiver.depth;
  float above = receiver.height;
  if (view.projection == shadow_orthographic) {
    behind -= along;
    above -= rise;
    along = receiver.axis.w;
    rise = receiver.plane.w;
  }
  float plane = view.far;
  if (rise < 0.0f) plane = min(plane, above / rise);
  if (rise >= 0.0f && above >= 0.0f) plane = view.near;
  return vec2(plane, along > 0.0f ? min(view.far, behind / along) : view.far);
}

// The stored depth below which a texel at a place blocks the receiver: the lesser of the tangent plane's, raised by the bias,
// and the receiver's own along the light's axis. In [0, 1]. map_blocks() says the same of a point, except where
// map_from_beneath() holds.
LIMN_FN float map_threshold(ShadowView view, MapReceiver receiver, vec2 place) {
  vec2 limits = map_limits(view, receiver, place);
  return clamp(shadow_normalise(view, min(limits.x, limits.y)), 0.0f, 1.0f);
}

// Bounds of the stored depths below which texels in a box of places block: nearer than the first all of them do, not nearer than
// the second none does. The two planes may slope against each other, so that the lesser of them is greatest inside the box: each
// has its own range, which its values at the corners give. Where map_from_beneath() holds, what blocks lies behind the tangent
// plane, and the other one bounds it alone.
LIMN_FN vec2 map_threshold_range(ShadowView view, MapReceiver receiver, vec2 low, vec2 high) {
  vec2 a = map_limits(view, receiver, low);
  vec2 b = map_limits(view, receiver, vec2(high.x, low.y));
  vec2 c = map_limits(view, receiver, vec2(low.x, high.y));
  vec2 d = map_limits(view, receiver, high);
  vec2 least = min(min(a, b), min(c, d));
  vec2 most = max(max(a, b), max(c, d));
  if (map_from_beneath(view, receiver)) most.x = view.far;
  return clamp(vec2(shadow_normalise(view, min(least.x, least.y)), shadow_normalise(view, min(most.x, most.y))),
               vec2(0.0f), vec2(1.0f));
}

// The widest gap of anything in the box that lies `least` metres deep or deeper.
LIMN_FN float map_gap_bound(ShadowView view, MapReceiver receiver, vec2 low, vec2 high, float least) {
  vec2 from = low - vec2(0.5f);
  vec2 to = high - vec2(0.5f);
  float a = map_gap(view, receiver, from, least);
  float b = map_gap(view, receiver, vec2(to.x, from.y), least);
  float c = map_gap(view, receiver, vec2(from.x, to.y), least);
  float d = map_gap(view, receiver, to, least);
  return max(0.0f, max(max(a, b), max(c, d)));
}

// --- The points of a light, as one receiver sees them in a view ---

// The ray from the receiver to a light's point p is at receiver + gap (centre + p.x side_u + p.y side_v) in the view's axes,
// of which x and y are multiplied by what makes them texels: see map_texel().
struct MapKernel {
  vec3 receiver;
  vec3 centre;
  vec3 side_u;
  vec3 side_v;
};

LIMN_FN vec3 map_axes(ShadowView view, vec3 local) {
  float texels = view.scale * float(view.size);
  return vec3(texels * local.x, texels * local.y, local.z);
}

LIMN_FN MapKernel map_kernel(ShadowView view, LightView light, vec3 receiver) {
  MapKernel k;
  k.receiver = map_axes(view, shadow_local(view, receiver));
  k.centre = map_axes(view, shadow_view_axes(view, light.centre));
  k.side_u = map_axes(view, shadow_view_axes(view, light.side_u));
  k.side_v = map_axes(view, shadow_view_axes(view, light.side_v));
  return k;
}

// The same where the light's sides are the map's, so that all of a kernel is at one depth.
LIMN_FN MapKernel map_kernel_across(ShadowView view, LightView light, vec3 receiver) {
  MapKernel k = map_kernel(view, light, receiver);
  k.centre.z = -1.0f;
  k.side_u.z = 0.0f;
  k.side_v.z = 0.0f;
  return k;
}

LIMN_FN vec3 map_kernel_point(MapKernel kernel, vec2 p, float gap) {
  return kernel.receiver + gap * (kernel.centre + (p.x * kernel.side_u + p.y * kernel.side_v));
}

// Where it lies in the map, texels; -1 where a perspective view does not see it.
LIMN_FN vec2 map_texel(ShadowView view, vec3 point) {
  vec2 middle = float(view.size) * view.middle;
  if (view.projection == shadow_orthographic) return vec2(middle.x + point.x, middle.y + point.y);
  float inverse = 1.0f / max(point.z, 1e-30f);
  vec2 texel = vec2(middle.x + inverse * point.x, middle.y + inverse * point.y);
  return point.z > 0.0f ? texel : vec2(-1.0f);
}

// The kernel at one gap, where all of it is at one depth: map_texel() of its point p is
// centre + p.x side_u + p.y side_v.
struct MapBox {
  vec2 centre;
  vec2 side_u;
  vec2 side_v;
};

LIMN_FN MapBox map_box(ShadowView view, MapKernel kernel, float gap) {
  vec3 middle = kernel.receiver + gap * kernel.centre;
  float inverse = view.projection == shadow_orthographic ? 1.0f : 1.0f / max(middle.z, 1e-30f);
  MapBox box;
  box.centre = map_texel(view, middle);
  box.side_u = (inverse * gap) * vec2(kernel.side_u.x, kernel.side_u.y);
  box.side_v = (inverse * gap) * vec2(kernel.side_v.x, kernel.side_v.y);
  return box;
}

LIMN_FN vec2 map_box_texel(MapBox box, vec2 p) {
  return vec2(box.centre.x + (p.x * box.side_u.x + p.y * box.side_v.x),
              box.centre.y + (p.x * box.side_u.y + p.y * box.side_v.y));
}

LIMN_FN bool map_holds(ShadowView view, vec2 texel) {
  float size = float(view.size);
  return texel.x >= 0.0f && texel.y >= 0.0f && texel.x < size && texel.y < size;
}

// --- Which points of the light count ---

// The counted part of a rectangle as a rectangle of its own: u in [0, 1)^2 is a point of it. Of a disc, the disc.
LIMN_FN LightView light_view_part(LightView light) {
  if (light.cone) return light;
  LightView part = light;
  vec2 extent = light.high - light.low;
  part.centre = light.centre + (light.low.x * light.side_u + light.low.y * light.side_v);
  part.side_u = extent.x * light.side_u;
  part.side_v = extent.y * light.side_v;
  part.low = vec2(0.0f);
  part.high = vec2(1.0f);
  return part;
}

// What light_view_sample() tests: the slope of a point p of the light along the receiver's normal is
// rise.z + rise.x p.x + rise.y p.y.
LIMN_FN vec3 light_view_rise(LightView light) {
  return vec3(dot(light.side_u, light.normal), dot(light.side_v, light.normal), dot(light.centre, light.normal));
}

// The point of the light that u in [0, 1)^2 chooses, along its sides; false where light_view_sample() is.
LIMN_FN bool light_view_choose(LightView light, vec3 rise, vec2 u, LIMN_OUT(vec2) p) {
  p = light.low + u * (light.high - light.low);
  bool counts = true;
  if (light.cone) {
    float r2 = 4.0f * dot(p, p);
    counts = r2 <= 1.0f;
    p *= light_view_cone_scale(light, min(r2, 1.0f));
  }
  return counts && rise.z + (rise.x * p.x + rise.y * p.y) > 0.0f;
}

// --- Whether what a texel shows lies between the receiver and the light ---

// light_view_contains() of the offset to what a texel shows, divided by its gap.
struct MapCone {
  vec4 across_u;   // gradients: metres from the axis of the cone along the light's sides, times their length
  vec4 across_v;
  vec2 middle;
  vec2 reach;      // of the cone, per metre of gap
  vec2 tolerance;  // per metre of tolerance
};

LIMN_FN MapCone map_cone(ShadowView view, LightView light, vec3 receiver, MapReceiver from, vec3 axis) {
  MapCone c;
  vec3 local = shadow_local(view, receiver);
  vec3 centre = shadow_view_axes(view, light.centre);
  vec3 u = shadow_view_axes(view, light.side_u);
  vec3 v = shadow_view_axes(view, light.side_v);
  float cu = dot(centre, u);
  float cv = dot(centre, v);
  // With the gap as depth - axis . b, one gradient holds both terms of b . u - gap (centre . u).
  c.across_u = map_gradient(view, u + cu * axis);
  c.across_v = map_gradient(view, v + cv * axis);
  c.middle = vec2(dot(local, u) + from.depth * cu, dot(local, v) + from.depth * cv);
  if (light.cone) {
    c.reach = vec2(0.5f * light_view_cone_scale(light, 1.0f));
    c.tolerance = vec2(1.0f);
  } else {
    float uu = dot(u, u);
    float vv = dot(v, v);
    c.reach = vec2(0.5f * uu, 0.5f * vv);
    c.tolerance = vec2(sqrt(uu), sqrt(vv));
  }
  return c;
}

// tolerance: metres.
LIMN_FN bool map_cone_contains(ShadowView view, LightView light, MapCone cone, vec2 texel, float depth, float gap,
                               float tolerance) {
  vec2 offset = abs(vec2(map_dot(view, cone.across_u, texel, depth), map_dot(view, cone.across_v, texel, depth)) -
                    cone.middle);
  vec2 reach = gap * cone.reach + tolerance * cone.tolerance;
  if (light.cone) return dot(offset, offset) <= reach.x * reach.x;
  return offset.x <= reach.x && offset.y <= reach.y;
}

LIMN_END
#endif  // LIMN_MAP_SPACE_GLSL
