// Light over directions as trees: what they hold, and what is done with them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "glsl/indirect/packed_tree.glsl"
#include "tests/unit/glsl/random.h"
#include "tests/unit/radiosity/lobes.h"

namespace limn::radiosity {
namespace {

TEST(DirectionalTree, KeepsTheFluxOfLobes) {
  TreeBuilder builder;
  DirectionalTree tree;
  for (const float roughness : {0.1f, 0.3f, 1.f}) {
    const GlossyLobes lobes = lobesOf(roughness, {lightFrom(30), lightFrom(70, {0.1f, 2, 1})});
    builder.build(lobes, {}, tree);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(tree.flux()[c], lobes.flux()[c], 1e-5f * lobes.flux()[c]) << roughness;
  }
}

/// A red and a blue lobe of the same strength share one tree, whose cells follow the luminance of both. To it
/// blue is 0.34 as strong as red: where all of its error of 0.1 lies in one of them, red errs by 0.1 sqrt(1 +
/// 0.34^2), blue by 0.1 sqrt(1 + 1 / 0.34^2). Cells of equal errors leave blue sqrt(1 / 0.34) = 1.7 times
/// red's.
TEST(DirectionalTree, IsRefinedByTheLuminanceOfAllColours) {
  const GlossyLobes lobes = lobesOf(0.3f, {lightFrom(20, {1, 0, 0}), lightFrom(60, {0, 0, 1})});
  TreeBuilder builder;
  DirectionalTree tree;
  builder.build(lobes, {}, tree);
  const auto errorOfColour = [&](int c) {
    return errorOf([&](const glm::vec3& w) { return glm::vec3(tree.value(w)[c]); },
                   [&](const glm::vec3& w) { return glm::vec3(lobes.radiance(w)[c]); }, 256);
  };
  const double all = errorOf(tree, lobes), red = errorOfColour(0), blue = errorOfColour(2);
  std::printf("red and blue: error %.4f of luminance, %.4f of red, %.4f of blue; cells %zu\n", all, red, blue,
              tree.cellCount());
  EXPECT_LE(all, 0.105) << "red " << red << ", blue " << blue;
  EXPECT_LE(red, 0.106) << "luminance " << all << ", blue " << blue;
  EXPECT_LE(blue, 0.31) << "luminance " << all << ", red " << red;
  EXPECT_GT(blue, 1.2 * red) << "luminance " << all;
  EXPECT_EQ(tree.flux().y, 0);
}

TEST(DirectionalTree, IsZeroBelowTheHorizonAndWithoutLight) {
  const DirectionalTree tree = glossyTree(), none;
  EXPECT_EQ(tree.value({0.1f, 0.2f, -0.9f}), glm::vec3(0));
  EXPECT_EQ(tree.smoothValue({0.1f, 0.2f, -0.9f}), glm::vec3(0));
  EXPECT_GT(tree.value({0.1f, 0.2f, 0.001f}).x, 0);
  EXPECT_EQ(none.value({0, 0, 1}), glm::vec3(0));
  EXPECT_EQ(none.flux(), glm::vec3(0));
  EXPECT_EQ(none.bounds({0, 0, 1}, 0).high, glm::vec3(0));
  EXPECT_EQ(none.cellCount(), 0u);
  TreeBuilder builder;
  DirectionalTree built = glossyTree();
  builder.build(GlossyLobes(), {}, built);
  EXPECT_TRUE(built.empty());
}

TEST(DirectionalTree, BoundsHoldForEveryDirectionOfACone) {
  const DirectionalTree tree = glossyTree();
  glsl::Random random(11);
  double tightness = 0;
  for (int i = 0; i < 300; ++i) {
    glm::vec3 axis = random.direction();
    axis.z = std::abs(axis.z);
    const float angle = random(0.01f, 0.8f);
    const DirectionBounds bounds = tree.bounds(axis, std::cos(angle));
    const glsl::Frame frame = glsl::frame_around(axis);
    float most = 0;
    for (int k = 0; k < 300; ++k) {
      const float off = angle * std::sqrt(random(0, 0.999f)), turn = random(0, 2 * glsl::pi);
      const glm::vec3 w = glsl::from_local(
          frame, {std::sin(off) * std::cos(turn), std::sin(off) * std::sin(turn), std::cos(off)});
      if (!(w.z > 0)) continue;
      const glm::vec3 value = tree.value(w);
      most = std::max(most, value.x);
      for (int c = 0; c < 3; ++c) {
        ASSERT_LE(bounds.low[c], value[c]);
        ASSERT_GE(bounds.high[c], value[c]);
      }
    }
    tightness += double(bounds.high.x / std::max(most, 1e-20f)) / 300;
  }
  EXPECT_LT(tightness, 1.4);  // 300 directions do not find all there is
}

TEST(DirectionalTree, SumsAndScalesAreThoseOfTheFunctions) {
  DirectionalTree a = glossyTree(0.3f);
  const DirectionalTree b = glossyTree(0.5f), before = a;
  a.add(b, 0.25f);
  a.scale({1, 2, 3});
  glsl::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 w = random.direction();
    const glm::vec3 expected = (before.value(w) + 0.25f * b.value(w)) * glm::vec3(1, 2, 3);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.value(w)[c], expected[c], 1e-5f * expected[c]);
  }
  const glm::vec3 flux = (before.flux() + 0.25f * b.flux()) * glm::vec3(1, 2, 3);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.flux()[c], flux[c], 1e-5f * flux[c]);
  DirectionalTree sum;
  sum.add(b, 2);
  EXPECT_EQ(sum.flux(), 2.f * b.flux());
}

