// The rows of the summed-area tables of all Fourier basis images of a shadow map: sums along the rows of the quantised basis
// values, which come straight from depth. summed_area_table.comp.glsl sums along the columns of those. A thread sums up to
// CHUNK groups of terms at once, so that depth is read and its sine taken once.
#define VERTICAL 0
#define SUM_TYPE ivec4
#define SUM(a, b) ((a) + (b))
#include "glsl/shadow/fourier_shadow.glsl"
#include "glsl/shadow/line_scan.glsl"

#define IMAGES (2 * CHUNK + 1)
layout(rgba32i) writeonly uniform iimage2DArray basis;
layout(rgba32i) writeonly uniform iimage2DArray depth_basis;
layout(r32i) writeonly uniform iimage2DArray plain_depth;
uniform sampler2DArray depth;
layout(std430) readonly buffer Ranges { FourierRange ranges[]; };
uniform float span;

// The values of one texel.
struct Values {
  ivec4 image[IMAGES];
};

const int chunks = (GROUPS + CHUNK - 1) / CHUNK;

Values values_at(int line, int position, ivec2 size) {
  int layer = int(gl_WorkGroupID.z) / chunks;
  int first = CHUNK * (int(gl_WorkGroupID.z) % chunks);
  vec2 uv = (vec2(position, line) + 0.5) / vec2(size);
  float z = fourier_texel_depth(ranges[layer], uv, texelFetch(depth, ivec3(position, line, layer), 0).r, span);
  float scale = float(fourier_sum_scale(size.x * size.y));
  vec2 phase = fourier_phase(1, z);
  vec2 step = fourier_phase_step(phase);
  if (first > 0) phase = fourier_phase(2 * first + 1, z);
  Values values;
  for (int g = 0; g < CHUNK; ++g) {
    vec2 next = fourier_next_phase(phase, step);
    // z times what is stored, not what was meant: both reconstructions then see the same series.
    vec4 quantised = round(scale * fourier_basis(phase, next));
    values.image[g] = ivec4(quantised);
    values.image[CHUNK + g] = ivec4(round(z * quantised));
    phase = fourier_next_phase(next, step);
  }
  values.image[2 * CHUNK] = ivec4(int(round(scale * z)));
  return values;
}

void store(int image, int line, int position, ivec4 sum) {
  int layer = int(gl_WorkGroupID.z) / chunks;
  int first = CHUNK * (int(gl_WorkGroupID.z) % chunks);
  if (image == 2 * CHUNK) {
    if (first == 0) imageStore(plain_depth, ivec3(position, line, layer), sum);
  } else if (image < CHUNK) {
    if (first + image < GROUPS) imageStore(basis, ivec3(position, line, GROUPS * layer + first + image), sum);
  } else if (first + image - CHUNK < GROUPS) {
    imageStore(depth_basis, ivec3(position, line, GROUPS * layer + first + image - CHUNK), sum);
  }
}

void main() {
  ivec2 size = textureSize(depth, 0).xy;
  ivec4 carried[IMAGES];
  for (int image = 0; image < IMAGES; ++image) carried[image] = ivec4(0);
#if SHARED
  int line = int(gl_WorkGroupID.x) * LINES + LOCAL_LINE;
  for (int start = 0; start < size.x; start += LENGTH) {
    int position = start + LOCAL_POSITION;
    bool inside = line < size.y && position < size.x;
    Values values;
    if (inside) values = values_at(line, position, size);
    for (int image = 0; image < IMAGES; ++image) {
      ivec4 own = inside ? values.image[image] : ivec4(0);
      ivec4 all;
      ivec4 before = carried[image] + scan_line(own, all);
      if (inside) store(image, line, position, before + own);
      carried[image] += all;
    }
  }
#else
  int line = int(gl_GlobalInvocationID.x);
  if (line >= size.y) return;
  for (int position = 0; position < size.x; ++position) {
    Values values = values_at(line, position, size);
    for (int image = 0; image < IMAGES; ++image) {
      carried[image] += values.image[image];
      store(image, line, position, carried[image]);
    }
  }
#endif
}
