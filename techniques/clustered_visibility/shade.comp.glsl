// N virtual point lights with the soft shadows of M area lights (thesis, chapter 6). The lights of a pixel come sorted by
// cluster, so that the visibility of a cluster is found once for all of them.
#define GATHER_PIXELS 1
#define VPL_AREAS 1
#include "glsl/indirect/gather_main.glsl"
#include "techniques/clustered_visibility/area_visibility.glsl"

float vpl_area_visibility(uint area, Receiver r) { return area_visibility(area_light(area), r.position, r.geometric_normal); }