TEST(DirectionalTree, InnerCellsAreMeansByProjectedAngle) {
  const DirectionalTree tree = glossyTree();
  // The flux by value() against that of the faces.
  double sum = 0;
  constexpr int kSide = 1024;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j)
      sum += double(
          tree.value(glsl::sample_cosine((glm::vec2(float(i), float(j)) + glm::vec2(0.5f)) / float(kSide)))
              .x);
  const double flux = sum * double(glsl::pi) / (kSide * kSide);
  EXPECT_NEAR(double(tree.flux().x), flux, 1e-3 * flux);
}

TEST(DirectionalTree, PullsKeepTheFlux) {
  const DirectionalTree first = glossyTree(0.3f), second = glossyTree(0.5f), dark;
  TreeBuilder builder;
  DirectionalTree pulled;
  const auto frameAt = [](float angle) {
    return glsl::frame_around(glm::normalize(glm::vec3(std::sin(angle), 0.1f, std::cos(angle))));
  };
  // In one frame cells are merged, in others light is sampled again.
  for (const float tilt : {0.f, 0.05f, 0.2f}) {
    const TreePart parts[] = {{&first, frameAt(0), 1}, {&second, frameAt(tilt), 3}, {&dark, frameAt(1), 4}};
    builder.pull(parts, frameAt(0), {}, pulled);
    const glm::vec3 flux = (first.flux() + 3.f * second.flux()) / 8.f;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(pulled.flux()[c], flux[c], 1e-5f * flux[c]) << tilt;
  }
  const TreePart dim[] = {{&dark, frameAt(0), 1}};
  builder.pull(dim, frameAt(0), {}, pulled);
  EXPECT_TRUE(pulled.empty());
}

TEST(DirectionalTree, PullsIntoATurnedFrameKeepTheLight) {
  const DirectionalTree tree = glossyTree();
  const glsl::Frame from = glsl::frame_around(glm::vec3(0, 0, 1));
  const glsl::Frame to = glsl::frame_turned(glm::vec3(0, 0, 1), 0.15f);
  const TreePart parts[] = {{&tree, from, 1}};
  TreeBuilder builder;
  DirectionalTree pulled;
  builder.pull(parts, to, {}, pulled);
  const double error = errorOf([&](const glm::vec3& w) { return pulled.value(glsl::to_local(to, w)); },
                               [&](const glm::vec3& w) { return tree.value(w); }, 256);
  std::printf("turned pull: error %.3f, cells %zu of %zu\n", error, pulled.cellCount(), tree.cellCount());
  EXPECT_LT(error, 0.16);
}

