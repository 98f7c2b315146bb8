// Moments of parts of a shadow-map kernel, and what they say: the share of texels that block a receiver and how far
// those lie from it (Chebyshev's inequality and the average-blocker-depth formula of variance soft shadow maps).
//
// All depths are counted in quanta of the summed-area table (glsl/shadow/summed_area_table.glsl). Moments are those of d - z
// about the depth d of unoccluded texels, the receiver's tangent plane, without a bias; a bias decides only whether
// there is a blocker at all.
#ifndef LIMN_VARIANCE_KERNEL_GLSL
#define LIMN_VARIANCE_KERNEL_GLSL
#include "glsl/shadow/shadow_view.glsl"
#include "glsl/shadow/summed_area_table.glsl"
LIMN_BEGIN

// --- Thresholds: map_threshold() (glsl/shadow/map_space.glsl), prepared once for all texels of a view ---

// The same planes, kept as what is affine in the place, so that each of many sub-kernels has its threshold, and its slope,
// without a division by plane. threshold_blocks() answers also where the light's centre lies beneath the plane.
//
// Places are in texels. Of a perspective view a plane's inverse depth is affine in the place, of an orthographic one its
// depth: stored as (value at 0, per texel along u, along v), in 1 / metres of depth, or in metres of negated depth, so that
// nearer is greater in both.
struct ShadowThresholds {
  vec3 plane;     // the receiver's tangent plane
  vec3 biased;    // the same, raised by the bias
  vec3 axis;      // where the light's axis has the receiver's depth
  vec3 rise;      // where the light's centre lies beneath `biased`: rays come up through it, and what blocks is deeper. In
                  // perspective views what they rise along the normal per metre of depth, else metres of negated depth where
                  // they do
  float beneath;  // how far beneath it lies, metres, 0 in an orthographic view; elsewhere -1 without a rise
  float least;    // of all of these: the far plane's
  float deepest;  // of the plane's where the axis is nearer: nothing unoccluded lies deeper
  float near;     // metres
  float quanta;   // per metre
  vec2 gap;       // metres along the axis to the receiver: gap.x + gap.y (depth * value, or depth + value, of axis)
  bool inverse;
};

// height: of the receiver over the view's origin along its normal, metres. deepest: metres. scale: quanta of a depth of 1.
// Perspective and orthographic views.
LIMN_FN ShadowThresholds shadow_thresholds(ShadowView view, ShadowReceiver receiver, float height, float deepest,
                                           float scale) {
  ShadowThresholds t;
  float s = view.scale;
  vec3 n = receiver.normal;
  vec3 a = receiver.axis;
  vec2 middle = view.middle;
  vec3 across = vec3(-dot(middle, vec2(n)), n.x, n.y) / s;
  vec3 along = vec3(-dot(middle, vec2(a)), a.x, a.y) / s;
  t.inverse = view.projection == shadow_perspective;
  t.near = view.near;
  t.quanta = scale / (view.far - view.near);
  if (t.inverse) {
    // What the light's centre lies beneath hides all of it: a plane just below the centre hides as much.
    float edge = -1e-6f * receiver.depth;
    across.x += n.z;
    along.x += a.z;
    t.plane = across / min(height, edge);
    t.biased = across / min(receiver.height, edge);
    bool beneath = receiver.height >= 0.0f;
    t.rise = beneath ? across : vec3(0.0f);
    t.beneath = beneath ? receiver.height : -1.0f;
    t.axis = along / receiver.depth;
    t.least = 1.0f / view.far;
    t.deepest = 1.0f / deepest;
    t.gap = vec2(receiver.depth, -receiver.depth);
  } else {
    float slope = min(n.z, -1e-6f);
    t.plane = (across - vec3(height, 0.0f, 0.0f)) / slope;
    t.biased = (across - vec3(receiver.height, 0.0f, 0.0f)) / slope;
    t.axis = (along - vec3(receiver.depth, 0.0f, 0.0f)) / a.z;
    bool beneath = n.z >= 0.0f;
    t.rise = beneath ? (across - vec3(receiver.height, 0.0f, 0.0f)) / max(n.z, 1e-6f) : vec3(0.0f);
    t.beneath = beneath ? 0.0f : -1.0f;
    if (beneath) t.biased = t.axis;
    t.least = -view.far;
    t.deepest = -deepest;
    t.gap = vec2(0.0f, -a.z);
  }
  vec3 per_texel = vec3(1.0f, vec2(1.0f / float(view.size)));
  t.plane *= per_texel;
  t.biased *= per_texel;
  t.axis *= per_texel;
  t.rise *= per_texel;
  return t;
}

