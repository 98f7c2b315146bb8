// The sphere of directions in triangles: the octahedron's faces are the octants, and every cell splits into four at the middles
// of its edges (as radiance lies in Stamminger, Scheel, Granier, Perez-Cazorla, Drettakis and Sillion 1999, Efficient Glossy
// Global Illumination with Interactive Viewing).
//
// Face 0 is the octant of positive x, y and z; bits 0, 1 and 2 of a face say that x, y and z are negative, so that faces 0 to 3
// are the hemisphere around +z and the horizon is an edge of theirs. On a face a direction has the place p = |w| / (|x| + |y| +
// |z|), whose components are barycentric. Child i < 3 of a cell lies at its corner i, child 3 in its midst with corner i
// opposite to the parent's. No table: splitting halves and adds, which floats do exactly down to level 20.
#ifndef LIMN_OCTAHEDRAL_CELLS_GLSL
#define LIMN_OCTAHEDRAL_CELLS_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_FN uint octahedral_face(vec3 w) {
  return (w.x < 0.0f ? 1u : 0u) | (w.y < 0.0f ? 2u : 0u) | (w.z < 0.0f ? 4u : 0u);
}

// What turns places of a face into points of the octahedron.
LIMN_FN vec3 octahedral_signs(uint face) {
  return vec3((face & 1u) != 0u ? -1.0f : 1.0f, (face & 2u) != 0u ? -1.0f : 1.0f, (face & 4u) != 0u ? -1.0f : 1.0f);
}

// The place of w (any length but 0) on its face.
LIMN_FN vec3 octahedral_place(vec3 w) {
  vec3 a = abs(w);
  return a / (a.x + a.y + a.z);
}

// The child that a place of a cell lies in; p becomes the place in that child.
LIMN_FN uint octahedral_descend(LIMN_INOUT(vec3) p) {
  if (p.x > 0.5f) {
    p = 2.0f * p - vec3(1.0f, 0.0f, 0.0f);
    return 0u;
  }
  if (p.y > 0.5f) {
    p = 2.0f * p - vec3(0.0f, 1.0f, 0.0f);
    return 1u;
  }
  if (p.z > 0.5f) {
    p = 2.0f * p - vec3(0.0f, 0.0f, 1.0f);
    return 2u;
  }
  p = vec3(1.0f) - 2.0f * p;
  return 3u;
}

// A cell of a face: place p of it is the place base + scale p of the face. |scale| is 2^-level.
struct OctahedralCell {
  vec3 base;
  float scale;
};

LIMN_FN OctahedralCell octahedral_root() {
  OctahedralCell c;
  c.base = vec3(0.0f);
  c.scale = 1.0f;
  return c;
}

LIMN_FN OctahedralCell octahedral_child(OctahedralCell c, uint child) {
  float h = 0.5f * c.scale;
  OctahedralCell r;
  r.base = c.base + h * vec3(child == 0u || child == 3u ? 1.0f : 0.0f, child == 1u || child == 3u ? 1.0f : 0.0f,
                             child == 2u || child == 3u ? 1.0f : 0.0f);
  r.scale = child == 3u ? -h : h;
  return r;
}

// The unit directions of a cell's corners, i in 0 to 2, and of its centre, which its child 3 shares.
LIMN_FN vec3 octahedral_corner(OctahedralCell c, vec3 signs, uint i) {
  vec3 place = c.base + c.scale * vec3(i == 0u ? 1.0f : 0.0f, i == 1u ? 1.0f : 0.0f, i == 2u ? 1.0f : 0.0f);
  return normalize(signs * place);
}
LIMN_FN vec3 octahedral_centre(OctahedralCell c, vec3 signs) {
  return normalize(signs * (c.base + vec3(c.scale / 3.0f)));
}

// Steps from the middle of a footprint to its taps, in edges of the cell: the mean of the taps has about half the error of the
// cells' own values for lobes of roughness 0.1 to 0.5 (0.2 to 0.3 do; with 0.5 it is worse than the cells at 0.2 and below).
LIMN_CONST float octahedral_tap_reach = 0.25f;

// The direction (any length) of tap i, 0 to 5, around a place of a face: a hexagon around it for cells whose edge is the part
// `edge` of the face's. Steps over an edge of the octant give negative places, which are those of the octant behind it.
LIMN_FN vec3 octahedral_tap(vec3 place, vec3 signs, float edge, uint i) {
  float step = (i < 3u ? octahedral_tap_reach : -octahedral_tap_reach) * edge;
  uint axis = i % 3u;
  vec3 way = axis == 0u ? vec3(step, -step, 0.0f) : axis == 1u ? vec3(0.0f, step, -step) : vec3(-step, 0.0f, step);
  return signs * (place + way);
}

// The integral of the unit direction over the triangle between three, of either sign: its part along n is the solid angle projected
// along n (Lambert's formula, half the sum of edge angle times edge normal). The flat triangle and the segments between its
// edges and their arcs are added, since the edges' terms nearly cancel where the triangle is small.
LIMN_FN vec3 triangle_projected_angle(vec3 a, vec3 b, vec3 c) {
  vec3 ab = cross(a, b - a);
  vec3 bc = cross(b, c - b);
  vec3 ca = cross(c, a - c);
  return 0.5f * (cross(b - a, c - a) + angle_over_sine_minus_one(length(ab), dot(a, b)) * ab +
                 angle_over_sine_minus_one(length(bc), dot(b, c)) * bc +
                 angle_over_sine_minus_one(length(ca), dot(c, a)) * ca);
}

LIMN_END
#endif  // LIMN_OCTAHEDRAL_CELLS_GLSL
