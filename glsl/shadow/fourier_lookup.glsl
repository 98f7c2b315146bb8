// Lookups in the Fourier basis maps of shadow maps (shadow::FourierMaps, whose defines() this needs) for boxes of texels.
#ifndef LIMN_FOURIER_LOOKUP_GLSL
#define LIMN_FOURIER_LOOKUP_GLSL
#include "glsl/shadow/fourier_shadow.glsl"
#include "glsl/shadow/variance_kernel.glsl"

#if FOURIER_SAT
uniform isampler2DArray fourier_basis_maps;
uniform isampler2DArray fourier_depth_basis_maps;
uniform isampler2DArray fourier_depth_maps;
#else
uniform sampler2DArray fourier_basis_maps;  // trilinear
uniform sampler2DArray fourier_depth_basis_maps;
uniform sampler2DArray fourier_depth_maps;
#endif
layout(std430) readonly buffer FourierRanges { FourierRange fourier_ranges[]; };

const float fourier_weights[2 * FOURIER_GROUPS] = float[](FOURIER_WEIGHTS);

// Means of all images over a box of texels.
struct FourierMeans {
  vec4 basis[FOURIER_GROUPS];
  vec4 depth_basis[FOURIER_GROUPS];
  float depth;
};

// One axis of a kernel, cut to the map and into parts: `parts` of whole texels and, as parts -1 and `parts`, the texels
// that its ends cut. Mip maps take any box, so that their parts are all of one size.
struct FourierAxis {
#if FOURIER_SAT
  KernelAxis texels;
#else
  float low;
  float high;
#endif
  int parts;
};

#if FOURIER_SAT
// whole: with all of every texel that the kernel touches, and then without parts that are cut.
FourierAxis fourier_axis(float low, float high, int size, int parts, bool whole) {
  FourierAxis axis;
  axis.texels = kernel_axis(low, high, size);
  if (whole) axis.texels = kernel_axis_whole(low, high, size);
  axis.parts = clamp(axis.texels.last - axis.texels.first, 1, parts);
  return axis;
}
const int fourier_cut = 1;  // parts at either end that are cut

// Where part i begins.
float fourier_part(FourierAxis axis, int i) {
  int edge = kernel_part(axis.texels, i, axis.parts);
  return float(i < 0 ? axis.texels.first - 1 : i > axis.parts ? axis.texels.last + 1 : edge);
}
// The share of part i that the kernel covers.
float fourier_part_weight(FourierAxis axis, int i) {
  return i < 0 ? axis.texels.before : i < axis.parts ? 1.0 : axis.texels.after;
}

// Sums over all texels between two columns and above a row.
struct FourierEdge {
  ivec4 basis[FOURIER_GROUPS];
  ivec4 depth_basis[FOURIER_GROUPS];
  int depth;
};

// 0 <= x.x <= x.y and y in texels, all at most the map's size.
FourierEdge fourier_edge(ivec2 x, int y, int layer) {
  FourierEdge edge;
  ivec2 left = max(ivec2(x.x, y) - 1, ivec2(0));
  ivec2 right = max(ivec2(x.y, y) - 1, ivec2(0));
  bvec2 there = bvec2(x.x > 0 && y > 0, x.y > 0 && y > 0);
  for (int g = 0; g < FOURIER_GROUPS; ++g) {
    int at = FOURIER_GROUPS * layer + g;
    ivec4 b0 = texelFetch(fourier_basis_maps, ivec3(left, at), 0);
    ivec4 b1 = texelFetch(fourier_basis_maps, ivec3(right, at), 0);
    ivec4 d0 = texelFetch(fourier_depth_basis_maps, ivec3(left, at), 0);
    ivec4 d1 = texelFetch(fourier_depth_basis_maps, ivec3(right, at), 0);
    edge.basis[g] = (there.y ? b1 : ivec4(0)) - (there.x ? b0 : ivec4(0));
    edge.depth_basis[g] = (there.y ? d1 : ivec4(0)) - (there.x ? d0 : ivec4(0));
  }
  int z0 = texelFetch(fourier_depth_maps, ivec3(left, layer), 0).x;
  int z1 = texelFetch(fourier_depth_maps, ivec3(right, layer), 0).x;
  edge.depth = (there.y ? z1 : 0) - (there.x ? z0 : 0);
  return edge;
}