LIMN_FN float threshold_value(vec3 affine, vec2 texel) { return affine.x + affine.y * texel.x + affine.z * texel.y; }

// Metres of depth that a value stands for.
LIMN_FN float threshold_depth(ShadowThresholds t, float value) {
  float v = max(value, t.least);
  return t.inverse ? 1.0f / v : -v;
}

LIMN_FN float threshold_quanta(ShadowThresholds t, float depth) { return max(depth - t.near, 0.0f) * t.quanta; }

// Least and greatest value over a box of texels.
LIMN_FN vec2 threshold_range(vec3 affine, vec2 low, vec2 high) {
  vec2 reach = 0.5f * (high - low);
  float middle = threshold_value(affine, 0.5f * (low + high));
  float change = abs(affine.y) * reach.x + abs(affine.z) * reach.y;
  return vec2(middle - change, middle + change);
}

// Whether `depth` metres are nearer than what a value stands for.
LIMN_FN bool threshold_nearer(ShadowThresholds t, float depth, float value) {
  return t.inverse ? depth * value < 1.0f : depth + value < 0.0f;
}

// Whether what is stored at a place, `depth` metres, blocks.
LIMN_FN bool threshold_blocks(ShadowThresholds t, vec2 texel, float depth) {
  bool nearer = threshold_nearer(t, depth, max(threshold_value(t.biased, texel), threshold_value(t.axis, texel)));
  float rise = threshold_value(t.rise, texel);
  return nearer && (t.inverse ? depth * rise : depth + rise) > t.beneath;
}

// Metres along the light's axis from what lies at a place and `depth` to the receiver.
LIMN_FN float threshold_gap(ShadowThresholds t, vec2 texel, float depth) {
  float v = threshold_value(t.axis, texel);
  return t.gap.x + t.gap.y * (t.inverse ? depth * v : depth + v);
}

// Depths at a place, quanta: of unoccluded texels, of the greatest depth that blocks, and the square of the change of the
// former per texel along u and v.
struct PlaceThresholds {
  float unoccluded;
  float blocking;
  vec2 slope2;
};

LIMN_FN PlaceThresholds thresholds_at(ShadowThresholds t, vec2 texel) {
  PlaceThresholds at;
  float plane = threshold_value(t.plane, texel);
  float axis = threshold_value(t.axis, texel);
  float limit = min(axis, t.deepest);
  float depth = threshold_depth(t, max(plane, limit));
  at.unoccluded = threshold_quanta(t, depth);
  at.blocking =
      min(threshold_quanta(t, threshold_depth(t, max(threshold_value(t.biased, texel), axis))), at.unoccluded);
  float change = plane > limit ? t.quanta * (t.inverse ? depth * depth : 1.0f) : 0.0f;
  at.slope2 = change * change * vec2(t.plane.y * t.plane.y, t.plane.z * t.plane.z);
  return at;
}

// Whether the tangent plane stays within the map's range over a box of texels. Where it does not, what is stored is nearer
// than the plane though nothing blocks.
LIMN_FN bool plane_in_range(ShadowThresholds t, vec2 centre, vec2 extent) {
  float farthest = threshold_value(t.plane, centre) - 0.5f * (abs(t.plane.y) * extent.x + abs(t.plane.z) * extent.y);
  return farthest >= t.least;
}

