// Radiance to what a display shows: exposure, tone curve, sRGB (glsl/numeric/tone_curve.glsl).
#include "glsl/numeric/tone_curve.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
#if VISIBILITY
uniform sampler2DArray visibility;
#else
uniform sampler2D radiance;
#endif
layout(rgba8) writeonly uniform image2D display;
uniform float exposure_ev;
uniform uint tone_curve;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(display)))) return;
#if VISIBILITY
  vec3 value = texelFetch(visibility, ivec3(pixel, 0), 0).rrr;
#else
  vec3 value = texelFetch(radiance, pixel, 0).rgb;
#endif
  imageStore(display, pixel, vec4(tone_map(value, exposure_ev, tone_curve), 1.0));
}
