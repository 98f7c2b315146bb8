// N virtual point lights with the soft shadows of M area lights (thesis, chapter 6). The lights of a pixel come sorted by
// cluster, so that the visibility of a cluster is found once for all of them, and its view is loaded once for all pixels.
#define GATHER_PIXELS 1
#define VPL_SHADOWS 1
#include "glsl/indirect/gather_main.glsl"
#include "techniques/clustered_visibility/area_visibility.glsl"

const float unknown = -1.0;
uint known_area = 0xffffffffu;
AreaLight known;
float known_visibility;

void vpl_begin(uint vpl, VirtualPointLight light) {
  uint area = uint(light.cluster);
  bool wanted = area != known_area;
  while (wanted) {  // a loop, not an `if`: software renderers run both sides of those
    known = area_light(area);
    known_area = area;
    known_visibility = unknown;
    wanted = false;
  }
}

float vpl_visibility(VirtualPointLight light, uint pixel, Receiver r, VplSight sight) {
  bool wanted = known_visibility == unknown;
  while (wanted) {
    known_visibility = area_visibility(known, r.position, r.geometric_normal);
    wanted = false;
  }
  return known_visibility;
}
