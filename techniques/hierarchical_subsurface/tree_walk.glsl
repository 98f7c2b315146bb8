// The walk through a body's hierarchy. Whoever includes this has declared `nodes` (ScatterNode) and `entering_light` (vec4),
// both indexed by node.
#ifndef LIMN_TREE_WALK_GLSL
#define LIMN_TREE_WALK_GLSL
#include "techniques/hierarchical_subsurface/scatter_matter.glsl"
LIMN_BEGIN

// Whether the solid angle of a cluster's extent (Jensen and Buhler 2002), at the softened distance, is above the tolerance, sr.
LIMN_FN bool scatter_opens(ScatterNode node, float softened2, float tolerance) {
  return node.children != scatter_none && node.extent > tolerance * softened2;
}

// What the points below `first` and behind it send to x. Clusters follow each other in depth-first order, so that no stack is
// needed: a cluster that is opened leads to its first child, all else to what comes behind it.
LIMN_FN vec3 light_of_points(uint first, vec3 x, ProfileColours matter, float softening, float tolerance) {
  vec3 sum = vec3(0.0f);
  uint at = first;
  while (at != scatter_none) {
    ScatterNode node = nodes[at];
    vec3 way = node.centre - x;
    float softened2 = dot(way, way) + softening * softening;
    bool opens = scatter_opens(node, softened2, tolerance);
    if (!opens) sum += node.area * vec3(entering_light[at]) * scatter_far(matter, sqrt(softened2));
    at = opens ? node.children : node.next;
  }
  return sum;
}

LIMN_END
#endif  // LIMN_TREE_WALK_GLSL
