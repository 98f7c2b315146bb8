// The sphere of directions as a cube map of bins, 6 x N x N (thesis, section 4.3.2, "Discretization"), and the groups of
// surface elements that links in the bins lead to.
//
// A bin is face N^2 + row N + column. On face 2 axis + (1 where negative) the column counts along the next axis and the row
// along the one after it; (u, v) in [-1, 1]^2 are those coordinates over the major one's magnitude.
#ifndef LIMN_DIRECTION_BINS_GLSL
#define LIMN_DIRECTION_BINS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_CONST uint no_link = 0xffffffffu;
LIMN_CONST uint link_back = 0x80000000u;  // the link meets the back of a single-sided surface: it blocks and is black

// Four sibling elements, or fewer: an oriented disc and its bounds each (storage buffer element). Element i of the scene is
// lane i % 4 of group i / 4. The children of lane k are group children.x + k.
struct ElementGroup {
  vec4 x;  // centres, in the units and axes of the elements (core/radiosity/forest.h)
  vec4 y;
  vec4 z;
  vec4 nx;  // unit normals
  vec4 ny;
  vec4 nz;
  vec4 area;
  vec4 radius;  // around the centre, of all leaves' centres
  vec4 spread;  // at most the length of (normal of a leaf - normal)
  vec4 disc;    // radius of a disc that covers all leaves' discs
  uint children;  // group of lane 0's, or no_link
  uint lanes;     // in use
  uint backs;     // 1 if they can be met
  uint object;
};

// A direction's face and its place there; v: any length but 0.
LIMN_FN uint bin_face(vec3 d, LIMN_OUT(vec2) uv) {
  vec3 a = abs(d);
  if (a.x >= a.y && a.x >= a.z) {
    uv = vec2(d.y, d.z) / a.x;
    return d.x < 0.0f ? 1u : 0u;
  }
  if (a.y >= a.z) {
    uv = vec2(d.z, d.x) / a.y;
    return d.y < 0.0f ? 3u : 2u;
  }
  uv = vec2(d.x, d.y) / a.z;
  return d.z < 0.0f ? 5u : 4u;
}

// The direction through a place on a face; its major coordinate is +-1.
LIMN_FN vec3 bin_face_direction(uint face, vec2 uv) {
  float major = (face & 1u) != 0u ? -1.0f : 1.0f;
  if (face < 2u) return vec3(major, uv.x, uv.y);
  if (face < 4u) return vec3(uv.y, major, uv.x);
  return vec3(uv.x, uv.y, major);
}

LIMN_FN uint bin_of(vec3 d, uint n) {
  vec2 uv;
  uint face = bin_face(d, uv);
  vec2 place = (uv + vec2(1.0f)) * (0.5f * float(n));
  uint column = min(uint(max(place.x, 0.0f)), n - 1u);
  uint row = min(uint(max(place.y, 0.0f)), n - 1u);
  return (face * n + row) * n + column;
}

// Through the bin's centre; its major coordinate is +-1.
LIMN_FN vec3 bin_direction(uint bin, uint n) {
  uint column = bin % n;
  uint row = bin / n % n;
  vec2 uv = (vec2(float(column), float(row)) + vec2(0.5f)) * (2.0f / float(n)) - vec2(1.0f);
  return bin_face_direction(bin / (n * n), uv);
}

// Solid angle (sr) of the part of a face between (0, 0) and (u, v), signed.
LIMN_FN float bin_corner_angle(float u, float v) {
  return atan(u * v / sqrt(u * u + v * v + 1.0f));
}

// Solid angle of a bin, sr.
LIMN_FN float bin_solid_angle(uint bin, uint n) {
  float width = 2.0f / float(n);
  float u = float(bin % n) * width - 1.0f;
  float v = float(bin / n % n) * width - 1.0f;
  return bin_corner_angle(u + width, v + width) - bin_corner_angle(u, v + width) -
         bin_corner_angle(u + width, v) + bin_corner_angle(u, v);
}

// Width alpha (GGX) of a lobe that is looked up at the centres of bins: no narrower than bins, between whose centres it would
// be lost. Half vectors turn half as far as directions.
LIMN_FN float binned_alpha(float alpha, uint n) {
  return max(alpha, 0.25f * pi / float(n));
}

LIMN_END
#endif  // LIMN_DIRECTION_BINS_GLSL
