// Irradiance on the texels of a flat base over that across the direction of one light that is far away.
#include "glsl/light/light_centre.glsl"
#include "techniques/bump_interreflection/bump_texels.glsl"
#include "techniques/bump_interreflection/flat_base.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) readonly buffer Lights { Light lights[]; };
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer FlatBases { FlatBase flat_bases[]; };
layout(std430) writeonly buffer Lit { float lit[]; };
uniform int base_index;
uniform uint light_index;

void main() {
  FlatBase base = flat_bases[base_index];
  ivec2 size = relief_fields[base.height].size;
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  Frame frame_of_field = flat_base_frame(base, instances[base.instance]);
  vec3 l = to_local(frame_of_field, light_centre_direction(lights[light_index], vec3(0.0)));
  BumpTexels texels = bump_texels(base.height);
  uint texel = uint(at.y * size.x + at.x);
  lit[base.first + texel] = bump_irradiance(texels, texel, bump_normal(texels, texel), l, bump_light(l));
}
