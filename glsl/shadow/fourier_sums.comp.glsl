// Summed-area tables of all Fourier basis images of a shadow map, one direction: sums along the rows of the quantised
// basis values (VERTICAL 0), which come straight from depth, or sums along the columns of those, in place (VERTICAL 1).
// One thread follows a line (SHARED 0) or a work group scans it (SHARED 1), as in summed_area_table.comp.glsl.
//
// VERTICAL 0: a thread sums up to CHUNK groups of ORDER terms at once, so that depth is read and its sine taken once.
// VERTICAL 1: the images of one texture, `integer image4` or of one component.
#include "glsl/shadow/fourier_shadow.glsl"

#include "glsl/shadow/scan_layout.glsl"

#if SHARED
shared ivec4 partial_sums[2][LINES][LENGTH];
#endif

#if VERTICAL
#define IMAGES 1
layout(IMAGE_FORMAT) uniform iimage2DArray table;
#else
#define IMAGES (2 * CHUNK + 1)
layout(rgba32i) writeonly uniform iimage2DArray basis;
layout(rgba32i) writeonly uniform iimage2DArray depth_basis;
layout(r32i) writeonly uniform iimage2DArray plain_depth;
uniform sampler2DArray depth;
layout(std430) readonly buffer Ranges { FourierRange ranges[]; };
uniform float span;
#endif

// The values of one texel, and where they go.
struct Values {
  ivec4 image[IMAGES];
};

#if VERTICAL
Values values_at(int line, int position, ivec2 size) {
  Values values;
  values.image[0] = imageLoad(table, ivec3(line, position, gl_WorkGroupID.z));
  return values;
}

void store(int image, int line, int position, ivec4 sum) {
  imageStore(table, ivec3(line, position, gl_WorkGroupID.z), sum);
}
#else
const int chunks = (GROUPS + CHUNK - 1) / CHUNK;

Values values_at(int line, int position, ivec2 size) {
  int layer = int(gl_WorkGroupID.z) / chunks;
  int first = CHUNK * (int(gl_WorkGroupID.z) % chunks);
  vec2 uv = (vec2(position, line) + 0.5) / vec2(size);
  float z = fourier_texel_depth(ranges[layer], uv, texelFetch(depth, ivec3(position, line, layer), 0).r, span);
  float scale = float(fourier_sum_scale(size.x * size.y));
  vec2 phase = fourier_phase(1, z);
  vec2 step = vec2(phase.x * phase.x - phase.y * phase.y, 2.0 * phase.x * phase.y);
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
#endif

void main() {
#if VERTICAL
  ivec2 size = imageSize(table).xy;
  int lines = size.x;
  int positions = size.y;
#else
  ivec2 size = textureSize(depth, 0).xy;
  int lines = size.y;
  int positions = size.x;
#endif
  ivec4 carried[IMAGES];
  for (int image = 0; image < IMAGES; ++image) carried[image] = ivec4(0);
#if SHARED
  int line = int(gl_WorkGroupID.x) * LINES + LOCAL_LINE;
  for (int start = 0; start < positions; start += LENGTH) {
    int position = start + LOCAL_POSITION;
    bool inside = line < lines && position < positions;
    Values values;
    if (inside) values = values_at(line, position, size);
    for (int image = 0; image < IMAGES; ++image) {
      ivec4 sum = inside ? values.image[image] : ivec4(0);
      // Hillis and Steele 1986, Data parallel algorithms: the reach of every sum doubles with each step.
      int side = 0;
      partial_sums[side][LOCAL_LINE][LOCAL_POSITION] = sum;
      barrier();
      for (int reach = 1; reach < LENGTH; reach *= 2) {
        if (LOCAL_POSITION >= reach) sum += partial_sums[side][LOCAL_LINE][LOCAL_POSITION - reach];
        side = 1 - side;
        partial_sums[side][LOCAL_LINE][LOCAL_POSITION] = sum;
        barrier();
      }
      if (inside) store(image, line, position, carried[image] + sum);
      carried[image] += partial_sums[side][LOCAL_LINE][LENGTH - 1];
      barrier();
    }
  }
#else
  int line = int(gl_GlobalInvocationID.x);
  if (line >= lines) return;
  for (int position = 0; position < positions; ++position) {
    Values values = values_at(line, position, size);
    for (int image = 0; image < IMAGES; ++image) {
      carried[image] += values.image[image];
      store(image, line, position, carried[image]);
    }
  }
#endif
}
