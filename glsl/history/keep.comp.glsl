// Keeps the light of this frame, and the surfaces that it fell on. PARTS: layers of the light.
#include "glsl/history/history_frame.glsl"
#include "glsl/surface/gbuffer_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2DArray light;  // rgb / a is the value; a: 0 where there is none
layout(rgba32f) writeonly uniform image2DArray history_light;
layout(rg32ui) writeonly uniform uimage2DArray history_surfaces;
uniform int slot;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  for (int part = 0; part < PARTS; ++part) {
    vec4 sum = texelFetch(light, ivec3(pixel, part), 0);
    imageStore(history_light, ivec3(pixel, slot * PARTS + part), sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0));
  }
  uvec2 surface = history_surface(pixel_depth(pixel), texelFetch(gbuffer_geometric_normal, pixel, 0).xy, pixel_instance(pixel));
  imageStore(history_surfaces, ivec3(pixel, slot), uvec4(surface, 0u, 0u));
}
