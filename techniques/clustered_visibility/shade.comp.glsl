// N virtual point lights with the soft shadows of M area lights (thesis, chapter 6). The lights of a pixel come sorted by
// cluster, so that the visibility of a cluster is found once for all of them.
#include "glsl/indirect/gather_main.glsl"
#include "techniques/clustered_visibility/area_visibility.glsl"

uint known_area = 0xffffffffu;
float known_visibility = 1.0;

float vpl_visibility(uint vpl, vec3 receiver, vec3 normal) {
  uint area = uint(virtual_lights[vpl].cluster);
  bool wanted = area != known_area;
  while (wanted) {  // a loop, not an `if`: software renderers run both sides of those
    known_visibility = area_visibility(area, receiver, normal);
    known_area = area;
    wanted = false;
  }
  return known_visibility;
}
