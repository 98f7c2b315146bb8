// Alpha test of shadow maps, at texture level 0 as the reference's shadow rays.
#include "glsl/blocks.glsl"

layout(location = 0) in vec2 surface_uv;
layout(location = 1) in float surface_alpha;
layout(location = 2) flat in uint material_index;

layout(std430, binding = 1) readonly buffer Materials { Material materials[]; };
layout(binding = 0) uniform sampler2D base_colour_texture;

void main() {
  float alpha = materials[material_index].base_colour.a * surface_alpha;
  if ((materials[material_index].info.x & material_has_base_colour_texture) != 0u) {
    alpha *= textureLod(base_colour_texture, surface_uv, 0.0).a;
  }
  if (alpha < materials[material_index].emission.w) discard;
}
