// Shading normals from height maps, as the GPU and the reference both make them.
#ifndef LIMN_HEIGHT_NORMAL_GLSL
#define LIMN_HEIGHT_NORMAL_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/surface/normal_map.glsl"
LIMN_BEGIN

// World shading normal from the interpolated world normal and tangent, as for mapped_normal(), and the slopes of the
// height map (metres per metre, along rising u and v). The bitangent points up the texture, against v.
LIMN_FN vec3 height_normal(vec3 normal, vec4 tangent, vec2 slope) {
  return normal_from_frame(normal, tangent, vec3(-slope.x, slope.y, 1.0f));
}

LIMN_END
#endif  // LIMN_HEIGHT_NORMAL_GLSL