TEST(UniformBasis, IsLinearBetweenCorners) {
  const GlossyLobes lobes = lobesOf(0.5f, {lightFrom(20), lightFrom(60, {2, 1, 0.5f})});
  TreeBuilder builder;
  DirectionalTree tree, cells;
  double last = 1;
  for (int level = 2; level <= 6; ++level) {
    builder.build(lobes, uniformBasis(level), tree);
    builder.build(lobes, levelOnly(level), cells);
    EXPECT_EQ(tree.cellCount(), cells.cellCount());
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(tree.flux()[c], lobes.flux()[c], 1e-5f * lobes.flux()[c]);
    const double error = errorOf(tree, lobes);
    EXPECT_LT(error, (level == 2 ? 1.0 : 0.4) * last);  // about a quarter
    EXPECT_LT(error, (level == 2 ? 1.2 : level == 3 ? 0.8 : 0.5) * errorOf(cells, lobes));
    std::printf("uniform, level %d: error %.4f, of cells %.4f\n", level, error, errorOf(cells, lobes));
    last = error;
  }
  // The flux by value() against that of the corners.
  builder.build(lobes, uniformBasis(5), tree);
  double sum = 0;
  constexpr int kSide = 256;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j)
      sum += double(
          tree.value(glsl::sample_cosine((glm::vec2(float(i), float(j)) + glm::vec2(0.5f)) / float(kSide)))
              .x);
  const double flux = sum * double(glsl::pi) / (kSide * kSide);
  EXPECT_NEAR(double(tree.flux().x), flux, 3e-3 * flux);
}

TEST(UniformBasis, HasTheSameOperations) {
  const GlossyLobes lobes = lobesOf(0.3f, {lightFrom(20), lightFrom(60, {2, 1, 0.5f})});
  TreeBuilder builder;
  DirectionalTree tree, pulled;
  builder.build(lobes, uniformBasis(4), tree);
  std::vector<glm::uvec2> nodes;
  const float scale = tree.pack(nodes);
  EXPECT_EQ(nodes.size(), (2 * 16 * 17 + 1 + 1) / 2u);
  glsl::Random random(6);
  for (int i = 0; i < 500; ++i) {
    glm::vec3 axis = random.direction(), w = random.direction();
    axis.z = std::abs(axis.z);
    w.z = std::abs(w.z);
    const glm::vec3 value = tree.value(w);
    const DirectionBounds bounds = tree.bounds(axis, glm::dot(w, axis) - 1e-4f);
    const glm::vec3 packed = scale * glsl::packed_grid_value(nodes.data(), 16, w);
    for (int c = 0; c < 3; ++c) {
      ASSERT_LE(bounds.low[c], value[c] * 1.00001f);
      ASSERT_GE(bounds.high[c], value[c] * 0.99999f);
      ASSERT_NEAR(packed[c], value[c], 0.003f * std::max({value.x, value.y, value.z}));
    }
  }
  const glsl::Frame up = glsl::frame_around(glm::vec3(0, 0, 1));
  const glsl::Frame turned = glsl::frame_turned(glm::vec3(0, 0, 1), 0.1f);
  const TreePart parts[] = {{&tree, up, 1}, {&tree, turned, 1}};
  builder.pull(parts, up, uniformBasis(4), pulled);
  EXPECT_TRUE(pulled.uniform());
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(pulled.flux()[c], tree.flux()[c], 1e-5f * tree.flux()[c]);
  const TreePart same[] = {{&tree, up, 1}, {&tree, up, 2}};
  builder.pull(same, up, uniformBasis(4), pulled);
  EXPECT_NEAR(pulled.value({0.1f, 0.2f, 0.9f}).x, tree.value({0.1f, 0.2f, 0.9f}).x, 1e-6f);
}

TEST(PackedTree, IsTheTree) {
  for (const float light : {1e-20f, 1.f, 1e20f}) {
    DirectionalTree tree = glossyTree();
    tree.scale(glm::vec3(light));
    std::vector<glm::uvec2> nodes(7);  // of other trees
    const float scale = tree.pack(nodes);
    ASSERT_EQ(nodes.size(), 7 + tree.nodes().size());
    glsl::Random random(4);
    for (int i = 0; i < 2000; ++i) {
      glm::vec3 w = random.direction();
      w.z = std::abs(w.z);
      float edge = 0;
      const glm::uvec2 cell = glsl::packed_tree_cell(nodes.data() + 7, w, edge);
      const glm::vec3 found[] = {scale * glsl::shared_exponent_decode(cell.y),
                                 scale * glsl::packed_tree_value(nodes.data() + 7, w)};
      const glm::vec3 exact[] = {tree.value(w), tree.smoothValue(w)};
      for (int k = 0; k < 2; ++k)
        for (int c = 0; c < 3; ++c) {
          const float largest = std::max({exact[k].x, exact[k].y, exact[k].z});
          ASSERT_NEAR(found[k][c], exact[k][c], 1.01f / 512 * largest) << light;
        }
    }
  }
}

}  // namespace
}  // namespace limn::radiosity
