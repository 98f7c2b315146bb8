// One direction of an integer summed-area table of shadow maps: sums along the rows of the maps (VERTICAL 0), then of
// those along the columns, in place. Either one thread follows a whole line (SHARED 0: quickest where threads are few,
// on software renderers), or each thread of a work group sums PER_THREAD texels, LENGTH of them per line scan these
// sums in shared memory, and the last is carried on to the next part of the line. Integer sums are the same in any order.
//
// MOMENT_BITS 0: sums of z or of z and z^2 as TABLE_FORMAT says; else four moments of so many bits.
#if MOMENT_BITS
#include "glsl/shadow/moment_shadow.glsl"
#define SUM(a, b) ((a) + (b))
#define PACK(a) (a)
#define UNPACK(a) (a)
#define TEXEL(z, at) moment_texel(z, uvec2(at), MOMENT_BITS)
#else
#include "glsl/shadow/summed_area_table.glsl"
#define SUM(a, b) sat_add(a, b)
#define PACK(a) sat_pack(a, TABLE_FORMAT)
#define UNPACK(a) sat_unpack(a, TABLE_FORMAT)
#define TEXEL(z, at) sat_texel(z, TABLE_FORMAT)
#endif

#include "glsl/shadow/scan_layout.glsl"

#if SHARED
#define PER_THREAD 4
shared uvec4 partial_sums[2][LINES][LENGTH];
#endif

layout(IMAGE_FORMAT) uniform uimage2DArray table;
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

uvec4 value_at(ivec3 at) {
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
  uvec4 carried = uvec4(0u);
#if SHARED
  int line = int(gl_WorkGroupID.x) * LINES + LOCAL_LINE;
  for (int start = 0; start < positions; start += LENGTH * PER_THREAD) {
    int first = start + LOCAL_POSITION * PER_THREAD;
    uvec4 sums[PER_THREAD];
    uvec4 sum = uvec4(0u);
    for (int i = 0; i < PER_THREAD; ++i) {
      if (line < lines && first + i < positions) sum = SUM(sum, value_at(texel_at(line, first + i)));
      sums[i] = sum;
    }
    // Hillis and Steele 1986, Data parallel algorithms: the reach of every sum doubles with each step.
    int side = 0;
    partial_sums[side][LOCAL_LINE][LOCAL_POSITION] = sum;
    barrier();
    for (int reach = 1; reach < LENGTH; reach *= 2) {
      if (LOCAL_POSITION >= reach) sum = SUM(sum, partial_sums[side][LOCAL_LINE][LOCAL_POSITION - reach]);
      side = 1 - side;
      partial_sums[side][LOCAL_LINE][LOCAL_POSITION] = sum;
      barrier();
    }
    uvec4 before = carried;
    if (LOCAL_POSITION > 0) before = SUM(carried, partial_sums[side][LOCAL_LINE][LOCAL_POSITION - 1]);
    for (int i = 0; i < PER_THREAD; ++i) {
      if (line < lines && first + i < positions)
        imageStore(table, texel_at(line, first + i), PACK(SUM(before, sums[i])));
    }
    carried = SUM(carried, partial_sums[side][LOCAL_LINE][LENGTH - 1]);
    barrier();
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
