// Light over directions as trees: what they keep of lobes and functions, and what they cost.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "core/radiosity/tree_builder.h"
#include "glsl/indirect/packed_tree.glsl"
#include "glsl/materials/model.glsl"
#include "glsl/numeric/srgb.glsl"
#include "tests/unit/glsl/random.h"

namespace limn::radiosity {
namespace {

using Criterion = TreeSettings::Criterion;
using Function = TreeBuilder::Function;

glsl::SurfaceBrdf metal(float roughness) {
  return glsl::surface_brdf(glm::vec3(0.75f), 1, roughness, 1, glm::vec3(1), 1.5f);
}

glsl::IncidentLight lightFrom(float degrees, const glm::vec3& irradiance = glm::vec3(1), float spread = 0) {
  const float angle = degrees * glsl::pi / 180;
  return {{std::sin(angle) * std::cos(0.7f), std::sin(angle) * std::sin(0.7f), std::cos(angle)},
          spread,
          irradiance};
}

GlossyLobes lobesOf(float roughness, const std::vector<glsl::IncidentLight>& lights, float widen = 0) {
  GlossyLobes lobes;
  lobes.set(metal(roughness), lights, widen);
  return lobes;
}

Function radianceOf(const GlossyLobes& lobes) {
  return [&lobes](const glm::vec3& w) { return lobes.radiance(w); };
}

/// The relative L2 error over the hemisphere, weighted by the cosine.
double errorOf(const Function& tree, const Function& truth, int n) {
  double error = 0, power = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const glm::vec3 w = glsl::sample_cosine((glm::vec2(float(i), float(j)) + glm::vec2(0.5f)) / float(n));
      const double exact = double(glsl::luminance(truth(w))), found = double(glsl::luminance(tree(w)));
      error += (found - exact) * (found - exact);
      power += exact * exact;
    }
  return std::sqrt(error / power);
}
double errorOf(const DirectionalTree& tree, const GlossyLobes& lobes, int n = 256) {
  return errorOf([&](const glm::vec3& w) { return tree.value(w); }, radianceOf(lobes), n);
}

/// What is not refined.
TreeSettings uniformBasis(int level) {
  return {.basis = TreeSettings::Basis::uniform, .maxLevel = level};
}
TreeSettings levelOnly(int level) {
  return {.minLevel = level, .maxLevel = level, .frozen = false};
}

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
  for (const DirectionDomain domain : {DirectionDomain::hemisphere, DirectionDomain::sphere}) {
    const bool half = domain == DirectionDomain::hemisphere;
    builder.build([](const glm::vec3&) { return glm::vec3(1, 2, 3); }, domain, {}, tree);
    EXPECT_EQ(tree.cellCount(), half ? 64u : 128u);  // the horizon adds none
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(tree.flux()[c], float(c + 1) * glsl::pi * (half ? 1 : 4), 2e-5f * float(c + 1));
  }
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

TEST(TreeBuilder, OneLevelLosesNarrowLobes) {
  // What is scaled away: 1024 cells hold but a part of a lobe of roughness 0.1.
  const GlossyLobes lobes = lobesOf(0.1f, {lightFrom(45)});
  TreeBuilder builder;
  DirectionalTree tree;
  builder.build(radianceOf(lobes), DirectionDomain::hemisphere, levelOnly(4), tree);
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
  const glm::vec3 towards = lightFrom(40).direction;
  const glsl::Frame frame = glsl::frame_around(towards);
  const auto square = [&](int side) {
    std::vector<glsl::IncidentLight> lights;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const glm::vec2 at =
            0.6f * ((glm::vec2(float(i), float(j)) + glm::vec2(0.5f)) / float(side) - glm::vec2(0.5f));
        const glsl::IlluminationSample sample{towards + at.x * frame.t + at.y * frame.b,
                                              0.36f / float(side * side), glm::vec3(1),
                                              glsl::vertex_pack_normal(-towards)};
        lights.push_back(glsl::incident_light(sample, glm::vec3(0)));
      }
    return lights;
  };
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
      builder.build(radianceOf(widened), DirectionDomain::hemisphere, {.error = 0.02f}, tree);
      EXPECT_NEAR(tree.flux().x, widened.flux().x, 0.02f * widened.flux().x) << degrees << " " << spread;
    }
}

