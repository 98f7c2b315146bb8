// Lookups in the Fourier basis maps of shadow maps (shadow::FourierMaps, whose defines() this needs) for boxes of texels.
#ifndef LIMN_FOURIER_LOOKUP_GLSL
#define LIMN_FOURIER_LOOKUP_GLSL
#include "glsl/fourier_shadow.glsl"
#include "glsl/summed_area_table.glsl"

#if FOURIER_SAT
layout(binding = 10) uniform isampler2DArray fourier_basis_maps;
layout(binding = 11) uniform isampler2DArray fourier_depth_basis_maps;
layout(binding = 12) uniform isampler2DArray fourier_depth_maps;
#else
layout(binding = 10) uniform sampler2DArray fourier_basis_maps;  // trilinear
layout(binding = 11) uniform sampler2DArray fourier_depth_basis_maps;
layout(binding = 12) uniform sampler2DArray fourier_depth_maps;
#endif
layout(std430, binding = 4) readonly buffer FourierRanges { FourierRange fourier_ranges[]; };

const float fourier_weights[2 * FOURIER_GROUPS] = float[](FOURIER_WEIGHTS);

// A box of texels that lies in the map, as the filter takes it.
struct FourierBox {
#if FOURIER_SAT
  SatAxis x;
  SatAxis y;
  float factor;  // 1 / (texels * scale of the quantised values)
  ivec2 size;
#else
  vec2 uv;
  float lod;
#endif
};

FourierBox fourier_box(vec2 low, vec2 high, ivec2 size) {
  FourierBox box;
  vec2 extent = high - low;
#if FOURIER_SAT
  box.x = sat_axis(low.x, high.x, size.x);
  box.y = sat_axis(low.y, high.y, size.y);
  box.factor = 1.0 / (max(extent.x * extent.y, 1e-12) * float(fourier_sum_scale(size.x * size.y)));
  box.size = size;
#else
  box.uv = 0.5 * (low + high) / vec2(size);
  box.lod = fourier_lod(sqrt(0.5 * dot(extent, extent)));
#endif
  return box;
}

#if FOURIER_SAT
// Sums over all texels left of and above an edge; edges beyond the map have no weight.
ivec4 fourier_sum(isampler2DArray sums, int x, int y, int layer, ivec2 size) {
  ivec2 at = min(ivec2(x, y), size) - 1;
  ivec4 sum = texelFetch(sums, ivec3(max(at, ivec2(0)), layer), 0);
  return at.x < 0 || at.y < 0 ? ivec4(0) : sum;
}

// Mean of the images of one layer. Prefix sums are never interpolated: the 3 x 3 boxes between 4 x 4 edges are exact
// modulo 2^32, and exact where they are at most the map.
vec4 fourier_mean(isampler2DArray sums, FourierBox box, int layer) {
  vec4 mean = vec4(0.0);
  ivec4 above[4];
  for (int i = 0; i < 4; ++i) above[i] = fourier_sum(sums, box.x.edges[i], box.y.edges[0], layer, box.size);
  for (int j = 0; j < 3; ++j) {
    ivec4 below[4];
    for (int i = 0; i < 4; ++i) below[i] = fourier_sum(sums, box.x.edges[i], box.y.edges[j + 1], layer, box.size);
    vec4 row = vec4(0.0);
    for (int i = 0; i < 3; ++i) row += box.x.weights[i] * vec4(below[i + 1] - below[i] - above[i + 1] + above[i]);
    mean += box.y.weights[j] * row;
    above = below;
  }
  return mean * box.factor;
}
#else
vec4 fourier_mean(sampler2DArray maps, FourierBox box, int layer) {
  return textureLod(maps, vec3(box.uv, layer), box.lod);
}
#endif

// s: the share of the box that lies at or behind the receiver's depth.
float fourier_lit(FourierBox box, int layer, float receiver) {
  float lit = 0.5;
  float d = receiver - FOURIER_DELTA;
  vec2 phase = fourier_phase(1, d);
  vec2 step = vec2(phase.x * phase.x - phase.y * phase.y, 2.0 * phase.x * phase.y);
  for (int g = 0; g < FOURIER_GROUPS; ++g) {
    vec2 next = fourier_next_phase(phase, step);
    vec4 basis = fourier_mean(fourier_basis_maps, box, FOURIER_GROUPS * layer + g);
    lit += fourier_terms(basis, phase, next, vec2(fourier_weights[2 * g], fourier_weights[2 * g + 1]));
    phase = fourier_next_phase(next, step);
  }
  return lit;
}

// n: the mean of depth over the box, where blockers count with their depth and all else with 0.
float fourier_blocked_depth(FourierBox box, int layer, float receiver) {
  float sum = 0.5 * fourier_mean(fourier_depth_maps, box, layer).x;
  float d = receiver - FOURIER_DELTA;
  vec2 phase = fourier_phase(1, d);
  vec2 step = vec2(phase.x * phase.x - phase.y * phase.y, 2.0 * phase.x * phase.y);
  for (int g = 0; g < FOURIER_GROUPS; ++g) {
    vec2 next = fourier_next_phase(phase, step);
    vec4 basis = fourier_mean(fourier_depth_basis_maps, box, FOURIER_GROUPS * layer + g);
    sum -= fourier_terms(basis, phase, next, vec2(fourier_weights[2 * g], fourier_weights[2 * g + 1]));
    phase = fourier_next_phase(next, step);
  }
  return sum;
}

// The series itself at depth x behind the point where it is taken: what fourier_lit gives where all lies there.
float fourier_step(float x) {
  vec2 phase = fourier_phase(1, x + FOURIER_DELTA);
  vec2 step = vec2(phase.x * phase.x - phase.y * phase.y, 2.0 * phase.x * phase.y);
  float lit = 0.5;
  for (int k = 0; k < 2 * FOURIER_GROUPS; ++k) {
    lit += fourier_weights[k] * phase.y;
    phase = fourier_next_phase(phase, step);
  }
  return lit;
}

#endif  // LIMN_FOURIER_LOOKUP_GLSL
