// A receiver's kernels in all views of a light, for techniques that answer one view at a time.
#ifndef LIMN_LIGHT_KERNELS_GLSL
#define LIMN_LIGHT_KERNELS_GLSL
#include "glsl/shadow/blocker_search.glsl"
#include "glsl/shadow/kernel_blockers.glsl"

// The technique's: what blocks in one view. It may widen the kernel to whole texels.
KernelBlockers kernel_blockers(ShadowCursor cursor, VisibilityQuery q, inout ShadowKernel kernel, float gap, int use);

// In the kernels at `gap` metres before the receiver, at least `least` texels wide; nothing where it is not wanted.
Blockers blockers_at(inout ShadowCursor cursor, VisibilityQuery q, float gap, float least, int use, bool wanted) {
  BlockerSums sums = no_blockers();
  uint faces = wanted ? shadow_face_count(q.maps.faces) : 0u;
  uint face = 0u;
  do {  // the condition comes last: software renderers run a loop's body once more where it comes first
    ShadowKernel kernel;
    bool seen = kernel_in_face(cursor, q, face, gap, least, use == kernel_search, kernel) && wanted;
    if (seen) {
      KernelBlockers blockers = kernel_blockers(cursor, q, kernel, gap, use);
      add_kernel(sums, kernel, blockers);
    }
  } while (++face < faces);
  return mean_blockers(sums, gap);
}

// --- Parts of a kernel that the horizon cuts ---

// A part of a kernel compares all of its depths with one threshold, about the least of those in it, so that no plane blocks
// itself. Where the receiver's horizon cuts the light the tangent plane passes through what blocks: a part that it crosses
// there has blockers behind its threshold, and would let all of its light through. Its texels tell instead, each with the
// threshold of its own place, one for each quarter of the part.
struct PartQuarter {
  vec2 low;  // texels
  vec2 high;
  ShadowTap tap;
};

// Quarter i of the part low..high, which lies in the map.
PartQuarter part_quarter(ShadowCursor cursor, vec2 low, vec2 high, int i) {
  PartQuarter quarter;
  vec2 extent = 0.5 * (high - low);
  quarter.low = low + extent * vec2(i & 1, i >> 1);
  quarter.high = quarter.low + extent;
  ivec2 texel = ivec2(quarter.low + 0.5 * extent);
  quarter.tap = shadow_texel(cursor, clamp(texel, ivec2(0), ivec2(cursor.view.size) - 1));
  return quarter;
}

#endif  // LIMN_LIGHT_KERNELS_GLSL
