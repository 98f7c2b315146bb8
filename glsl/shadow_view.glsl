// Shadow views: how a world point maps to a shadow map and back, what a stored depth means, how wide the kernels
// of percentage-closer soft shadows are, and when a stored depth counts as a blocker. Lengths in metres.
//
// A view looks along axis_z from origin; axis_x and axis_y point along the map's u and v, and
// cross(axis_x, axis_y) = -axis_z. Depth is linear: distance along axis_z (perspective, orthographic) or from
// the origin (paraboloid). A map stores (depth - near) / (far - near), and 1 where nothing is.
#ifndef LIMN_SHADOW_VIEW_GLSL
#define LIMN_SHADOW_VIEW_GLSL
#include "glsl/language.glsl"
LIMN_BEGIN

LIMN_CONST uint shadow_perspective = 0u;
LIMN_CONST uint shadow_orthographic = 1u;
LIMN_CONST uint shadow_paraboloid = 2u;

struct ShadowView {
  vec4 origin;  // xyz: centre of projection (orthographic: any point of the axis plane z = 0); w: near
  vec4 axis_x;  // w: scale s; uv = middle + s (x, y) / z (perspective: s = 1 / width at z = 1)
                //    or middle + s (x, y) (orthographic: s = 1 / width) or 1/2 + s (x, y) / (r + z) (paraboloid: 1/2)
  vec4 axis_y;  // w: footprint: side of a texel at unit depth (orthographic: at any depth)
  vec4 axis_z;  // w: far
  vec4 middle;  // xy: uv of the axis x = y = 0; zw: unused
  uvec4 info;   // x: shadow_perspective, ...; y: layer; z: texels per side; w: light
};

// How the layers of one light, or of one sample on it, share its surroundings.
LIMN_CONST uint shadow_faces_single = 0u;  // one view
LIMN_CONST uint shadow_faces_pair = 1u;    // two views, along +z and -z of the first
LIMN_CONST uint shadow_faces_hemicube = 2u;  // +z, +x, -x, +y, -y
LIMN_CONST uint shadow_faces_cube = 3u;      // the same and -z

LIMN_CONST uint no_light = 0xffffffffu;  // parallel light that is no light of the scene

struct ShadowLight {
  vec4 origin;  // xyz: the sample's position; directional: unit vector towards the light, w: 0 then, else 1
  uvec4 info;   // x: first layer, y: shadow_faces_*, z: light or no_light, w: unused
};

LIMN_FN uint shadow_face_count(uint faces) {
  return faces == shadow_faces_single ? 1u : faces == shadow_faces_pair ? 2u : faces == shadow_faces_hemicube ? 5u : 6u;
}

// A point of space in a view.
struct ShadowPoint {
  vec2 uv;      // [0, 1]^2 inside the map
  float depth;  // metres; <= 0: the view does not see it
};

// r: offset from the view's origin, in the view's axes.
LIMN_FN vec3 shadow_local(ShadowView view, vec3 p) {
  vec3 r = p - vec3(view.origin);
  return vec3(dot(vec3(view.axis_x), r), dot(vec3(view.axis_y), r), dot(vec3(view.axis_z), r));
}

// Which of a light's views sees p; `first` is the light's first view.
LIMN_FN uint shadow_face(uint faces, ShadowView first, vec3 p) {
  if (faces == shadow_faces_single) return 0u;
  vec3 r = shadow_local(first, p);
  if (faces == shadow_faces_pair) return r.z >= 0.0f ? 0u : 1u;
  float x = abs(r.x);
  float y = abs(r.y);
  float z = abs(r.z);
  if (faces == shadow_faces_hemicube) z = max(r.z, 0.0f);
  if (z >= x && z >= y) return r.z >= 0.0f ? 0u : 5u;
  if (x >= y) return r.x >= 0.0f ? 1u : 2u;
  return r.y >= 0.0f ? 3u : 4u;
}

