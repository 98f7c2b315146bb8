// What people see of a texture's values: one channel as grey or three as colours, `low` black and `high` white.
// Values that are not finite are magenta.
layout(local_size_x = 8, local_size_y = 8) in;
uniform SAMPLER values;  // sampler2D, isampler2D or usampler2D
layout(rgba8) writeonly uniform image2D display;
uniform int channel;  // 0 to 3; 4: the first three as colours
uniform float low, high;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(display)))) return;
  vec4 value = vec4(texelFetch(values, texel, 0));
  vec3 shown = channel < 4 ? vec3(value[min(channel, 3)]) : value.rgb;
  bool finite = !any(isnan(shown)) && !any(isinf(shown));
  float span = high - low;
  vec3 colour = clamp((shown - low) / (span != 0.0 ? span : 1.0), 0.0, 1.0);
  imageStore(display, texel, finite ? vec4(colour, 1.0) : vec4(1.0, 0.0, 1.0, 1.0));
}
