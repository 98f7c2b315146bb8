// Kernels of prefiltered soft shadows: the box of a shadow map through which a receiver sees the light at some distance.
// The depths below which texels of that box block are those of glsl/shadow/map_space.glsl, and of
// glsl/shadow/variance_kernel.glsl where they are prepared once for all texels of a view.
#ifndef LIMN_SHADOW_KERNEL_GLSL
#define LIMN_SHADOW_KERNEL_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/light/light_view.glsl"
#include "glsl/shadow/shadow_view.glsl"
LIMN_BEGIN

struct ShadowKernel {
  vec2 low;      // texels, fractional; the part in another face of the light's maps is cut off, a part outside of all
  vec2 high;     // maps is not
  float weight;  // steradians or so: the share of this face, relative to the kernels in the other faces
};

// Half the side, relative to light_view_cone_scale(v, 1), of the square as large as the disc.
LIMN_CONST float square_of_disc = 0.886226925f;

// Lights so narrow that rounding leaves their kernels no width still have what lies in their texel: a thousandth of a texel
// is about the least that places in the largest maps resolve.
LIMN_CONST float least_kernel_width = 1e-3f;

LIMN_FN void widen_kernel(LIMN_INOUT(ShadowKernel) kernel, float least) {
  vec2 widen = max(0.5f * (vec2(least) - (kernel.high - kernel.low)), vec2(0.0f));
  kernel.low -= widen;
  kernel.high += widen;
}

// The kernel `gap` metres nearer to the light than the receiver, along the light's axis: the counted part of the light
// (LightView::low, high) scaled down by gap / depth, projected, and boxed (framework, steps 1 and 3). False: nothing of
// it lies in this view. whole: shadow_views_apart(), so that what lies beyond its edge is unoccluded. least: texels,
// least_kernel_width or more, that a kernel is wide before the face cuts it: one widened after that would reach over the edge
// again, where nothing seems to block.
LIMN_FN bool shadow_kernel(ShadowView view, LightView light, vec3 receiver, float gap, bool whole, float least,
                           LIMN_OUT(ShadowKernel) kernel) {
  vec3 centre = shadow_local(view, receiver);
  vec3 direction = shadow_view_axes(view, light.centre);
  float scale = light.cone ? square_of_disc * light_view_cone_scale(light, 1.0f) : 1.0f;
  vec3 u = scale * shadow_view_axes(view, light.side_u);
  vec3 v = scale * shadow_view_axes(view, light.side_v);
  float size = float(view.size);
  kernel.low = vec2(3.0e38f);
  kernel.high = vec2(-3.0e38f);
  kernel.weight = 1.0f;
  if (view.projection == shadow_orthographic && !light.cone) {
    // A distant rectangle that is not seen head-on is a parallelogram in the map: the box of the same second moments.
    vec2 middle = 0.5f * (light.low + light.high);
    vec3 r = centre + gap * (direction + middle.x * u + middle.y * v);
    vec2 texel = size * shadow_project_local(view, r).uv;
    vec3 reach_u = (light.high.x - light.low.x) * u;
    vec3 reach_v = (light.high.y - light.low.y) * v;
    vec2 reach = 0.5f * size * view.scale * gap *
                 vec2(sqrt(reach_u.x * reach_u.x + reach_v.x * reach_v.x),
                      sqrt(reach_u.y * reach_u.y + reach_v.y * reach_v.y));
    kernel.low = texel - reach;
    kernel.high = texel + reach;
    widen_kernel(kernel, least);
    return true;
  }
  bool seen = false;
  for (int i = 0; i < 4; ++i) {
    vec2 p = vec2((i & 1) == 0 ? light.low.x : light.high.x, (i & 2) == 0 ? light.low.y : light.high.y);
    vec3 r = centre + gap * (direction + p.x * u + p.y * v);
    seen = seen || r.z > 0.0f || view.projection != shadow_perspective;
    // What lies beside or behind a perspective view lies far outside its map, on the side it is on.
    if (view.projection == shadow_perspective) r.z = max(r.z, 1e-3f * max(abs(r.x), abs(r.y)));
    vec2 texel = size * shadow_project_local(view, r).uv;
    kernel.low = min(kernel.low, texel);
    kernel.high = max(kernel.high, texel);
  }
  if (!seen) return false;
  widen_kernel(kernel, least);
  if (!whole) {
    kernel.low = max(kernel.low, vec2(0.0f));
    kernel.high = min(kernel.high, vec2(size));
    if (!(kernel.low.x < kernel.high.x && kernel.low.y < kernel.high.y)) return false;
    // Solid angle of the box: its area times the inverse cube of its distance.
    vec2 extent = (kernel.high - kernel.low) / size;
    vec3 middle = shadow_unproject_local(view, 0.5f * (kernel.low + kernel.high) / size, 1.0f);
    float inverse = 1.0f / dot(middle, middle);
    kernel.weight = extent.x * extent.y * inverse * sqrt(inverse);
  }
  return true;
}

// How near to a rectangular light something may block that lies no nearer than the near plane of its cube or half cube, metres
// along the light's axis. Each face measures that plane along its own axis: beside the light's axis a ray from the receiver
// reaches it at some other depth, or not at all. first: the face along the light's axis.
LIMN_FN float shadow_faces_nearest(ShadowView first, LightView light, vec3 receiver) {
  vec3 to = abs(shadow_local(first, receiver));
  vec3 reach = (0.5f * light.depth) *
               (abs(shadow_view_axes(first, light.side_u)) + abs(shadow_view_axes(first, light.side_v)));
  // Of the way from the light to the receiver, what rays have gone at least where they reach that plane.
  vec3 share = max(vec3(first.near) - reach, vec3(0.0f)) / max(to - reach, vec3(1e-20f));
  // Of what lies yet nearer to the light's plane shadow_kernel() could not say where it ends in a face beside the axis.
  float least = 4e-3f * max(reach.x, reach.y);
  return min(first.near, max(light.depth * min(share.x, share.y), least));
}

LIMN_END
#endif  // LIMN_SHADOW_KERNEL_GLSL