// Between two edges of the same columns. Differences are exact modulo 2^32, and exact where a box is at most the map.
// scale: of the quantised values.
FourierMeans fourier_means(FourierEdge above, FourierEdge below, float texels, float scale) {
  FourierMeans means;
  float factor = 1.0 / (max(texels, 1.0) * scale);
  for (int g = 0; g < FOURIER_GROUPS; ++g) {
    means.basis[g] = factor * vec4(below.basis[g] - above.basis[g]);
    means.depth_basis[g] = factor * vec4(below.depth_basis[g] - above.depth_basis[g]);
  }
  means.depth = factor * float(below.depth - above.depth);
  return means;
}
#else
FourierAxis fourier_axis(float low, float high, int size, int parts, bool whole) {
  return FourierAxis(clamp(low, 0.0, float(size)), clamp(high, 0.0, float(size)), parts);
}
const int fourier_cut = 0;
float fourier_part(FourierAxis axis, int i) { return mix(axis.low, axis.high, float(i) / float(axis.parts)); }
float fourier_part_weight(FourierAxis axis, int i) { return 1.0; }

// A box of texels as a trilinear fetch sees it: its middle's uv, and the level of detail.
vec3 fourier_box(vec2 low, vec2 high, ivec2 size) {
  vec2 extent = high - low;
  return vec3(0.5 * (low + high) / vec2(size), fourier_lod(sqrt(0.5 * dot(extent, extent))));
}

// The means that fourier_lit() needs alone, and those that fourier_blocker_depth() does.
void fourier_basis_means(vec3 box, int layer, out vec4 basis[FOURIER_GROUPS]) {
  for (int g = 0; g < FOURIER_GROUPS; ++g)
    basis[g] = textureLod(fourier_basis_maps, vec3(box.xy, FOURIER_GROUPS * layer + g), box.z);
}
float fourier_depth_means(vec3 box, int layer, out vec4 depth_basis[FOURIER_GROUPS]) {
  for (int g = 0; g < FOURIER_GROUPS; ++g)
    depth_basis[g] = textureLod(fourier_depth_basis_maps, vec3(box.xy, FOURIER_GROUPS * layer + g), box.z);
  return textureLod(fourier_depth_maps, vec3(box.xy, layer), box.z).x;
}

FourierMeans fourier_means(vec2 low, vec2 high, ivec2 size, int layer) {
  FourierMeans means;
  vec3 box = fourier_box(low, high, size);
  fourier_basis_means(box, layer, means.basis);
  means.depth = fourier_depth_means(box, layer, means.depth_basis);
  return means;
}
#endif

// What the images of a kind add up to at the receiver's depth: to s - 1/2, or taken from n.
float fourier_sum(vec4 images[FOURIER_GROUPS], float receiver) {
  float sum = 0.0;
  vec2 phase = fourier_phase(1, receiver - FOURIER_DELTA);
  vec2 step = fourier_phase_step(phase);
  for (int g = 0; g < FOURIER_GROUPS; ++g) {
    vec2 next = fourier_next_phase(phase, step);
    sum += fourier_terms(images[g], phase, next, vec2(fourier_weights[2 * g], fourier_weights[2 * g + 1]));
    phase = fourier_next_phase(next, step);
  }
  return sum;
}

// s: the share that lies at or behind the receiver's depth.
float fourier_lit(vec4 basis[FOURIER_GROUPS], float receiver) { return 0.5 + fourier_sum(basis, receiver); }

// n: the mean of depth, where blockers count with their depth and all else with 0.
float fourier_blocker_depth(vec4 depth_basis[FOURIER_GROUPS], float depth, float receiver) {
  return 0.5 * depth - fourier_sum(depth_basis, receiver);
}

// (s, n).
vec2 fourier_shadow(FourierMeans means, float receiver) {
  return vec2(fourier_lit(means.basis, receiver), fourier_blocker_depth(means.depth_basis, means.depth, receiver));
}

// The series itself at depth x behind the point where it is taken: what fourier_lit gives where all lies there.
float fourier_step(float x) {
  vec2 phase = fourier_phase(1, x + FOURIER_DELTA);
  vec2 step = fourier_phase_step(phase);
  float lit = 0.5;
  for (int k = 0; k < 2 * FOURIER_GROUPS; ++k) {
    lit += fourier_weights[k] * phase.y;
    phase = fourier_next_phase(phase, step);
  }
  return lit;
}

#endif  // LIMN_FOURIER_LOOKUP_GLSL
