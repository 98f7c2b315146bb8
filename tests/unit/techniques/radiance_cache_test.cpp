// Where the radiance cache of subtractive_shadows keeps normals.
#include <gtest/gtest.h>

#include <cmath>

#include "techniques/subtractive_shadows/cache_place.glsl"

namespace limn::glsl {
namespace {

constexpr float kCorners[] = {1, 1.1f, 1.6f, 4};  // 0, 25, 51 and 76 degrees from the view axis

TEST(RadianceCachePlace, IsTheInverseOfTheNormalOfATexel) {
  for (const float corner : kCorners) {
    const float reach = cache_reach(corner);
    for (const vec3 towards : {vec3(0, 0, 1), vec3(0, 0, -1), normalize(vec3(1, -2, 0.5f))}) {
      for (const ivec2 texel : {ivec2(0, 64), ivec2(64, 64), ivec2(40, 90), ivec2(127, 63)}) {
        const vec3 n = cache_normal(texel, towards, reach);
        EXPECT_NEAR(length(n), 1, 1e-5f);
        const vec2 place = cache_place(n, towards, reach) * float(cache_size);
        EXPECT_NEAR(place.x, static_cast<float>(texel.x) + 0.5f, 1e-2f);
        EXPECT_NEAR(place.y, static_cast<float>(texel.y) + 0.5f, 1e-2f);
      }
    }
  }
}

/// A surface that is seen edge-on at the picture's corner.
TEST(RadianceCachePlace, NormalsOfSurfacesThatAreSeenLieInside) {
  for (const float corner : kCorners) {
    const float cosine = 1 / corner, sine = std::sqrt(1 - cosine * cosine);
    const vec2 place = cache_place(vec3(cosine, 0, -sine), vec3(0, 0, 1), cache_reach(corner));
    EXPECT_LE(std::abs(place.x - 0.5f), 0.5f);
    EXPECT_NEAR(std::max(std::abs(place.x - 0.5f), std::abs(place.y - 0.5f)), 0.5f - 0.5f / float(cache_size),
                1e-4f);
  }
}

TEST(RadianceCachePlace, NormalsThatAreNotSeenAreFinite) {
  for (const vec3 n : {vec3(0, 0, -1), normalize(vec3(1e-6f, 0, -1))}) {
    const vec2 place = cache_place(n, vec3(0, 0, 1), cache_reach(1.2f));
    EXPECT_TRUE(std::isfinite(place.x) && std::isfinite(place.y));
  }
}

}  // namespace
}  // namespace limn::glsl
