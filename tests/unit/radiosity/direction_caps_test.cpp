// Coarse bounds of light by directions.
#include "core/radiosity/direction_caps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/glsl/random.h"
#include "tests/unit/radiosity/lobes.h"

namespace limn::radiosity {
namespace {

TEST(DirectionCaps, HoldForEveryTreeInEveryDirectionOfACone) {
  glsl::Random random(12);
  const DirectionalTree trees[] = {glossyTree(), glossyTree(0.5f)};
  const glsl::Frame frames[] = {glsl::frame_around(random.direction()),
                                glsl::frame_around(random.direction())};
  DirectionCaps caps, first;
  first.include(trees[0], frames[0]);
  caps.include(trees[1], frames[1]);
  caps.include(first);
  int dark = 0;
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 axis = random.direction();
    const float angle = random(0.01f, 1.5f), most = caps.most(axis, std::cos(angle));
    if (first.most(axis, std::cos(angle)) == 0) ++dark;
    const glsl::Frame around = glsl::frame_around(axis);
    for (int k = 0; k < 300; ++k) {
      const float off = angle * std::sqrt(random(0, 0.999f)), turn = random(0, 2 * glsl::pi);
      const glm::vec3 w = glsl::from_local(
          around, {std::sin(off) * std::cos(turn), std::sin(off) * std::sin(turn), std::cos(off)});
      for (int t = 0; t < 2; ++t) {
        const glm::vec3 local = glsl::to_local(frames[t], w);
        if (!(local.z > 0)) continue;
        ASSERT_GE(most, trees[t].value(local).x);
      }
    }
  }
  EXPECT_GT(dark, 0);  // directions that the tree sends no light to
  caps.clear();
  EXPECT_EQ(caps.most({0, 0, 1}, -1), 0);
}

TEST(DirectionCaps, HoldForTheUniformBasis) {
  glsl::Random random(13);
  const GlossyLobes lobes = lobesOf(0.3f, {lightFrom(40)});
  TreeBuilder builder;
  DirectionalTree tree;
  builder.build(lobes, uniformBasis(4), tree);
  const glsl::Frame frame = glsl::frame_around(random.direction());
  DirectionCaps caps;
  caps.include(tree, frame);
  for (int i = 0; i < 3000; ++i) {
    const glm::vec3 w = random.direction(), local = glsl::to_local(frame, w);
    if (!(local.z > 0)) continue;
    ASSERT_GE(caps.most(w, 0.9999f), tree.value(local).x);
  }
}

}  // namespace
}  // namespace limn::radiosity
