// What trees of directions and lobes are built as they are against: axes that do not follow the surface, and
// wide light along it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/unit/radiosity/lobes.h"

namespace limn::radiosity {
namespace {

/// A surface whose horizon is no edge of cells splits those that it crosses, although a tree in other axes
/// holds but the part of its light that leaves above them.
TEST(TreeTraps, AxesThatDoNotFollowTheSurfaceTakeMoreCells) {
  TreeBuilder builder;
  DirectionalTree own, other;
  const glsl::Frame axes = glsl::frame_around(glm::vec3(0, 0, 1));
  double most = 0;
  for (const float roughness : {0.3f, 0.5f, 0.8f}) {
    const GlossyLobes lobes = lobesOf(roughness, {lightFrom(30)});
    builder.build(lobes, {}, own);
    for (const glm::vec3& normal : {glm::vec3(1, 2, 3), glm::vec3(1, 1, 0.2f), glm::vec3(0.3f, 0.1f, 1)}) {
      const TreePart part{&own, glsl::frame_around(glm::normalize(normal)), 1};
      builder.pull({&part, 1}, axes, {}, other);
      std::printf("roughness %.1f: %zu cells in axes of the surface, %zu in others\n", double(roughness),
                  own.cellCount(), other.cellCount());
      most = std::max(most, double(other.cellCount()) / double(own.cellCount()));
    }
  }
  EXPECT_GT(most, 1.5);
}

/// A square of 0.6 rad close to the horizon, as one sample.
TEST(TreeTraps, GrazingSamplesThatAreNotWidenedAreTooBright) {
  const auto square = [](int side) { return squareOfLights(80, side); };
  const auto brightest = [](const GlossyLobes& lobes) {
    float most = 0;
    for (int i = 0; i < 160; ++i)
      for (int j = 0; j < 160; ++j)
        most = std::max(
            most,
            lobes.radiance(glsl::sample_cosine((glm::vec2(float(i), float(j)) + glm::vec2(0.5f)) / 160.f)).x);
    return double(most);
  };
  for (const float roughness : {0.2f, 0.3f}) {
    const double exact = brightest(lobesOf(roughness, square(32)));
    const double plain = brightest(lobesOf(roughness, square(1))) / exact;
    const double widened = brightest(lobesOf(roughness, square(1), 0.22f)) / exact;
    std::printf("square at 80 degrees, roughness %.1f: %.1f times as bright, widened %.2f\n",
                double(roughness), plain, widened);
    EXPECT_GT(plain, 5);
    EXPECT_LT(widened, 2);
  }
}

}  // namespace
}  // namespace limn::radiosity
