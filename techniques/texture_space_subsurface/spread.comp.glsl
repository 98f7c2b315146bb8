// Spreads light along rows (ROWS 1) or columns (0) of the textures, from the Gaussian before this one to this one, and adds what
// columns give to the light of all Gaussians. FIRST 1: this is the narrowest that is spread; LAST 1: no other follows. Seven taps
// over the chart that a texel is in.
#include "glsl/scene/blocks.glsl"
#include "techniques/texture_space_subsurface/body_texture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) readonly buffer Bodies { TexturedBody bodies[]; };
layout(std430) readonly buffer Gaussians { SurfaceGaussian gaussians[]; };
uniform sampler2DArray surface_frame;
uniform sampler2DArray lit;  // a: chart
#if !LAST
layout(rgba32f) writeonly uniform image2DArray spread;
#endif
#if !ROWS
layout(rgba32f) uniform image2DArray leaving;
#if FIRST
uniform sampler2DArray entered;  // not spread at all
#endif
#endif
uniform uint gaussian;

const ivec3 along = ROWS != 0 ? ivec3(1, 0, 0) : ivec3(0, 1, 0);

// rgb: light between two texels, a: how much of it is on the chart.
vec4 light_at(ivec3 texel, float offset, float chart) {
  float start = floor(offset);
  float part = offset - start;
  int last = ROWS != 0 ? textureSize(lit, 0).x - 1 : textureSize(lit, 0).y - 1;
  int at = (ROWS != 0 ? texel.x : texel.y) + int(clamp(start, -16384.0, 16384.0));
  ivec3 base = texel * (ivec3(1) - along);
  vec4 a = texelFetch(lit, base + along * clamp(at, 0, last), 0);
  vec4 b = texelFetch(lit, base + along * clamp(at + 1, 0, last), 0);
  float on_a = at >= 0 && at <= last && a.w == chart ? 1.0 - part : 0.0;
  float on_b = at + 1 >= 0 && at + 1 <= last && b.w == chart ? part : 0.0;
  return vec4(on_a * a.rgb + on_b * b.rgb, on_a + on_b);
}

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel, textureSize(lit, 0)))) return;
  vec4 here = texelFetch(lit, texel, 0);
  vec3 light = here.rgb;
  if (here.w != 0.0) {
    vec2 size = max(texelFetch(surface_frame, texel, 0).zw, vec2(1e-30));
    float texel_size = ROWS != 0 ? size.x : size.y;
    uint first = bodies[texel.z].kind * uint(GAUSSIANS);
    float wide = gaussians[first + gaussian].sigma;
    // Gaussians below half a texel are not spread: taps between texels would make them wider than they are.
    float narrow = gaussian > 0u ? gaussians[first + gaussian - 1u].sigma : 0.0;
    if (2.0 * narrow < texel_size) narrow = 0.0;
    if (2.0 * wide >= texel_size) {
      float apart = tap_step * sqrt(max(wide * wide - narrow * narrow, 0.0)) / texel_size;
      vec4 sum = tap_weights[0] * vec4(here.rgb, 1.0);
      for (int i = 1; i < 4; ++i)
        sum += tap_weights[i] * (light_at(texel, -float(i) * apart, here.w) + light_at(texel, float(i) * apart, here.w));
      light = sum.rgb / sum.a;
    }
#if !ROWS
    vec3 part = gaussians[first + gaussian].weight * spread_share(wide, size);
#if FIRST
    vec3 rest = vec3(1.0);
    for (uint i = 0u; i < uint(GAUSSIANS); ++i)
      rest -= gaussians[first + i].weight * spread_share(gaussians[first + i].sigma, size);
    vec3 before = max(rest, vec3(0.0)) * texelFetch(entered, texel, 0).rgb;
#else
    vec3 before = imageLoad(leaving, texel).rgb;
#endif
    imageStore(leaving, texel, vec4(before + part * light, here.w));
#endif
  }
#if !LAST
  imageStore(spread, texel, vec4(light, here.w));
#endif
}
