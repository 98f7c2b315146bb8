// One bounce from texel to texel of a flat base: the mean by weight of what its paths meet, for white bumps.
#include "techniques/bump_interreflection/bump_texels.glsl"
#include "techniques/bump_interreflection/flat_base.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) readonly buffer FlatBases { FlatBase flat_bases[]; };
layout(std430) readonly buffer Sent { float sent[]; };
layout(std430) writeonly buffer Gathered { float gathered[]; };
uniform int base_index;

void main() {
  FlatBase base = flat_bases[base_index];
  ivec2 size = relief_fields[base.height].size;
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  BumpTexels texels = bump_texels(base.height);
  uint texel = uint(at.y * size.x + at.x);
  float sum = 0.0;
  int i = 0;
  do {  // the condition comes last: software renderers run a loop's body once more where it comes first
    BouncePath path = bounce_path(texels, texel, i);
    if (path.texel != bounce_sky) sum += path.weight * sent[base.first + path.texel];
  } while (++i < paths);
  gathered[base.first + texel] = sum / float(paths);
}
