// One texel of a virtual light's own map against the receiver.
#define VPL_SHADOWS 1
#include "glsl/indirect/gather_main.glsl"
#include "glsl/indirect/light_map.glsl"

uniform sampler2DArray maps;  // of consecutive lights
uniform uint first_map;       // the light of their first layer
uniform float extent;         // diagonal of the scene's bounds, m
uniform float bias;           // texel footprints

LightMaps all_maps;
LightMapAxes axes;
int layer;

void vpl_begin(uint vpl, VirtualPointLight light) {
  all_maps = light_maps(extent, uint(textureSize(maps, 0).x));
  axes = light_map_axes(light.normal);
  layer = int(vpl - first_map);
}

float vpl_visibility(VirtualPointLight light, uint pixel, Receiver r, VplSight sight) {
  LightMapPlace place = light_map_place(all_maps, axes, -sight.offset, sight.towards_receiver);
  ivec2 texel = ivec2(clamp(place.texel, vec2(0.0), vec2(all_maps.texels - 1.0)));
  float stored = texelFetch(maps, ivec3(texel, layer), 0).r;
  float raise = bias * 4.0 / all_maps.texels;
  bool blocked = place.inside &&
                 light_map_blocks(all_maps, axes, place, stored, r.geometric_normal, -sight.above, raise);
  return blocked ? 0.0 : 1.0;
}
