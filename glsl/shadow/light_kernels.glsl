// A receiver's kernels in all views of a light, for techniques that answer one view at a time.
#ifndef LIMN_LIGHT_KERNELS_GLSL
#define LIMN_LIGHT_KERNELS_GLSL
#include "glsl/shadow/kernel_blockers.glsl"

// The technique's: what blocks in one view. It may widen the kernel.
KernelBlockers kernel_blockers(ShadowCursor cursor, VisibilityQuery q, inout ShadowKernel kernel, float gap, int use);

// In the kernels at `gap` metres before the receiver; nothing where it is not wanted.
Blockers blockers_at(inout ShadowCursor cursor, VisibilityQuery q, float gap, int use, bool wanted) {
  BlockerSums sums = no_blockers();
  uint faces = wanted ? shadow_face_count(q.maps.faces) : 0u;
  uint face = 0u;
  do {  // the condition comes last: software renderers run a loop's body once more where it comes first
    ShadowKernel kernel;
    bool seen = shadow_kernel_in_face(cursor, q, face, gap, kernel) && wanted;
    if (seen) {
      KernelBlockers blockers = kernel_blockers(cursor, q, kernel, gap, use);
      add_kernel(sums, kernel, blockers);
    }
  } while (++face < faces);
  return mean_blockers(sums, gap);
}

#endif  // LIMN_LIGHT_KERNELS_GLSL
