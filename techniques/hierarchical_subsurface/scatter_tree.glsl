// The points of translucent bodies and the hierarchy over them: layouts that C++ and GLSL share. Lengths are in radii of the
// body, with its centre as origin, unless stated otherwise.
#ifndef LIMN_SCATTER_TREE_GLSL
#define LIMN_SCATTER_TREE_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_CONST uint scatter_none = 0xffffffffu;

// One draw (storage buffer element; index: that of the draw instance).
struct ScatterBody {
  vec3 centre;  // world, m
  float radius;  // m
  vec3 extinction;  // sigma_t' per metre
  float softening;  // of distances to points: the side of the area that a point stands for
  vec3 absorption;  // sigma_a / sigma_t'
  float eta;
  uint first_node;  // where walks begin, or scatter_none
  uint textured;    // 1: the absorption follows from the base colour of each pixel
  uvec2 unused;
};

// Where a leaf is lit (storage buffer element). World, m.
struct ScatterPoint {
  vec3 position;
  uint instance;  // draw instance, no_instance for unused slots
  vec3 normal;  // unit
  float reach;  // side of the area that it stands for
};

// A leaf or a cluster of them (storage buffer element).
struct ScatterNode {
  vec3 centre;  // centroid
  float area;
  uint children;     // the first of them, or scatter_none
  uint child_count;  // which follow one another
  uint next;         // where the walk goes on behind the node, or scatter_none
  float extent;      // area by which it is opened: its own, or more where its points lie far apart
};

LIMN_END
#endif  // LIMN_SCATTER_TREE_GLSL