LIMN_FN ShadowPoint shadow_project_local(ShadowView view, vec3 r) {
  ShadowPoint q;
  float s = view.axis_x.w;
  if (view.info.x == shadow_orthographic) {
    q.uv = vec2(view.middle.x + s * r.x, view.middle.y + s * r.y);
    q.depth = r.z;
    return q;
  }
  float divisor = r.z;
  q.depth = r.z;
  if (view.info.x == shadow_paraboloid) {
    q.depth = sqrt(dot(r, r));
    divisor = q.depth + r.z;
  }
  if (divisor <= 0.0f) {
    q.uv = vec2(-1.0f);
    q.depth = 0.0f;
    return q;
  }
  float k = s / divisor;
  q.uv = vec2(view.middle.x + k * r.x, view.middle.y + k * r.y);
  return q;
}

LIMN_FN ShadowPoint shadow_project(ShadowView view, vec3 p) { return shadow_project_local(view, shadow_local(view, p)); }

LIMN_FN bool shadow_inside(ShadowPoint q) {
  return q.depth > 0.0f && q.uv.x >= 0.0f && q.uv.x < 1.0f && q.uv.y >= 0.0f && q.uv.y < 1.0f;
}

// Offset from the origin, in the view's axes, of what lies at `depth` metres behind uv: the inverse of
// shadow_project_local.
LIMN_FN vec3 shadow_unproject_local(ShadowView view, vec2 uv, float depth) {
  float x = (uv.x - view.middle.x) / view.axis_x.w;
  float y = (uv.y - view.middle.y) / view.axis_x.w;
  if (view.info.x == shadow_orthographic) return vec3(x, y, depth);
  if (view.info.x == shadow_perspective) return vec3(x * depth, y * depth, depth);
  // Paraboloid: (x, y) = (dx, dy) / (1 + dz) with unit d, so dz = (1 - x^2 - y^2) / (1 + x^2 + y^2).
  float k = 2.0f / (1.0f + x * x + y * y);
  return depth * vec3(k * x, k * y, k - 1.0f);
}

// An offset from the origin in the view's axes, in world axes.
LIMN_FN vec3 shadow_world_offset(ShadowView view, vec3 r) {
  return r.x * vec3(view.axis_x) + r.y * vec3(view.axis_y) + r.z * vec3(view.axis_z);
}

// A vector of the world in the view's axes.
LIMN_FN vec3 shadow_view_axes(ShadowView view, vec3 w) {
  return vec3(dot(vec3(view.axis_x), w), dot(vec3(view.axis_y), w), dot(vec3(view.axis_z), w));
}

// The depth of an offset from the origin: what shadow_project_local finds.
LIMN_FN float shadow_depth_of(ShadowView view, vec3 r) {
  return view.info.x == shadow_paraboloid ? sqrt(dot(r, r)) : r.z;
}

// Depth of a point, metres: what shadow_project gives for points the view sees.
LIMN_FN float shadow_view_depth(ShadowView view, vec3 p) {
  vec3 r = shadow_local(view, p);
  return view.info.x == shadow_paraboloid ? sqrt(dot(r, r)) : r.z;
}

// Metres to what the map stores, and back.
LIMN_FN float shadow_normalise(ShadowView view, float depth) {
  return (depth - view.origin.w) / (view.axis_z.w - view.origin.w);
}
LIMN_FN float shadow_metres(ShadowView view, float stored) {
  return view.origin.w + stored * (view.axis_z.w - view.origin.w);
}

// What a texel, whose depth as stored is given, shows at its centre: offset from the origin, in the view's axes.
LIMN_FN vec3 shadow_texel_offset(ShadowView view, ivec2 texel, float stored) {
  vec2 uv = (vec2(texel) + 0.5f) / float(view.info.z);
  return shadow_unproject_local(view, uv, shadow_metres(view, stored));
}

