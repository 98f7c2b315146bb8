// How trees are made: what they keep of lobes and functions, and what they cost.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "core/base/error.h"
#include "tests/unit/glsl/random.h"
#include "tests/unit/radiosity/lobes.h"

namespace limn::radiosity {
namespace {

using Criterion = TreeSettings::Criterion;

TEST(TreeBuilder, MeetsTheErrorThatIsAskedFor) {
  TreeBuilder builder;
  DirectionalTree tree;
  for (const float roughness : {0.3f, 0.5f}) {
    const GlossyLobes lobes = lobesOf(roughness, {lightFrom(45)});
    for (const float error : {0.05f, 0.1f, 0.2f}) {
      for (const bool frozen : {false, true}) {
        builder.build(lobes, {.error = error, .frozen = frozen}, tree);
        EXPECT_LE(builder.estimatedError(), double(error));
        EXPECT_NEAR(errorOf(tree, lobes), double(error), 0.2 * double(error)) << roughness << " " << frozen;
      }
    }
  }
}

/// Lights of about the same strength from all around, or from a patch of 0.6 rad.
std::vector<glsl::IncidentLight> manyLights(bool compact) {
  glsl::Random random(7);
  const glsl::Frame patch = glsl::frame_around(lightFrom(45).direction);
  std::vector<glsl::IncidentLight> lights;
  for (int i = 0; i < 32; ++i) {
    const glm::vec2 u(random(0, 1), random(0, 1));
    const glm::vec3 way = patch.n + 0.6f * (u.x - 0.5f) * patch.t + 0.6f * (u.y - 0.5f) * patch.b;
    lights.push_back({compact ? glm::normalize(way) : glsl::sample_cosine(u), 0, glm::vec3(random(1, 2))});
  }
  return lights;
}

/// What a tree costs, and how good it is.
struct Tree {
  size_t cells;
  double error;
  uint64_t evaluations;
};
Tree treeOf(const GlossyLobes& lobes, const TreeSettings& settings) {
  TreeBuilder builder;
  DirectionalTree tree;
  builder.build(lobes, settings, tree);
  return {tree.cellCount(), errorOf(tree, lobes), builder.evaluations()};
}
void print(const char* what, float roughness, const Tree& tree) {
  std::printf("%s, roughness %.1f: %zu cells, error %.3f, %llu evaluations\n", what, double(roughness),
              tree.cells, tree.error, static_cast<unsigned long long>(tree.evaluations));
}

/// One lobe to an L2 error of 0.1: what each way to refine takes.
TEST(TreeBuilder, CellsOfOneLobe) {
  struct Row {
    float roughness, publishedThreshold;
    int level;         // of all cells, the first below 0.1
    size_t byError;    // at most
    double published;  // times as many cells, at least
  };
  for (const Row& row :
       {Row{0.5f, 0.55f, 4, 240, 2.5}, Row{0.3f, 0.56f, 6, 360, 6}, Row{0.2f, 0.6f, 7, 410, 10}}) {
    const GlossyLobes lobes = lobesOf(row.roughness, {lightFrom(45)});
    const Tree byError = treeOf(lobes, {.frozen = false});
    const Tree published = treeOf(
        lobes,
        {.criterion = Criterion::relative, .error = row.publishedThreshold, .maxLevel = 9, .frozen = false});
    const Tree uniform = treeOf(lobes, levelOnly(row.level));
    print("by error", row.roughness, byError);
    print("published", row.roughness, published);
    print("one level", row.roughness, uniform);
    EXPECT_LT(byError.error, 0.105);
    EXPECT_LE(byError.cells, row.byError);
    EXPECT_LT(published.error, 0.105);
    EXPECT_GT(double(published.cells), row.published * double(byError.cells));
    EXPECT_LT(uniform.error, 0.1);
    EXPECT_GT(treeOf(lobes, levelOnly(row.level - 1)).error, 0.1);
  }
}

/// 32 lobes in all directions to an L2 error of 0.11.
TEST(TreeBuilder, CellsOfManyLobes) {
  struct Row {
    float roughness;
    double published, publishedError;  // the published test misses peaks of the narrower lobes
  };
  for (const Row& row : {Row{0.3f, 5, 0.11}, Row{0.2f, 6, 0.17}}) {
    const GlossyLobes lobes = lobesOf(row.roughness, manyLights(false));
    const Tree byError = treeOf(lobes, {.error = 0.11f, .frozen = false});
    const Tree published =
        treeOf(lobes, {.criterion = Criterion::relative, .error = 0.5f, .maxLevel = 9, .frozen = false});
    print("many, by error", row.roughness, byError);
    print("many, published", row.roughness, published);
    EXPECT_LT(byError.error, 0.116);
    EXPECT_LT(published.error, row.publishedError);
    EXPECT_GT(double(published.cells), row.published * double(byError.cells));
  }
}

TEST(TreeBuilder, FindsPeaksFromAnyDirection) {
  // Without the peaks' rule the tree of a light may miss it wholly.
  for (const float roughness : {0.15f, 0.2f, 0.3f})
    for (const float degrees : {0.f, 11.f, 23.f, 37.f, 52.f, 68.f}) {
      const GlossyLobes lobes = lobesOf(roughness, {lightFrom(degrees)});
      EXPECT_LT(treeOf(lobes, {.maxLevel = 9}).error, 0.12) << roughness << " " << degrees;
    }
}

TEST(TreeBuilder, SmoothValuesHaveLessError) {
  TreeBuilder builder;
  DirectionalTree tree;
  for (const float roughness : {0.2f, 0.3f, 0.5f}) {
    const GlossyLobes lobes = lobesOf(roughness, {lightFrom(45)});
    for (const float error : {0.2f, 0.1f}) {
      builder.build(lobes, {.error = error}, tree);
      const double cells = errorOf(tree, lobes);
      const double taps =
          errorOf([&](const glm::vec3& w) { return tree.smoothValue(w); }, radianceOf(lobes), 256);
      std::printf("smooth, roughness %.1f: %.3f, cells %.3f\n", double(roughness), taps, cells);
      EXPECT_LT(taps, (error > 0.15f ? 0.75 : 0.55) * cells);
    }
  }
}

TEST(TreeBuilder, FrozenLobesSaveEvaluations) {
  struct Row {
    float roughness;
    bool compact;
    double saving;
  };
  for (const Row& row : {Row{0.5f, false, 1.3}, Row{0.3f, false, 3.4}, Row{0.2f, false, 8},
                         Row{0.5f, true, 1.2}, Row{0.3f, true, 1.4}, Row{0.2f, true, 1.9}}) {
    const GlossyLobes lobes = lobesOf(row.roughness, manyLights(row.compact));
    const Tree all = treeOf(lobes, {.frozen = false}), frozen = treeOf(lobes, {});
    print(row.compact ? "compact, frozen" : "spread, frozen", row.roughness, frozen);
    EXPECT_GT(double(all.evaluations), row.saving * double(frozen.evaluations));
    EXPECT_LT(frozen.error, 1.08 * all.error);
    EXPECT_LE(double(frozen.cells), 1.05 * double(all.cells));
  }
}

TEST(TreeBuilder, DisplayMeetsErrorsOfDarkDirections) {
  const GlossyLobes lobes = lobesOf(0.3f, {lightFrom(45)});
  TreeBuilder builder;
  DirectionalTree tree, transport;
  builder.build(lobes, {.criterion = Criterion::display}, tree);
  builder.build(lobes, {}, transport);
  EXPECT_LE(builder.estimatedError(), 0.1);
  const double mean = double(glsl::luminance(lobes.flux())) / double(glsl::pi);
  const auto relative = [&](const DirectionalTree& of) {
    double sum = 0;
    constexpr int kSide = 200;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const glm::vec3 w =
            glsl::sample_cosine((glm::vec2(float(i), float(j)) + glm::vec2(0.5f)) / float(kSide));
        const double exact = double(glsl::luminance(lobes.radiance(w)));
        const double off = double(glsl::luminance(of.value(w))) - exact;
        sum += off * off / (exact * exact + 0.1 * mean * mean);
      }
    return std::sqrt(sum) / kSide;
  };
  std::printf("display: %zu cells, %.3f; transport: %zu cells, %.3f\n", tree.cellCount(), relative(tree),
              transport.cellCount(), relative(transport));
  EXPECT_LT(relative(tree), 0.12);
  EXPECT_LT(relative(tree), 0.7 * relative(transport));
}

TEST(TreeBuilder, KeepsAConstant) {
  TreeBuilder builder;
  DirectionalTree tree;
  builder.build([](const glm::vec3&) { return glm::vec3(1, 2, 3); }, {}, tree);
  EXPECT_EQ(tree.cellCount(), 64u);  // the horizon adds none
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(tree.flux()[c], float(c + 1) * glsl::pi, 2e-5f * float(c + 1));
}

/// Light that ends at the horizon, as that of surfaces does: cells along it are not split for its end.
TEST(TreeBuilder, TakesTheHorizonForNoEdge) {
  TreeBuilder builder;
  DirectionalTree tree;
  const auto light = [](const glm::vec3& w) { return w.z > 0 ? glm::vec3(1, 2, 3) : glm::vec3(0); };
  builder.build(light, {}, tree);
  EXPECT_EQ(tree.cellCount(), 64u);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(tree.flux()[c], float(c + 1) * glsl::pi, 2e-5f * float(c + 1));
}

TEST(TreeBuilder, StandsExtremes) {
  TreeBuilder builder;
  DirectionalTree tree;
  for (const float roughness : {0.f, 0.05f, 0.1f, 1.f})
    for (const float light : {1e-12f, 1.f, 1e12f})
      for (const TreeSettings& settings :
           {TreeSettings{}, TreeSettings{.error = 0.5f}, TreeSettings{.maxLevel = 2},
            TreeSettings{.minLevel = 0, .maxLevel = 0}, TreeSettings{.criterion = Criterion::display},
            uniformBasis(3), uniformBasis(0),
            TreeSettings{.criterion = Criterion::relative, .error = 0.5f, .maxLevel = 5}}) {
        const GlossyLobes lobes =
            lobesOf(roughness, {lightFrom(0, glm::vec3(light)), lightFrom(89.9f, glm::vec3(light)),
                                lightFrom(100, glm::vec3(light)), lightFrom(50, glm::vec3(0))});
        ASSERT_EQ(lobes.size(), 2u);
        builder.build(lobes, settings, tree);
        ASSERT_LT(tree.cellCount(), 20000u);
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(tree.flux()[c], lobes.flux()[c], 2e-5f * lobes.flux()[c]) << roughness;
        for (const auto& node : tree.nodes()) ASSERT_TRUE(std::isfinite(node.value.x) && node.value.x >= 0);
      }
}

/// Cells are counted while they are made: an error may ask for more of them than memory holds.
TEST(TreeBuilder, TreesThatTakeTooMuchMemoryAreRefused) {
  TreeBuilder builder;
  DirectionalTree tree;
  const GlossyLobes lobes = lobesOf(0.3f, {lightFrom(45)});
  for (const Criterion criterion : {Criterion::transport, Criterion::relative}) {
    const TreeSettings asked{
        .criterion = criterion, .error = 1e-3f, .maxLevel = 10, .memory = uint64_t{1} << 20};
    EXPECT_THROW(builder.build(lobes, asked, tree), UsageError);
    builder.build(lobes, {.error = 0.2f}, tree);
    EXPECT_NEAR(errorOf(tree, lobes), 0.2, 0.04);
  }
}

TEST(TreeBuilder, OneLevelLosesNarrowLobes) {
  // What is scaled away: 1024 cells hold but a part of a lobe of roughness 0.1.
  const GlossyLobes lobes = lobesOf(0.1f, {lightFrom(45)});
  TreeBuilder builder;
  DirectionalTree tree;
  builder.build(radianceOf(lobes), levelOnly(4), tree);
  const float kept = tree.flux().x / lobes.flux().x;
  std::printf("1024 cells keep %.2f of the energy\n", double(kept));
  EXPECT_LT(kept, 0.6f);
  builder.build(lobes, levelOnly(4), tree);
  EXPECT_NEAR(tree.flux().x / lobes.flux().x, 1, 1e-5f);
}

TEST(GlossyLobes, WideningStandsForASquare) {
  // A square of 0.6 rad as one sample: relative L2 errors as they are, and widened.
  struct Row {
    float roughness;
    double plain, widened;
  };
  const auto square = [](int side) { return squareOfLights(40, side); };
  for (const Row& row :
       {Row{0.1f, 10.8, 0.53}, Row{0.2f, 2.9, 0.41}, Row{0.3f, 1.2, 0.27}, Row{0.5f, 0.25, 0.085}}) {
    const GlossyLobes exact = lobesOf(row.roughness, square(row.roughness < 0.15f ? 64 : 32));
    const GlossyLobes plain = lobesOf(row.roughness, square(1)),
                      widened = lobesOf(row.roughness, square(1), 0.22f);
    const double plainError = errorOf(radianceOf(plain), radianceOf(exact), 120);
    const double widenedError = errorOf(radianceOf(widened), radianceOf(exact), 120);
    std::printf("square, roughness %.1f: %.2f, widened %.3f; energy %.3f\n", double(row.roughness),
                plainError, widenedError, double(widened.flux().x / exact.flux().x));
    EXPECT_NEAR(plainError, row.plain, 0.15 * row.plain);
    EXPECT_NEAR(widenedError, row.widened, 0.15 * row.widened);
    EXPECT_NEAR(widened.flux().x / exact.flux().x, 1, 0.01f);
  }
}

TEST(GlossyLobes, KeepTheirEnergyWhenWidened) {
  for (const float degrees : {0.f, 45.f, 75.f})
    for (const float spread : {0.2f, 0.6f, 1.5f}) {
      const GlossyLobes plain = lobesOf(0.2f, {lightFrom(degrees, glm::vec3(1), spread)});
      const GlossyLobes widened = lobesOf(0.2f, {lightFrom(degrees, glm::vec3(1), spread)}, 0.22f);
      EXPECT_GT(widened.alpha(0), plain.alpha(0));
      EXPECT_FLOAT_EQ(widened.flux().x, plain.flux().x);
      TreeBuilder builder;
      DirectionalTree tree;  // not scaled
      builder.build(radianceOf(widened), {.error = 0.02f}, tree);
      EXPECT_NEAR(tree.flux().x, widened.flux().x, 0.02f * widened.flux().x) << degrees << " " << spread;
    }
}

TEST(GlossyLobes, AreTheBrdf) {
  glsl::Random random(5);
  for (const float roughness : {0.05f, 0.3f, 1.f}) {
    const glsl::SurfaceBrdf surface = glsl::surface_brdf(glm::vec3(0.9f, 0.5f, 0.2f), 0.4f, roughness, 0.8f,
                                                         glm::vec3(1, 0.7f, 0.6f), 1.6f);
    for (int i = 0; i < 200; ++i) {
      glsl::IncidentLight light{random.direction(), 0, {1, 2, 3}};
      glm::vec3 w = random.direction();
      light.direction.z = std::abs(light.direction.z) + 1e-3f;
      light.direction = glm::normalize(light.direction);
      w.z = std::abs(w.z) + 1e-3f;
      w = glm::normalize(w);
      GlossyLobes lobes;
      lobes.set(surface, {&light, 1}, 0);
      const glm::vec3 exact = glsl::brdf_parts(surface, glm::vec3(0, 0, 1), w, light.direction).specular *
                              light.irradiance * light.direction.z;
      const glm::vec3 found = lobes.radiance(w);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], exact[c], 2e-4f * exact[c] + 1e-6f) << roughness;
    }
  }
}

