// What prefiltered soft shadows find in a receiver's kernels, one in each view of the light's maps that it lies in: how much
// of the light they say is hidden, and how far before the receiver.
#ifndef LIMN_KERNEL_BLOCKERS_GLSL
#define LIMN_KERNEL_BLOCKERS_GLSL
#include "glsl/shadow/visibility.glsl"

// What a kernel is looked at for.
const int kernel_search = 0;  // steps 1 and 2: how far away the blockers are; all texels that it touches
const int kernel_filter = 1;  // steps 3 and 4: how much they hide; what lies in it

// What blocks in one kernel.
struct KernelBlockers {
  float texels;  // of the kernel that hide as much of the light
  float gap;     // sum of their distances to the receiver along the light's axis, metres
};

// What hides the light.
struct Blockers {
  float share;   // of the light
  float gap;     // their mean distance to the receiver along the light's axis, metres
  float texels;  // of all kernels
};

// Sums over kernels, which count by their weights.
struct BlockerSums {
  Blockers found;
  float weights;
};

BlockerSums no_blockers() { return BlockerSums(Blockers(0.0, 0.0, 0.0), 0.0); }

void add_kernel(inout BlockerSums sums, ShadowKernel kernel, KernelBlockers blockers) {
  vec2 extent = kernel.high - kernel.low;
  float share = kernel.weight / max(extent.x * extent.y, 1e-20);
  sums.found.share += share * blockers.texels;
  sums.found.gap += share * blockers.gap;
  sums.found.texels += blockers.texels;
  sums.weights += kernel.weight;
}

// gap: of the kernels, beyond which nothing in them blocks.
Blockers mean_blockers(BlockerSums sums, float gap) {
  float inverse = sums.weights > 0.0 ? 1.0 / sums.weights : 0.0;
  float share = inverse * sums.found.share;
  return Blockers(share, clamp(inverse * sums.found.gap / max(share, 1e-30), 0.0, gap), sums.found.texels);
}

#endif  // LIMN_KERNEL_BLOCKERS_GLSL
