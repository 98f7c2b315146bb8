// W of height maps in the reference: against closed forms and exact horizons, whichever way the map lies on
// its surface.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "core/relief/horizon.h"
#include "tests/support/relief_worlds.h"
#include "tests/unit/relief/fields.h"

namespace limn::reference {
namespace {

using namespace test;
using glm::dvec2;
using glm::dvec3;
using glm::vec2;
using glm::vec3;
using relief::HeightField;

/// Compares W, 0 or 1, with whether the tangent of the light's elevation is above `horizon` of a place,
/// except where rounding decides. Returns how many pixels are lit and how many are dark.
glm::ivec2 expectHorizon(const World& world, double tangent, const std::function<double(dvec3)>& horizon) {
  const Image image = reliefOf(world);
  const int w = image.channel("W");
  glm::ivec2 counts(0);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const dvec3 place = positionOf(world, image, x, y);
      const double e = horizon(place);
      if (std::isnan(e) || std::abs(tangent - e) < 1e-3) continue;
      EXPECT_EQ(image.at(x, y, w), tangent > e ? 1.f : 0.f)
          << "at " << place.x << " " << place.y << ": " << tangent << " over " << e;
      ++(tangent > e ? counts.x : counts.y);
    }
  return counts;
}

/// The horizon's tangent towards +X from a place on a groove of relief::test::groove(64, slope).
double grooveHorizon(double x, double slope) {
  const double moved = x - 0.5 / 64, along = moved - std::floor(moved);  // from crest to crest
  return along < 0.5 ? slope * along / (1 - along) : slope;
}

TEST(ReferenceRelief, TheShadowOfAGroovesCrestEndsWhereItsSightLineDoes) {
  World world = planeWorld(relief::test::groove(64, 0.6));
  for (const double turn : {0.0, 0.7, -1.2})
    for (const double tangent : {0.1, 0.3, 0.5, 0.7}) {
      shineFrom(world, glm::normalize(vec3(dvec3(std::cos(turn), std::sin(turn), tangent))));
      const glm::ivec2 counts = expectHorizon(world, tangent / std::cos(turn),
                                              [](const dvec3& p) { return grooveHorizon(p.x, 0.6); });
      EXPECT_GT(counts.x, 100);
      EXPECT_TRUE(tangent / std::cos(turn) > 0.6 || counts.y > 100);
    }
}

TEST(ReferenceRelief, BumpsAreSeenOverTheExactHorizon) {
  const HeightField fields[] = {relief::test::eggCrate(32), relief::test::noise(24, 0.8)};
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const HeightField& field : fields) {
    World world = planeWorld(field);
    glm::ivec2 all(0);
    for (int i = 0; i < 12; ++i) {
      const double angle = 2 * std::numbers::pi * uniform(engine), tangent = 0.7 * uniform(engine);
      // v falls with y.
      shineFrom(world, glm::normalize(vec3(dvec3(std::cos(angle), -std::sin(angle), tangent))));
      all += expectHorizon(world, tangent, [&](const dvec3& p) {
        return relief::exactHorizon(field, field.place({p.x, -p.y}), angle);
      });
    }
    EXPECT_GT(std::min(all.x, all.y), 2000);
  }
}

TEST(ReferenceRelief, MapsLieOnTheirSurfacesAsTexturesDo) {
  const glm::mat4 tilted = glm::rotate(glm::mat4(1), 0.8f, vec3(1, 2, 3));
  for (const float u : {1.f, -1.f})
    for (const float v : {1.f, -1.f})
      for (const bool swapped : {false, true})
        for (const vec3& scale : {vec3(1), vec3(-1, 1, 1), vec3(1, -1, 1), vec3(-1, -1, 1)})
          for (const int axis : {0, 1}) {
            SCOPED_TRACE(testing::Message() << "u " << u << ", v " << v << (swapped ? ", swapped" : "")
                                            << ", scale " << scale.x << " " << scale.y << ", axis " << axis);
            World world = planeWorld(ramp(axis, 1), {.uv =
                                                         [&](const vec2& p) {
                                                           const vec2 at = swapped ? vec2(p.y, p.x) : p;
                                                           return 0.5f + 0.5f * vec2(u, v) * at;
                                                         },
                                                     .matrix = tilted * glm::scale(glm::mat4(1), scale)});
            // Where the heights rise, on the plane and in the world.
            vec3 local(0);
            local[swapped ? 1 - axis : axis] = axis == 0 ? u : v;
            const vec3 rising = glm::mat3(tilted) * (scale * local), n = glm::mat3(tilted)[2];
            const auto lit = [&](const vec3& side) {
              shineFrom(world, glm::normalize(side + 0.5f * n));
              const Image image = reliefOf(world);
              double sum = 0, count = 0;
              for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x) {
                  const dvec3 p = positionOf(world, image, x, y);
                  const bool seen = image.at(x, y, image.channel("coverage")) > 0;
                  if (!seen || std::abs(glm::dot(p, dvec3(rising))) > 0.9) continue;  // the ramp ends
                  sum += static_cast<double>(image.at(x, y, image.channel("W")));
                  ++count;
                }
              return sum / count;
            };
            EXPECT_EQ(lit(rising), 0);
            EXPECT_EQ(lit(-rising), 1);
            EXPECT_EQ(lit(glm::cross(n, rising)), 1);
            EXPECT_EQ(lit(-glm::cross(n, rising)), 1);
          }
}

