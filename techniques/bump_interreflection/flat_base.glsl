// A flat surface under a height map, all of whose tiles look alike to light from far away.
#ifndef FLAT_BASE_GLSL
#define FLAT_BASE_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/scene/blocks.glsl"
LIMN_BEGIN

struct FlatBase {
  vec3 tangent;      // along rising u, in the object's space
  uint instance;     // draw instance
  vec3 normal;       // off the base, in the object's space
  int height;        // index of the height map
  uint left_handed;  // 1: tangent, rising v and normal are
  uint first;        // of its texels among those of all bases
  uint unused_0;
  uint unused_1;
};

// The frame of the field in world space, as pixel_relief() has it.
LIMN_FN Frame flat_base_frame(FlatBase base, Instance placed) {
  vec3 n = normalize(mat3(placed.normal_to_world) * base.normal);
  Frame f = frame_along(n, mat3(placed.object_to_world) * base.tangent);
  bool mirrored = (placed.flags & instance_mirrored) != 0u;
  if ((base.left_handed != 0u) != mirrored) f.b = -f.b;
  return f;
}

LIMN_END
#endif  // FLAT_BASE_GLSL