// --- Chebyshev's inequality over a sub-kernel ---

// Sums over n texels of d - z and (d - z)^2, quanta.
struct SubKernel {
  float texels;
  float first;
  float second;
  float shift;  // from d to the depth below which a texel blocks, >= 0
  float slope;  // variance of the tangent plane's own depth over the texels
  float noise;  // variance of what a texel cannot resolve: quantisation, and the slope within it
};

LIMN_CONST int sub_kernel_lit = 0;      // unoccluded, with an error of at most 1 / 256
LIMN_CONST int sub_kernel_blocked = 1;  // E(z) < d: Chebyshev's inequality holds
LIMN_CONST int sub_kernel_mixed = 2;    // "non-planar": E(z) >= d, though something may block

LIMN_FN SubKernel sub_kernel(PlaceThresholds at, vec2 extent, float first, float second) {
  SubKernel s;
  s.texels = extent.x * extent.y;
  s.first = first;
  s.second = second;
  s.shift = at.unoccluded - at.blocking;
  s.slope = dot(at.slope2, extent * extent - vec2(1.0f)) / 12.0f;
  s.noise = (1.0f + at.slope2.x + at.slope2.y) / 12.0f;
  return s;
}

// VSSM, section 7.4: by the mean, and by the variance for what Chebyshev's inequality on the other side, P(z < d) <=
// sigma^2 / (sigma^2 + (mu - d)^2), proves lit. The tangent plane itself is no variance, quantisation is. Means within a
// quantum of the threshold tell nothing.
LIMN_FN int sub_kernel_kind(SubKernel s) {
  float mean = s.first / s.texels;
  float margin = s.shift - mean;
  float variance = max(s.second / s.texels - mean * mean - s.slope, 0.0f) + 1.0f / 12.0f;
  if (margin < -1.0f) return sub_kernel_blocked;
  return margin > 0.0f && 255.0f * variance <= margin * margin ? sub_kernel_lit : sub_kernel_mixed;
}

// n E((d - z)^2) as if the unoccluded texels, about n - first^2 / second of them, all lay at d: without the variance of
// the sloping plane.
LIMN_FN float sub_kernel_second(SubKernel s) {
  float lit = max(s.texels - s.first * s.first / max(s.second, 1e-30f), 0.0f);
  float least = s.first * s.first / s.texels;
  return max(s.second - lit * s.slope, least) + s.texels * s.noise;
}

// Whether what Chebyshev's inequality takes for the blockers would lie nearer than anything stored, `reach` quanta before d.
// Then there are not the two depths that it needs, one of them d: unoccluded texels lie behind the tangent plane, as where
// the receiver's surface curves away from it or ends, and their variance passes for blockers that are few and far away.
// Depths are good to a quantum.
LIMN_FN bool sub_kernel_contradicts(SubKernel s, float reach) {
  return sub_kernel_second(s) > (s.first + s.texels) * (reach + 1.0f + sqrt(s.slope + s.noise));
}

// Texels that block, from pooled sums: n (1 - P) with P = 1 - m1^2 / m2, Chebyshev's bound.
LIMN_FN float chebyshev_blocked(float texels, float first, float second) {
  return second > 0.0f ? min(first * first / second, texels) : 0.0f;
}

// How far the blockers lie before d on average: d - z_occ = m2 / m1. From z_occ = (z_mean - P d) / (1 - P), the
// average-blocker-depth formula (VSSM, equation 7.4), with Chebyshev's P. Unbounded for small m1: to be limited.
LIMN_FN float blocker_distance(float first, float second) { return second / first; }

// --- The cone from receiver to light, cut at any gap ---

// Kernels of one receiver and light: the one at gap g lies about the receiver's own place in the map and is
// g / (depth + g towards) times as large as the one at unit scale.
struct KernelCone {
  vec2 apex;  // texels
  vec2 low;   // edges of the kernel at unit scale, relative to the apex
  vec2 high;
  float depth;    // of the receiver in the view, metres; orthographic: 1
  float towards;  // its change per metre of gap; orthographic: 0
};

