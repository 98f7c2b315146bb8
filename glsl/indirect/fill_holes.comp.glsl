// Closes the holes between splats, a work group for each tile of a map: every level averages what 2 x 2 texels of the one before
// know (of those only what lies near the nearest), then texels that know nothing take what the next coarser level has.
// TEXELS: per side of a map. TILE: per side of a tile: 64, or all of a smaller map, so that no group of 2^LEVELS texels lies in
// two tiles. LEVELS: beyond the finest, at most 6; a hole of 2^LEVELS texels is closed; 0: depths are copied. ROOM: texels of all
// levels of a tile.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430) readonly buffer Depths { uint depths[]; };
layout(r32f) writeonly uniform image2DArray maps;
uniform float apart;  // of two stored depths that are not averaged

#if LEVELS == 0
void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  int map = int(gl_WorkGroupID.z);
  if (any(greaterThanEqual(at, ivec2(TEXELS)))) return;
  imageStore(maps, ivec3(at, map), vec4(uintBitsToFloat(depths[(map * TEXELS + at.y) * TEXELS + at.x])));
}
#else
const float nothing = 1.0;
shared float texels[ROOM];

ivec2 sides_of(int level) {
  ivec2 sides = min(ivec2(TILE), TEXELS - TILE * ivec2(gl_WorkGroupID.xy));
  return (sides + (1 << level) - 1) >> level;
}
int texels_of(int level) { return sides_of(level).x * sides_of(level).y; }

void pull(int from, int to, ivec2 sides, ivec2 coarse_sides) {
  for (int y = int(gl_LocalInvocationID.y); y < coarse_sides.y; y += 16) {
    for (int x = int(gl_LocalInvocationID.x); x < coarse_sides.x; x += 16) {
      float child[4];
      float nearest = nothing;
      for (int k = 0; k < 4; ++k) {
        ivec2 at = min(2 * ivec2(x, y) + ivec2(k & 1, k >> 1), sides - 1);
        child[k] = texels[from + at.y * sides.x + at.x];
        nearest = min(nearest, child[k]);
      }
      vec2 sum = vec2(0.0);
      for (int k = 0; k < 4; ++k) {
        if (child[k] < nothing && child[k] <= nearest + apart) sum += vec2(child[k], 1.0);
      }
      texels[to + y * coarse_sides.x + x] = sum.y > 0.0 ? sum.x / sum.y : nothing;
    }
  }
}

void push(int from, int to, int coarse_width, ivec2 sides) {
  for (int y = int(gl_LocalInvocationID.y); y < sides.y; y += 16) {
    for (int x = int(gl_LocalInvocationID.x); x < sides.x; x += 16) {
      int at = to + y * sides.x + x;
      if (texels[at] == nothing) texels[at] = texels[from + (y / 2) * coarse_width + x / 2];
    }
  }
}

void main() {
  int map = int(gl_WorkGroupID.z);
  ivec2 corner = TILE * ivec2(gl_WorkGroupID.xy);
  ivec2 sides = sides_of(0);
  for (int y = int(gl_LocalInvocationID.y); y < sides.y; y += 16) {
    for (int x = int(gl_LocalInvocationID.x); x < sides.x; x += 16)
      texels[y * sides.x + x] = uintBitsToFloat(depths[(map * TEXELS + corner.y + y) * TEXELS + corner.x + x]);
  }
  barrier();
  int begin = 0;
  for (int level = 0; level < LEVELS; ++level) {
    int end = begin + texels_of(level);
    pull(begin, end, sides_of(level), sides_of(level + 1));
    begin = end;
    barrier();
  }
  for (int level = LEVELS; level > 0; --level) {
    int finer = begin - texels_of(level - 1);
    push(begin, finer, sides_of(level).x, sides_of(level - 1));
    begin = finer;
    barrier();
  }
  for (int y = int(gl_LocalInvocationID.y); y < sides.y; y += 16) {
    for (int x = int(gl_LocalInvocationID.x); x < sides.x; x += 16)
      imageStore(maps, ivec3(corner + ivec2(x, y), map), vec4(texels[y * sides.x + x]));
  }
}
#endif