/// The gloss of bright paint matters less than that of metal.
TEST(TreeBuilder, LightBesideLobesTakesCellsFromThem) {
  const GlossyLobes lobes = lobesOf(0.3f, {lightFrom(40)});
  TreeBuilder builder;
  DirectionalTree alone, beside, faint;
  builder.build(lobes, {}, alone);
  builder.build(lobes, {}, beside, 0.5f);
  builder.build(lobes, {}, faint, 100);
  std::printf("cells of a lobe: %zu alone, %zu beside 0.5, %zu beside 100\n", alone.cellCount(),
              beside.cellCount(), faint.cellCount());
  EXPECT_LT(beside.cellCount(), alone.cellCount());
  EXPECT_EQ(faint.cellCount(), 4u);
  for (const DirectionalTree* tree : {&alone, &beside, &faint})
    EXPECT_NEAR(tree->flux().x, lobes.flux().x, 1e-4f * lobes.flux().x);
  // The error is that of all light.
  double error = 0, light = 0;
  glsl::Random random(14);
  for (int i = 0; i < 40000; ++i) {
    const glm::vec3 w = glsl::sample_cosine({random(0, 1), random(0, 1)});
    const double exact = double(lobes.radiance(w).x), off = double(beside.value(w).x) - exact;
    error += off * off;
    light += (exact + 0.5) * (exact + 0.5);
  }
  EXPECT_LT(std::sqrt(error / light), 0.11);
}

}  // namespace
}  // namespace limn::radiosity
