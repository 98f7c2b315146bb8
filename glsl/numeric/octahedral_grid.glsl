// The corners of all triangles of one level (octahedral_cells.glsl) as a list, and what lies between them: directions in a
// uniform basis that is linear in each triangle.
//
// With n = 2^level the hemisphere around +z has the corners (x, y, z) n = (i, j, n - |i| - |j|), row after row of equal j: a
// diamond.
#ifndef LIMN_OCTAHEDRAL_GRID_GLSL
#define LIMN_OCTAHEDRAL_GRID_GLSL
#include "glsl/numeric/octahedral_cells.glsl"
LIMN_BEGIN

// The number of corners.
LIMN_FN uint octahedral_grid_size(uint n) { return 2u * n * (n + 1u) + 1u; }

// The number of corner (i, j), |i| + |j| <= n, in the list.
LIMN_FN uint octahedral_grid_index(ivec2 corner, uint n) {
  int size = int(n);
  int before = size - abs(corner.y);  // corners of the row on each side of i = 0
  int first = corner.y <= 0 ? before * before : int(octahedral_grid_size(n)) - (before + 1) * (before + 1);
  return uint(first + before + corner.x);
}

// The triangle around a direction above the horizon: its corners and their weights, whose sum is 1.
struct OctahedralGridPlace {
  uvec3 corner;
  vec3 weight;
};

LIMN_FN OctahedralGridPlace octahedral_grid_place(vec3 w, uint n) {
  int size = int(n);
  vec3 place = float(size) * octahedral_place(w);
  int i = min(int(place.x), size - 1);
  int j = min(int(place.y), size - 1 - i);
  vec2 inside = vec2(place) - vec2(float(i), float(j));
  // Triangles beside the equator's corners have their base towards the pole.
  bool outer = inside.x + inside.y > 1.0f && i + j < size - 1;
  int sx = w.x < 0.0f ? -1 : 1;
  int sy = w.y < 0.0f ? -1 : 1;
  ivec2 origin = outer ? ivec2(i + 1, j + 1) : ivec2(i, j);
  OctahedralGridPlace r;
  r.corner = uvec3(octahedral_grid_index(ivec2(sx * origin.x, sy * origin.y), n),
                   octahedral_grid_index(ivec2(sx * (i + 1), sy * j), n),
                   octahedral_grid_index(ivec2(sx * i, sy * (j + 1)), n));
  r.weight = outer ? vec3(inside.x + inside.y - 1.0f, 1.0f - inside.y, 1.0f - inside.x)
                   : vec3(1.0f - inside.x - inside.y, inside.x, inside.y);
  return r;
}

LIMN_END
#endif  // LIMN_OCTAHEDRAL_GRID_GLSL
