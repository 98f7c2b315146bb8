// Linear depth of a shadow map, finite and in [0, 1] whatever the geometry. MASKED 1: alpha test first, at texture level 0
// as the reference's shadow rays.
#include "glsl/scene/blocks.glsl"

layout(location = 0) in float linear_depth;
layout(location = 0) out float stored_depth;

#if MASKED
layout(location = 1) in vec2 surface_uv;
layout(location = 2) in float surface_alpha;
layout(location = 3) flat in uint material_index;

layout(std430) readonly buffer Materials { Material materials[]; };
uniform sampler2D base_colour_texture;

void alpha_test() {
  float alpha = materials[material_index].base_colour.a * surface_alpha;
  if ((materials[material_index].flags & material_has_base_colour_texture) != 0u) {
    alpha *= textureLod(base_colour_texture, surface_uv, 0.0).a;
  }
  if (alpha < materials[material_index].alpha_cutoff) discard;
}
#endif

void main() {
#if MASKED
  alpha_test();
#endif
  stored_depth = linear_depth < 1.0 ? max(linear_depth, 0.0) : 1.0;  // NaN: nothing there
}