TEST(ReferenceRelief, ClampedMapsGoOnLevelBeyondTheirEdges) {
  World world = planeWorld(ramp(0, 1), {.half = 6, .uv = [](const vec2& p) { return 0.5f * p + 0.5f; }});
  // The first texel lies at x = -1 + 1/64, the last one at 1 - 1/64, as high as it is far from the first.
  constexpr double top = 1 - 1.0 / 64, rise = 2 * top;
  shineFrom(world, glm::normalize(vec3(1, 0, 0.4f)));
  const glm::ivec2 counts = expectHorizon(world, 0.4, [&](const dvec3& p) {
    return p.x < -top ? rise / (top - p.x) : p.x < top ? 1.0 : 0.0;
  });
  EXPECT_GT(std::min(counts.x, counts.y), 100);
  shineFrom(world, glm::normalize(vec3(-1, 0.5f, 0.01f)));
  EXPECT_EQ(expectHorizon(world, 0.01, [](const dvec3&) { return 0.0; }).y, 0);
}

TEST(ReferenceRelief, CoordinatesFarFromTheMapAreTakenThere) {
  for (const relief::Wrap wrap : {relief::Wrap::periodic, relief::Wrap::clamped}) {
    const HeightField field({2, 1}, {0, 1}, dvec2(1), 1, 0, wrap);
    World world = planeWorld(field, {.uv = [](const vec2& p) { return 1e12f * (p + vec2(2)); }});
    shineFrom(world, glm::normalize(vec3(1, 0, 0.1f)));
    const Image image = reliefOf(world);
    for (int i = 0; i < kSide * kSide; ++i) {
      const float w = image.at(i % kSide, i / kSide, image.channel("W"));
      if (wrap == relief::Wrap::clamped)
        EXPECT_EQ(w, 1.f);
      else
        EXPECT_TRUE(w == 0.f || w == 1.f);
    }
  }
}

TEST(ReferenceRelief, FromTheZenithAllIsLitAndFromBelowNothingIsAsked) {
  World world = planeWorld(relief::test::eggCrate(32, 5));
  const auto all = [&](const char* channel) {
    const Image image = reliefOf(world);
    double sum = 0;
    for (int i = 0; i < kSide * kSide; ++i)
      sum += static_cast<double>(image.at(i % kSide, i / kSide, image.channel(channel)));
    return sum / (kSide * kSide);
  };
  shineFrom(world, {0, 0, 1});
  EXPECT_EQ(all("W"), 1);
  EXPECT_EQ(all("masked"), 0);
  shineFrom(world, glm::normalize(vec3(1, 0.3f, 1e-3f)));
  EXPECT_LT(all("W"), 0.05);
  EXPECT_EQ(all("masked"), 0);
  for (const vec3& towards : {vec3(1, 0, 0), vec3(1, 0, -0.5f), vec3(0, 0, -1)}) {
    shineFrom(world, glm::normalize(towards));
    EXPECT_EQ(all("W"), 1) << "as V is";
    EXPECT_EQ(all("masked"), 1);
  }
}

TEST(ReferenceRelief, BelowTheInterpolatedNormalsPlaneAllIsDark) {
  // Nothing of the field is in the way: it falls steeply towards the light.
  World world = planeWorld(ramp(0, 50), {.uv = [](const vec2& p) { return 0.5f * p + 0.5f; }});
  scene::Primitive& p = world.scene.meshes[0].primitives[0];
  p.normals.assign(4, glm::normalize(vec3(0.5f, 0, 1)));
  completeTangents(p);
  shineFrom(world, glm::normalize(vec3(-1, 0, 0.4f)));  // above the triangles' plane
  EXPECT_EQ(expectHorizon(world, 0, [](const dvec3&) { return 1.0; }).x, 0);
  shineFrom(world, glm::normalize(vec3(-1, 0, 0.6f)));
  EXPECT_EQ(expectHorizon(world, 1, [](const dvec3&) { return 0.0; }).y, 0);
}

TEST(ReferenceRelief, BacksHaveNoBumps) {
  World world = planeWorld(relief::test::eggCrate(32, 5), {.doubleSided = true});
  world.camera = scene::lookAt({0, 0, -2.4f}, vec3(0), 0.8f);
  shineFrom(world, glm::normalize(vec3(1, 0.3f, -0.05f)));
  EXPECT_EQ(expectHorizon(world, 1, [](const dvec3&) { return 0.0; }).y, 0);
}

TEST(ReferenceRelief, ALightWithSizeIsSeenInPart) {
  World world = planeWorld(relief::test::groove(64, 0.6));
  world.addRectangle({1.7f, 0, 1}, {1, 0, 0}, {0, 0.5f, 0}, 1);  // x of [1.2, 2.2], 1 m above the plane
  const Image image = reliefOf(world, 256);
  int partly = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double px = positionOf(world, image, x, y).x;
      const double seen = std::clamp(px + 1 / grooveHorizon(px, 0.6) - 1.2, 0.0, 1.0);
      // Two halves with a sample in each 128th of the light's length: one of them is cut.
      EXPECT_NEAR(static_cast<double>(image.at(x, y, image.channel("W"))), seen, 1.0 / 128 + 1e-4);
      partly += seen > 0.1 && seen < 0.9;
    }
  EXPECT_GT(partly, 100);
}

}  // namespace
}  // namespace limn::reference
