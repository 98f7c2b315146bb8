// Shadow views: how a world point maps to a shadow map and back, what a stored depth means, how wide the kernels
// of percentage-closer soft shadows are, and when a stored depth counts as a blocker. Lengths in metres.
//
// A view looks along axis_z from origin; axis_x and axis_y point along the map's u and v, and
// cross(axis_x, axis_y) = -axis_z. Depth is linear: distance along axis_z (perspective, orthographic) or from
// the origin (paraboloid). A map stores (depth - near) / (far - near), and 1 where nothing is.
#ifndef LIMN_SHADOW_VIEW_GLSL
#define LIMN_SHADOW_VIEW_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_CONST uint shadow_perspective = 0u;
LIMN_CONST uint shadow_orthographic = 1u;
LIMN_CONST uint shadow_paraboloid = 2u;

struct ShadowView {
  vec3 origin;  // centre of projection (orthographic: any point of the axis plane z = 0)
  float near;
  vec3 axis_x;
  float scale;  // s; uv = middle + s (x, y) / z (perspective: s = 1 / width at z = 1) or middle + s (x, y)
                // (orthographic: s = 1 / width) or 1/2 + s (x, y) / (r + z) (paraboloid: 1/2)
  vec3 axis_y;
  float footprint;  // side of a texel at unit depth (orthographic: at any depth)
  vec3 axis_z;
  float far;
  vec2 middle;  // uv of the axis x = y = 0
  uvec2 unused;
  uint projection;  // shadow_perspective, ...
  uint layer;
  uint size;   // texels per side
  uint light;  // of the scene, or no_light
};

// How the layers of one light, or of one sample on it, share its surroundings.
LIMN_CONST uint shadow_faces_single = 0u;  // one view
LIMN_CONST uint shadow_faces_pair = 1u;    // two views, along +z and -z of the first
LIMN_CONST uint shadow_faces_hemicube = 2u;  // +z, +x, -x, +y, -y
LIMN_CONST uint shadow_faces_cube = 3u;      // the same and -z

LIMN_CONST uint no_light = 0xffffffffu;  // parallel light that is no light of the scene

struct ShadowLight {
  vec3 origin;   // the sample's position; directional: unit vector towards the light
  float finite;  // 1; directional: 0
  uint first_layer;
  uint faces;  // shadow_faces_*
  uint light;  // of the scene, or no_light
  uint unused;
};

LIMN_FN uint shadow_face_count(uint faces) {
  return faces == shadow_faces_single ? 1u : faces == shadow_faces_pair ? 2u : faces == shadow_faces_hemicube ? 5u : 6u;
}

// Whether no view of a light goes on where another ends, as those of cubes and half cubes do: what lies beyond the edge of one then
// lies in none, where nothing blocks.
LIMN_FN bool shadow_views_apart(uint faces) { return faces == shadow_faces_single || faces == shadow_faces_pair; }

// A point of space in a view.
struct ShadowPoint {
  vec2 uv;      // [0, 1]^2 inside the map
  float depth;  // metres; <= 0: the view does not see it
};

// r: offset from the view's origin, in the view's axes.
LIMN_FN vec3 shadow_local(ShadowView view, vec3 p) {
  vec3 r = p - view.origin;
  return vec3(dot(view.axis_x, r), dot(view.axis_y, r), dot(view.axis_z, r));
}

// Which of a light's views sees what lies at r, an offset from their origin in the axes of the first of them.
LIMN_FN uint shadow_face_of_local(uint faces, vec3 r) {
  if (faces == shadow_faces_single) return 0u;
  if (faces == shadow_faces_pair) return r.z >= 0.0f ? 0u : 1u;
  float x = abs(r.x);
  float y = abs(r.y);
  float z = faces == shadow_faces_hemicube ? max(r.z, 0.0f) : abs(r.z);
  uint beside = x >= y ? (r.x >= 0.0f ? 1u : 2u) : (r.y >= 0.0f ? 3u : 4u);
  return z >= x && z >= y ? (r.z >= 0.0f ? 0u : 5u) : beside;
}

// Which of a light's views sees p; `first` is the light's first view.
LIMN_FN uint shadow_face(uint faces, ShadowView first, vec3 p) {
  if (faces == shadow_faces_single) return 0u;
  return shadow_face_of_local(faces, shadow_local(first, p));
}

