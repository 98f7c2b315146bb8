// Percentage-closer filtering of every texel in a kernel of the shadow map (Reeves, Salesin, Cook 1987).
#ifndef LIMN_TEXEL_KERNEL_GLSL
#define LIMN_TEXEL_KERNEL_GLSL
#include "glsl/shadow/visibility.glsl"

// What the kernel low..high covers of a texel.
float texel_coverage(vec2 low, vec2 high, ivec2 texel) {
  vec2 covered = max(min(vec2(texel) + 1.0, high) - max(vec2(texel), low), vec2(0.0));
  return covered.x * covered.y;
}

// The lit share of the kernel low..high in texels of the cursor's view, of positive area, which the map holds some of. What lies
// outside the map is unoccluded. Loops end in their condition: software renderers run a body once more where it comes first.
float texel_kernel_lit(ShadowCursor cursor, vec2 low, vec2 high) {
  ivec2 first = max(ivec2(floor(low)), ivec2(0));
  ivec2 last = min(ivec2(ceil(high)), ivec2(cursor.view.size)) - 1;
  float blocked = 0.0;
  int y = first.y;
  do {
    int x = first.x;
    do {
      if (shadow_texel(cursor, ivec2(x, y)).blocked) blocked += texel_coverage(low, high, ivec2(x, y));
    } while (++x <= last.x);
  } while (++y <= last.y);
  return clamp(1.0 - blocked / ((high.x - low.x) * (high.y - low.y)), 0.0, 1.0);
}

#endif  // LIMN_TEXEL_KERNEL_GLSL
