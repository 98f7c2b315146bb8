// Layers of reflective maps in groups. A group is one face of one light, seen from each point on the light: its layers show
// nearly the same surfaces, so that virtual lights are spread over, and their flux is conserved by, the group.
#ifndef LIMN_MAP_GROUPS_GLSL
#define LIMN_MAP_GROUPS_GLSL
#include "glsl/shadow/shadow_view.glsl"

layout(std430) readonly buffer MapLights { ShadowLight map_lights[]; };  // light by light, point by point
uniform uint layers;         // of the maps
uniform uint light_count;    // lights that have maps
uniform uint points_listed;  // elements of map_lights for each of them; what has no extent lists its one point as often

// The layers of one light: point s on it and face f are layer first + s * faces + f.
struct LightLayers {
  uint first;
  uint faces;
  uint points;
};

LightLayers light_layers(uint light) {
  LightLayers l;
  ShadowLight maps = map_lights[light * points_listed];
  uint end = light + 1u < light_count ? map_lights[(light + 1u) * points_listed].first_layer : layers;
  l.first = maps.first_layer;
  l.faces = shadow_face_count(maps.faces);
  l.points = (end - l.first) / l.faces;
  return l;
}

#endif  // LIMN_MAP_GROUPS_GLSL
