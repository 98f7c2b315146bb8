// Which height map a pixel shows, where in it, and the frame of the base.
#ifndef LIMN_RELIEF_INPUT_GLSL
#define LIMN_RELIEF_INPUT_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/surface/gbuffer_input.glsl"

uniform sampler2D gbuffer_tangent;
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Materials { Material materials[]; };

struct PixelRelief {
  int height;   // index of the height map; -1: no map, or nothing is seen
  vec2 uv;      // within the map, [0, 1]
  float level;  // of detail
  Frame frame;  // t along rising u, b along rising v, n off the base: directions of the field in world space
};

PixelRelief pixel_relief(ivec2 pixel) {
  vec4 tangent = texelFetch(gbuffer_tangent, pixel, 0);
  GBufferPlace place = gbuffer_place_unpack(tangent.gba);
  PixelRelief relief;
  relief.height = -1;
  if (place.present) relief.height = materials[instances[pixel_instance(pixel)].material].height;
  relief.uv = place.uv;
  relief.level = place.level;
  relief.frame = frame_turned(pixel_geometric_normal(pixel), tangent.r);
  if (place.left_handed) relief.frame.b = -relief.frame.b;
  return relief;
}

#endif  // LIMN_RELIEF_INPUT_GLSL