TEST(GlossyLobes, OfModelsAreTheModels) {
  glsl::MaterialModel model{};
  model.kind = glsl::model_ward;
  model.ks = glm::vec3(0.5f);
  model.roughness = glm::vec2(0.2f, 0.4f);
  const std::vector<glm::vec3> none;
  const std::vector<glsl::IncidentLight> lights = {lightFrom(30), lightFrom(60, {1, 2, 3}), lightFrom(120)};
  GlossyLobes lobes;
  lobes.set(model, none, lights, 0);
  ASSERT_EQ(lobes.size(), 2u);
  const glm::vec3 w = glm::normalize(glm::vec3(-0.3f, -0.2f, 0.8f));
  const glm::vec3 exact = glsl::model_response(none, model, w, lights[0].direction) * lights[0].irradiance +
                          glsl::model_response(none, model, w, lights[1].direction) * lights[1].irradiance;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(lobes.radiance(w)[c], exact[c], 1e-5f * exact[c]);
  TreeBuilder builder;
  DirectionalTree tree;
  builder.build(lobes, {}, tree);
  EXPECT_LT(errorOf(tree, lobes), 0.13);
  // Back to a BRDF: nothing of the model stays.
  lobes.set(metal(0.3f), lights, 0);
  EXPECT_TRUE(lobes.fluxKnown());
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

/// A tree with cells of many sizes.
DirectionalTree glossyTree(float roughness = 0.3f) {
  TreeBuilder builder;
  DirectionalTree tree;
  builder.build(lobesOf(roughness, {lightFrom(20), lightFrom(60, {2, 1, 0.5f})}), {}, tree);
  return tree;
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

TEST(DirectionalTree, IntensityIsTheSumOfWhatSurfacesSend) {
  const DirectionalTree glossy = glossyTree(), dark;
  const glsl::Frame up = glsl::frame_around(glm::normalize(glm::vec3(0.2f, 0.3f, 0.9f)));
  const glsl::Frame side = glsl::frame_around(glm::vec3(1, 0, 0));
  const glsl::Frame world{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  TreeBuilder builder;
  DirectionalTree inner, outer;
  const TreePart surfaces[] = {{&glossy, up, 2}, {&dark, side, 1, glm::vec3(0.2f)}};
  builder.intensity(surfaces, world, {}, inner);
  const glm::vec3 power = 2.f * glossy.flux() + glsl::pi * glm::vec3(0.2f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(inner.flux()[c], power[c], 1e-5f * power[c]);
  double error = 0, all = 0;
  glsl::Random random(9);
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 w = random.direction();
    const float cosine = glsl::to_local(up, w).z;
    const double exact =
        double(2 * std::max(cosine, 0.f) * glossy.value(glsl::to_local(up, w)).x + 0.2f * std::max(w.x, 0.f));
    error += (double(inner.value(w).x) - exact) * (double(inner.value(w).x) - exact);
    all += exact * exact;
  }
  std::printf("intensity: error %.3f, cells %zu\n", std::sqrt(error / all), inner.cellCount());
  EXPECT_LT(std::sqrt(error / all), 0.16);
  // Clusters in clusters.
  const TreePart clusters[] = {{&inner, world, 1}, {&glossy, side, 1}};
  builder.intensity(clusters, world, {}, outer);
  const glm::vec3 both = inner.flux() + glossy.flux();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(outer.flux()[c], both[c], 1e-5f * both[c]);
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
  DirectionalTree tree, pulled, cluster;
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
  builder.intensity(parts, up, uniformBasis(4), cluster);
  EXPECT_TRUE(pulled.uniform() && cluster.uniform());
  EXPECT_EQ(cluster.cellCount(), 2048u);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(pulled.flux()[c], tree.flux()[c], 1e-5f * tree.flux()[c]);
    EXPECT_NEAR(cluster.flux()[c], 2 * tree.flux()[c], 1e-5f * tree.flux()[c]);
  }
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
      const glm::vec3 found[] = {scale * glsl::packed_tree_value(nodes.data() + 7, w, false),
                                 scale * glsl::packed_tree_value(nodes.data() + 7, w, true)};
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
