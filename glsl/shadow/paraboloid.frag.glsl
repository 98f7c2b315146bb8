// Radial depth of a paraboloid map: where the ray of a texel meets a triangle.
#include "glsl/scene/blocks.glsl"
#include "glsl/shadow/paraboloid.glsl"

layout(location = 0) flat in vec3 corner_a;
layout(location = 1) flat in vec3 corner_b;
layout(location = 2) flat in vec3 corner_c;
layout(location = 3) flat in vec3 depths;
layout(location = 0) out float stored_depth;

#if MASKED
layout(location = 4) flat in vec3 coverage_a;
layout(location = 5) flat in vec3 coverage_b;
layout(location = 6) flat in vec3 coverage_c;
layout(location = 7) flat in uint material_index;

layout(std430) readonly buffer Materials { Material materials[]; };
uniform sampler2D base_colour_texture;

bool covered(vec3 shares) {
  vec3 surface = shares.x * coverage_a + shares.y * coverage_b + shares.z * coverage_c;
  float alpha = materials[material_index].base_colour.a * surface.z;
  if ((materials[material_index].flags & material_has_base_colour_texture) != 0u) {
    alpha *= textureLod(base_colour_texture, surface.xy, 0.0).a;
  }
  return alpha >= materials[material_index].alpha_cutoff;
}
#endif

void main() {
  vec2 p = 2.0 * gl_FragCoord.xy / depths.z - 1.0;
  vec3 shares;
  float t = paraboloid_hit(corner_a, corner_b, corner_c, paraboloid_direction(p), shares);
  bool seen = dot(p, p) <= 1.0 && t >= depths.x && t < depths.y;
#if MASKED
  seen = seen && covered(shares);
#endif
  if (!seen) discard;
  stored_depth = (t - depths.x) / (depths.y - depths.x);
  gl_FragDepth = 1.0 - stored_depth;
}
