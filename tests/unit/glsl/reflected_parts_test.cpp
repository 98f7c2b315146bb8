// Reflected light in parts, and what shadows leave of it.
#include "glsl/surface/reflected_parts.glsl"

#include <gtest/gtest.h>

namespace limn {
namespace {

using glm::vec3;

TEST(ReflectedParts, SharesAreWhatIsMissing) {
  EXPECT_EQ(glsl::hidden_share(1.f, 4.f, 0.5f), 0.75f);
  EXPECT_EQ(glsl::hidden_share(0.f, 4.f, 0.5f), 1);
  EXPECT_EQ(glsl::hidden_share(4.0001f, 4.f, 0.5f), 0) << "rounding adds no light";
  EXPECT_EQ(glsl::hidden_share(0.f, 0.f, 0.5f), 0.5f);
}

TEST(ReflectedParts, PartsAreHiddenApart) {
  const glsl::ReflectedParts all{vec3(2, 4, 0), vec3(1, 0, 0)}, seen{vec3(1, 3, 0), vec3(0)},
      light{vec3(8), vec3(16)};
  const glsl::ReflectedParts hidden = glsl::hidden_parts(seen, all);
  EXPECT_EQ(hidden.diffuse, vec3(0.5f, 0.25f, 0));
  EXPECT_EQ(hidden.lobe, vec3(1, 0.25f, 0)) << "an empty lobe is hidden as the diffuse part is";
  EXPECT_EQ(glsl::reflected_left(light, hidden), vec3(4, 6 + 12, 24));
}

TEST(ReflectedParts, WhereNothingIsHiddenLightIsWholeToTheBit) {
  const glsl::ReflectedParts light{vec3(0.1f, 0.2f, 0.3f), vec3(0.7f, 1e-7f, 3e7f)};
  const vec3 left = glsl::reflected_left(light, glsl::hidden_parts(light, light));
  EXPECT_EQ(left, glsl::reflected_whole(light));
}

}  // namespace
}  // namespace limn
