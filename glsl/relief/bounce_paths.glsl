// How relief_maps::ReliefMapService stores where light from bump to bump comes from (Table::bounces): for each height map a
// plane of slopes, one of weights, and one for each path, of a word for each texel.
#ifndef LIMN_RELIEF_BOUNCE_PATHS_GLSL
#define LIMN_RELIEF_BOUNCE_PATHS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// One path to a texel.
struct BouncePath {
  uint texel;    // that its light comes from; bounce_sky: none
  float weight;  // over the largest among the paths to the same texel, [0, 1]
};

LIMN_CONST uint bounce_sky = 0xffffffu;  // and the least number that no texel may have
LIMN_CONST int bounce_slope_plane = 0;   // dz over metres along u and v, two halfs
LIMN_CONST int bounce_scale_plane = 1;   // a float: what makes the mean of the weights 1
LIMN_CONST int bounce_path_plane = 2;    // of the first path

LIMN_FN uint bounce_path_pack(BouncePath path) { return path.texel | (uint(path.weight * 255.0f + 0.5f) << 24); }
LIMN_FN BouncePath bounce_path_unpack(uint word) {
  BouncePath path;
  path.texel = word & 0xffffffu;
  path.weight = float(word >> 24) / 255.0f;
  return path;
}

// The path by which light goes on to texel `texel` that leaves it by path i: as even as the paths are, and another one in each
// texel.
LIMN_FN int bounce_next_path(int i, uint texel, int paths) {
  uint shift = (texel * 2654435769u) >> 8;
  return int((uint(i) * 1597u + shift) % uint(paths));
}

LIMN_END
#endif  // LIMN_RELIEF_BOUNCE_PATHS_GLSL
