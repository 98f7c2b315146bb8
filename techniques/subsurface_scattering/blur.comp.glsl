// The mean over the pattern of interleaved pixels along rows; exit.comp.glsl takes it along columns.
#include "techniques/subsurface_scattering/pattern_mean.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) writeonly uniform image2D blurred;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  uvec4 own = texelFetch(planes, pixel, 0);
  if (own.w == no_instance) return;
  imageStore(blurred, pixel, pattern_mean(pixel, own, ivec2(1, 0)));
}
