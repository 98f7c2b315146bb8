// One direction of an integer summed-area table of shadow maps: sums along the rows of the maps (VERTICAL 0), then of
// those along the columns, in place. With SHARED, each thread of a work group sums PER_THREAD texels before their sums are
// scanned, and the last is carried on to the next part of the line. Integer sums are the same in any order.
//
// CONTENTS 0: z, or z and z^2, as TABLE_FORMAT says; 1: four moments of MOMENT_BITS; 2: quantised Fourier terms, whose rows
// fourier_rows.comp.glsl sums.
#if CONTENTS == 0
#include "glsl/shadow/summed_area_table.glsl"
#define SUM(a, b) sat_add(a, b)
#define PACK(a) sat_pack(a, TABLE_FORMAT)
#define UNPACK(a) sat_unpack(a, TABLE_FORMAT)
#define TEXEL(z, at) sat_texel(z, TABLE_FORMAT)
#else
#define SUM(a, b) ((a) + (b))
#define PACK(a) (a)
#define UNPACK(a) (a)
#endif
#if CONTENTS == 1
#include "glsl/shadow/moment_shadow.glsl"
#define TEXEL(z, at) moment_texel(z, uvec2(at), MOMENT_BITS)
#endif
#if CONTENTS == 2
#define SUM_TYPE ivec4
layout(IMAGE_FORMAT) uniform iimage2DArray table;
#else
#define SUM_TYPE uvec4
layout(IMAGE_FORMAT) uniform uimage2DArray table;
#endif

#include "glsl/shadow/line_scan.glsl"

#define PER_THREAD 4

#if !VERTICAL
uniform sampler2DArray depth;
#endif

ivec3 texel_at(int line, int position) {
#if VERTICAL
  return ivec3(line, position, gl_WorkGroupID.z);
#else
  return ivec3(position, line, gl_WorkGroupID.z);
#endif
}

SUM_TYPE value_at(ivec3 at) {
#if VERTICAL
  return UNPACK(imageLoad(table, at));
#else
  return TEXEL(texelFetch(depth, at, 0).r, at.xy);
#endif
}

void main() {
  ivec2 size = imageSize(table).xy;
#if VERTICAL
  int lines = size.x;
  int positions = size.y;
#else
  int lines = size.y;
  int positions = size.x;
#endif
  SUM_TYPE carried = SUM_TYPE(0);
#if SHARED
  int line = int(gl_WorkGroupID.x) * LINES + LOCAL_LINE;
  for (int start = 0; start < positions; start += LENGTH * PER_THREAD) {
    int first = start + LOCAL_POSITION * PER_THREAD;
    SUM_TYPE sums[PER_THREAD];
    SUM_TYPE sum = SUM_TYPE(0);
    for (int i = 0; i < PER_THREAD; ++i) {
      if (line < lines && first + i < positions) sum = SUM(sum, value_at(texel_at(line, first + i)));
      sums[i] = sum;
    }
    SUM_TYPE all;
    SUM_TYPE before = SUM(carried, scan_line(sum, all));
    for (int i = 0; i < PER_THREAD; ++i) {
      if (line < lines && first + i < positions)
        imageStore(table, texel_at(line, first + i), PACK(SUM(before, sums[i])));
    }
    carried = SUM(carried, all);
  }
#else
  int line = int(gl_GlobalInvocationID.x);
  if (line >= lines) return;
  for (int i = 0; i < positions; ++i) {
    ivec3 at = texel_at(line, i);
    carried = SUM(carried, value_at(at));
    imageStore(table, at, PACK(carried));
  }
#endif
}
