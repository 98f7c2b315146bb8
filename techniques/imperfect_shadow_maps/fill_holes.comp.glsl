// Closes the holes between splats, a work group for each map: every level averages what 2 x 2 texels of the one before know
// (of those only what lies near the nearest), then texels that know nothing take what the next coarser level has.
// TEXELS: per side of a map. LEVELS: beyond the finest; a hole of 2^LEVELS texels is closed.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430) readonly buffer Depths { uint depths[]; };
layout(r32f) writeonly uniform image2DArray maps;
uniform float apart;  // of two stored depths that are not averaged

const float nothing = 1.0;
shared float texels[ROOM];

int side_of(int level) { return (TEXELS + (1 << level) - 1) >> level; }

void pull(int from, int to, int side, int coarse_side) {
  for (int y = int(gl_LocalInvocationID.y); y < coarse_side; y += 16) {
    for (int x = int(gl_LocalInvocationID.x); x < coarse_side; x += 16) {
      float child[4];
      float nearest = nothing;
      for (int k = 0; k < 4; ++k) {
        ivec2 at = min(2 * ivec2(x, y) + ivec2(k & 1, k >> 1), ivec2(side - 1));
        child[k] = texels[from + at.y * side + at.x];
        nearest = min(nearest, child[k]);
      }
      vec2 sum = vec2(0.0);
      for (int k = 0; k < 4; ++k) {
        if (child[k] < nothing && child[k] <= nearest + apart) sum += vec2(child[k], 1.0);
      }
      texels[to + y * coarse_side + x] = sum.y > 0.0 ? sum.x / sum.y : nothing;
    }
  }
}

void push(int from, int to, int coarse_side, int side) {
  for (int y = int(gl_LocalInvocationID.y); y < side; y += 16) {
    for (int x = int(gl_LocalInvocationID.x); x < side; x += 16) {
      int at = to + y * side + x;
      if (texels[at] == nothing) texels[at] = texels[from + (y / 2) * coarse_side + x / 2];
    }
  }
}

void main() {
  int map = int(gl_WorkGroupID.x);
  for (int i = int(gl_LocalInvocationIndex); i < TEXELS * TEXELS; i += 256)
    texels[i] = uintBitsToFloat(depths[map * TEXELS * TEXELS + i]);
  barrier();
  int begin = 0;
  for (int level = 0; level < LEVELS; ++level) {
    int end = begin + side_of(level) * side_of(level);
    pull(begin, end, side_of(level), side_of(level + 1));
    begin = end;
    barrier();
  }
  for (int level = LEVELS; level > 0; --level) {
    int finer = begin - side_of(level - 1) * side_of(level - 1);
    push(begin, finer, side_of(level), side_of(level - 1));
    begin = finer;
    barrier();
  }
  for (int i = int(gl_LocalInvocationIndex); i < TEXELS * TEXELS; i += 256)
    imageStore(maps, ivec3(i % TEXELS, i / TEXELS, map), vec4(texels[i]));
}