// Clip coordinates for rasterising the view: depth in [0, 1], reversed (near: 1, far: 0). The perspective ones keep
// the precision of floating-point depth over any range.
LIMN_FN vec4 shadow_clip(ShadowView view, vec3 p) {
  vec3 r = shadow_local(view, p);
  float near = view.origin.w;
  float far = view.axis_z.w;
  float s = 2.0f * view.axis_x.w;
  float x = 2.0f * view.middle.x - 1.0f;
  float y = 2.0f * view.middle.y - 1.0f;
  if (view.info.x == shadow_perspective) {
    return vec4(s * r.x + x * r.z, s * r.y + y * r.z, near * ((far - r.z) / (far - near)), r.z);
  }
  if (view.info.x == shadow_orthographic) return vec4(s * r.x + x, s * r.y + y, (far - r.z) / (far - near), 1.0f);
  float depth = sqrt(dot(r, r));
  float divisor = max(depth + r.z, 1e-6f * depth);
  return vec4(s * r.x / divisor, s * r.y / divisor, (far - depth) / (far - near), 1.0f);
}

// Side of a texel, metres, at `depth` (on a surface that faces the view).
LIMN_FN float shadow_footprint(ShadowView view, float depth) {
  return view.info.x == shadow_orthographic ? view.axis_y.w : view.axis_y.w * depth;
}

// Kernel of the cone from a receiver at depth d to a light of side `size`, cut at depth z, as a fraction of the map's
// width (soft-shadow framework, steps 1 and 3; Fernando 2005): with z the near plane the initial kernel w_i, with z the
// average blocker depth the penumbra kernel w_p. Orthographic: `size` is 2 tan(angular diameter / 2).
LIMN_FN float shadow_kernel_width(ShadowView view, float size, float d, float z) {
  float gap = max(d - z, 0.0f);
  if (view.info.x == shadow_orthographic) return size * gap * view.axis_x.w;
  return size * gap * view.axis_x.w / (d * z);
}

// What a receiver compares stored depths with. A stored depth is a blocker where its point lies
//   nearer to the light than the receiver along the light's axis, and
//   above the receiver's tangent plane by more than the bias.
// The second test is the receiver-plane depth bias without its approximation: a plane never shadows itself, whatever
// its slope and however wide the kernel. The bias counts texel footprints, so that a contact shadow detaches by at most
// `bias` texels, measured on the receiver.
struct ShadowReceiver {
  vec4 plane;  // xyz: normal in the view's axes; w: height of the receiver over the view's origin plus the bias
  vec4 axis;   // xyz: the light's axis in the view's axes; w: the receiver's depth along it
};

// p, normal: the receiver and its geometric normal (unit); axis: unit vector from the light towards the receiver's side
// (rectangle: its normal; directional: its direction; point and spot: from the light to the receiver).
LIMN_FN ShadowReceiver shadow_receiver(ShadowView view, vec3 p, vec3 normal, vec3 axis, float bias) {
  vec3 r = p - vec3(view.origin);
  ShadowReceiver receiver;
  float h = dot(normal, r);
  // The footprint at the receiver's distance holds for all faces of a cube, seen from whichever the tap lands in.
  float depth = view.info.x == shadow_orthographic ? 1.0f : sqrt(dot(r, r));
  receiver.plane = vec4(dot(normal, vec3(view.axis_x)), dot(normal, vec3(view.axis_y)),
                        dot(normal, vec3(view.axis_z)), h + bias * view.axis_y.w * depth);
  receiver.axis = vec4(dot(axis, vec3(view.axis_x)), dot(axis, vec3(view.axis_y)), dot(axis, vec3(view.axis_z)),
                       dot(axis, r));
  return receiver;
}

// b: offset of the stored point, in the view's axes.
LIMN_FN bool shadow_blocks(ShadowReceiver receiver, vec3 b) {
  return dot(vec3(receiver.plane), b) > receiver.plane.w && dot(vec3(receiver.axis), b) < receiver.axis.w;
}

LIMN_END
#endif  // LIMN_SHADOW_VIEW_GLSL