// Kernel at `gap` relative to the one at unit scale: its edges are apex + scale low and apex + scale high.
LIMN_FN float kernel_cone_scale(KernelCone c, float gap) {
  return gap / max(c.depth + gap * c.towards, 1e-6f * c.depth);
}

LIMN_FN KernelCone kernel_cone(ShadowView view, vec3 local, float towards, vec2 low, vec2 high, float gap) {
  KernelCone c;
  c.apex = float(view.size) * shadow_project_local(view, local).uv;
  c.depth = view.projection == shadow_perspective ? local.z : 1.0f;
  c.towards = view.projection == shadow_perspective ? towards : 0.0f;
  float scale = kernel_cone_scale(c, gap);
  c.low = (low - c.apex) / scale;
  c.high = (high - c.apex) / scale;
  return c;
}

// --- Quad-tree over a square of 2^height cells per side, walked without a stack (VSSM, algorithm 3) ---

// A node is (level, Morton code of its place in the level). The links are those of the linear array in which Bunnell
// 2005 stores such trees, computed instead of read.
LIMN_FN uvec2 quadtree_child(uvec2 node) { return uvec2(node.x + 1u, node.y << 2u); }

// What follows once a node and all below it are done. The last one's is the root again, uvec2(0, 1) as it were: done.
LIMN_FN uvec2 quadtree_next(uvec2 node) {
  uint next = node.y + 1u;
  uint up = min(uint(findLSB(next)) >> 1u, node.x);
  return uvec2(node.x - up, next >> (2u * up));
}
LIMN_FN bool quadtree_done(uvec2 node) { return node.x == 0u && node.y != 0u; }

LIMN_FN uint morton_axis(uint code) {
  uint x = code & 0x55555555u;
  x = (x | x >> 1u) & 0x33333333u;
  x = (x | x >> 2u) & 0x0f0f0f0fu;
  x = (x | x >> 4u) & 0x00ff00ffu;
  return (x | x >> 8u) & 0x0000ffffu;
}
LIMN_FN ivec2 quadtree_place(uvec2 node) { return ivec2(int(morton_axis(node.y)), int(morton_axis(node.y >> 1u))); }

// --- Sub-kernels of whole texels ---

// One axis of a kernel [low, high) in texels, cut to the map: whole texels [first, last), and the texels before and
// after them that the kernel covers in part.
struct KernelAxis {
  int first;
  int last;
  float before;  // covered share of texel first - 1
  float after;   // of texel last
};

LIMN_FN KernelAxis kernel_axis(float low, float high, int size) {
  float a = clamp(low, 0.0f, float(size));
  float b = clamp(high, a, float(size));
  KernelAxis axis;
  axis.first = int(floor(a)) + 1;
  axis.last = max(int(floor(b)), axis.first);
  axis.before = min(b, float(axis.first)) - a;
  axis.after = b > float(axis.first) ? b - float(axis.last) : 0.0f;
  return axis;
}

// All texels that the kernel touches, whole.
LIMN_FN KernelAxis kernel_axis_whole(float low, float high, int size) {
  KernelAxis axis;
  axis.first = int(floor(clamp(low, 0.0f, float(size))));
  axis.last = max(int(ceil(clamp(high, 0.0f, float(size)))), axis.first);
  axis.before = 0.0f;
  axis.after = 0.0f;
  return axis;
}

// floor(a / b) for 0 <= a < 2^22, 0 < b < 2^10: exact, and unlike the division of integers it is one instruction for many
// lanes.
LIMN_FN int whole_quotient(int a, int b) { return int((float(a) + 0.5f) / float(b)); }

// Where part i of `parts` nearly equal ones of the whole texels begins.
LIMN_FN int kernel_part(KernelAxis axis, int i, int parts) {
  return axis.first + whole_quotient((axis.last - axis.first) * i, parts);
}

LIMN_END
#endif  // LIMN_VARIANCE_KERNEL_GLSL