LIMN_FN ShadowPoint shadow_project_local(ShadowView view, vec3 r) {
  ShadowPoint q;
  float s = view.scale;
  if (view.projection == shadow_orthographic) {
    q.uv = vec2(view.middle.x + s * r.x, view.middle.y + s * r.y);
    q.depth = r.z;
    return q;
  }
  float divisor = r.z;
  q.depth = r.z;
  if (view.projection == shadow_paraboloid) {
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
  float x = (uv.x - view.middle.x) / view.scale;
  float y = (uv.y - view.middle.y) / view.scale;
  if (view.projection == shadow_orthographic) return vec3(x, y, depth);
  if (view.projection == shadow_perspective) return vec3(x * depth, y * depth, depth);
  // Paraboloid: (x, y) = (dx, dy) / (1 + dz) with unit d, so dz = (1 - x^2 - y^2) / (1 + x^2 + y^2).
  float k = 2.0f / (1.0f + x * x + y * y);
  return depth * vec3(k * x, k * y, k - 1.0f);
}

// An offset from the origin in the view's axes, in world axes.
LIMN_FN vec3 shadow_world_offset(ShadowView view, vec3 r) {
  return r.x * view.axis_x + r.y * view.axis_y + r.z * view.axis_z;
}

// A vector of the world in the view's axes.
LIMN_FN vec3 shadow_view_axes(ShadowView view, vec3 w) {
  return vec3(dot(view.axis_x, w), dot(view.axis_y, w), dot(view.axis_z, w));
}

// The depth of an offset from the origin: what shadow_project_local finds.
LIMN_FN float shadow_depth_of(ShadowView view, vec3 r) {
  return view.projection == shadow_paraboloid ? sqrt(dot(r, r)) : r.z;
}

// Depth of a point, metres: what shadow_project gives for points the view sees.
LIMN_FN float shadow_view_depth(ShadowView view, vec3 p) { return shadow_depth_of(view, shadow_local(view, p)); }

// Metres to what the map stores, and back.
LIMN_FN float shadow_normalise(ShadowView view, float depth) {
  return (depth - view.near) / (view.far - view.near);
}
LIMN_FN float shadow_metres(ShadowView view, float stored) {
  return view.near + stored * (view.far - view.near);
}

// What a texel, whose depth as stored is given, shows at its centre: offset from the origin, in the view's axes.
LIMN_FN vec3 shadow_texel_offset(ShadowView view, ivec2 texel, float stored) {
  vec2 uv = (vec2(texel) + 0.5f) / float(view.size);
  return shadow_unproject_local(view, uv, shadow_metres(view, stored));
}

// Clip coordinates for rasterising the view, which is no paraboloid: depth in [0, 1], reversed (near: 1, far: 0). The
// perspective ones keep the precision of floating-point depth over any range.
LIMN_FN vec4 shadow_clip(ShadowView view, vec3 p) {
  vec3 r = shadow_local(view, p);
  float near = view.near;
  float far = view.far;
  float s = 2.0f * view.scale;
  float x = 2.0f * view.middle.x - 1.0f;
  float y = 2.0f * view.middle.y - 1.0f;
  if (view.projection == shadow_perspective) {
    return vec4(s * r.x + x * r.z, s * r.y + y * r.z, near * ((far - r.z) / (far - near)), r.z);
  }
  return vec4(s * r.x + x, s * r.y + y, (far - r.z) / (far - near), 1.0f);
}

// Side of a texel, metres, at `depth` (on a surface that faces the view).
LIMN_FN float shadow_footprint(ShadowView view, float depth) {
  return view.projection == shadow_orthographic ? view.footprint : view.footprint * depth;
}

// Kernel of the cone from a receiver at depth d to a light of side `size`, cut at depth z, as a fraction of the map's
// width (soft-shadow framework, steps 1 and 3; Fernando 2005): with z the near plane the initial kernel w_i, with z the
// average blocker depth the penumbra kernel w_p. Orthographic: `size` is 2 tan(angular diameter / 2).
LIMN_FN float shadow_kernel_width(ShadowView view, float size, float d, float z) {
  float gap = max(d - z, 0.0f);
  if (view.projection == shadow_orthographic) return size * gap * view.scale;
  return size * gap * view.scale / (d * z);
}

// What a receiver compares stored depths with. A stored depth is a blocker where its point lies
//   nearer to the light than the receiver along the light's axis, and
//   above the receiver's tangent plane by more than the bias.
// The second test is the receiver-plane depth bias without its approximation: a plane never shadows itself, whatever
// its slope and however wide the kernel. The bias counts texel footprints, so that a contact shadow detaches by at most
// `bias` texels, measured on the receiver.
struct ShadowReceiver {
  vec3 normal;   // in the view's axes
  float height;  // of the receiver over the view's origin along the normal, plus the bias
  vec3 axis;     // the light's, in the view's axes
  float depth;   // of the receiver along it
};

// p, normal: the receiver and its geometric normal (unit); axis: unit vector from the light towards the receiver's side
// (rectangle: its normal; directional: its direction; point and spot: from the light to the receiver).
LIMN_FN ShadowReceiver shadow_receiver(ShadowView view, vec3 p, vec3 normal, vec3 axis, float bias) {
  vec3 r = p - view.origin;
  ShadowReceiver receiver;
  float h = dot(normal, r);
  // The footprint at the receiver's distance holds for all faces of a cube, seen from whichever the tap lands in.
  float depth = view.projection == shadow_orthographic ? 1.0f : sqrt(dot(r, r));
  receiver.normal = shadow_view_axes(view, normal);
  receiver.height = h + bias * view.footprint * depth;
  receiver.axis = shadow_view_axes(view, axis);
  receiver.depth = dot(axis, r);
  return receiver;
}

// b: offset of the stored point, in the view's axes.
LIMN_FN bool shadow_blocks(ShadowReceiver receiver, vec3 b) {
  return dot(receiver.normal, b) > receiver.height && dot(receiver.axis, b) < receiver.depth;
}

LIMN_END
#endif  // LIMN_SHADOW_VIEW_GLSL
