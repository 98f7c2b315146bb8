// Lists of what may hide a light: that nothing is missing in them, and what they leave out.
#include "core/radiosity/blocker_lists.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <span>

#include "core/radiosity/scene_elements.h"
#include "tests/support/test_scenes.h"
#include "tests/unit/glsl/random.h"

namespace limn::radiosity {
namespace {

constexpr size_t kPlenty = size_t{1} << 24;

/// A closed sphere and an open square above a floor.
struct BlockedWorld {
  BlockedWorld() {
    const int material = test::addMaterial(scene);
    const int floor = test::addMesh(scene, test::floorPrimitive(1, material)),
              sphere = test::addMesh(scene, test::spherePrimitive(0.25f, material, 12)),
              square = test::addMesh(scene, test::floorPrimitive(0.2f, material));
    test::addInstance(scene, pose, floor);
    test::addInstance(scene, pose, sphere, glm::translate(glm::mat4(1), {0.1f, 0.3f, 0}));
    test::addInstance(scene, pose, square, glm::translate(glm::mat4(1), {-0.5f, 0.4f, 0.2f}));
    elements = std::make_unique<SceneElements>(scene, pose, 0.15f, 1u << 20);
  }

  scene::Scene scene;
  scene::Pose pose;
  std::unique_ptr<SceneElements> elements;
};

glsl::Light square(float side) {
  glsl::Light light{};
  light.type = glsl::light_rectangle;
  light.own_instance = glsl::no_instance;
  light.position = {-0.3f, 1.6f, 0.4f};
  light.axis_u = {1, 0, 0};
  light.axis_v = {0, 0, 1};
  light.direction = {0, -1, 0};
  light.length_u = light.length_v = side;
  return light;
}

glsl::Light sun(float diameter) {
  glsl::Light light{};
  light.type = glsl::light_directional;
  light.own_instance = glsl::no_instance;
  light.direction = glm::normalize(glm::vec3(0.3f, -1, -0.2f));
  light.angular_diameter = diameter;
  return light;
}

/// Whether a way from `from` along `way` crosses the triangle before its end.
bool crosses(const std::array<glm::vec3, 3>& corners, const glm::vec3& from, const glm::vec3& way) {
  const glm::dvec3 a = corners[0], u = glm::dvec3(corners[1]) - a, v = glm::dvec3(corners[2]) - a, d = way,
                   s = glm::dvec3(from) - a;
  const glm::dvec3 p = glm::cross(d, v);
  const double det = glm::dot(u, p);
  if (std::abs(det) < 1e-12) return false;
  const glm::dvec3 q = glm::cross(s, u);
  const double x = glm::dot(s, p) / det, y = glm::dot(d, q) / det, t = glm::dot(v, q) / det;
  return x > 0 && y > 0 && x + y < 1 && t > 1e-3 && t < 1;
}

/// What a way from a random point of each leaf's part to one of the light meets is in the leaf's list, at
/// least one triangle of each closed body.
void expectComplete(const glsl::Light& light) {
  const BlockedWorld world;
  const SceneElements& elements = *world.elements;
  const std::array bounds{LightBounds::of(light)};
  BlockerLists lists;
  lists.build(elements, nullptr, bounds, kPlenty);
  const auto corners = [&](uint32_t t) {
    const auto corner = [&](uint32_t k) { return elements.leaves()[elements.triangles()[3 * t + k]].vertex; };
    return std::array{corner(0), corner(1), corner(2)};
  };
  const auto count = static_cast<uint32_t>(elements.triangles().size() / 3);
  glsl::Random random(5);
  int met = 0, listed = 0;
  for (uint32_t t = 0; t < count; ++t) {
    const auto at = corners(t);
    const glm::vec3 normal = glm::cross(at[1] - at[0], at[2] - at[0]);
    for (int i = 0; i < 8; ++i) {
      glm::vec3 weights(random(0.01f, 1), random(0.01f, 1), random(0.01f, 1));
      weights /= weights.x + weights.y + weights.z;
      const auto k = static_cast<uint32_t>(std::max_element(&weights.x, &weights.x + 3) - &weights.x);
      const glm::vec3 from = weights.x * at[0] + weights.y * at[1] + weights.z * at[2];
      const glm::vec2 place(random(-0.5f, 0.5f), random(-0.5f, 0.5f));
      glm::vec3 way;
      if (light.type == glsl::light_rectangle) {
        way = light.position + light.length_u * place.x * light.axis_u +
              light.length_v * place.y * light.axis_v - from;
      } else {
        const glsl::Frame frame = glsl::frame_around(-light.direction);
        const float radius = std::tan(0.5f * light.angular_diameter) * 1.4f;
        way = 10.f * (-light.direction + radius * (place.x * frame.t + place.y * frame.b));
      }
      if (glm::dot(normal, way) <= 0) continue;
      const BlockerLists::Range range = lists.ranges()[elements.triangles()[3 * t + k]];
      ASSERT_NE(range.count, BlockerLists::kUnlisted);
      const auto own = lists.triangles().subspan(range.first, range.count);
      std::set<uint32_t> all, found;  // objects
      for (uint32_t other = 0; other < count; ++other) {
        if (other == t || !crosses(corners(other), from, way)) continue;
        const uint32_t object = elements.forest().groups()[elements.triangles()[3 * other] / 4].object;
        all.insert(object);
        const auto same = [&](uint32_t entry) { return (entry & ~BlockerLists::kBothSides) == other; };
        if (std::ranges::any_of(own, same)) found.insert(object);
      }
      EXPECT_EQ(all, found) << "triangle " << t;
      if (!all.empty()) ++met;
      listed += static_cast<int>(range.count);
    }
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(listed, 0);
}

TEST(BlockerLists, HoldAllThatHidesARectangle) {
  expectComplete(square(0.4f));
}
TEST(BlockerLists, HoldAllThatHidesAPoint) {
  expectComplete(square(0));
}
TEST(BlockerLists, HoldAllThatHidesTheSun) {
  expectComplete(sun(0.2f));
}

/// A floor alone hides nothing from itself.
TEST(BlockerLists, AreEmptyWhereNothingIsInTheWay) {
  scene::Scene scene;
  scene::Pose pose;
  test::addInstance(scene, pose, test::addMesh(scene, test::floorPrimitive(1, test::addMaterial(scene))));
  const SceneElements elements(scene, pose, 0.1f, 1u << 20);
  const std::array bounds{LightBounds::of(square(0.4f)), LightBounds::of(sun(0.1f))};
  BlockerLists lists;
  lists.build(elements, nullptr, bounds, kPlenty);
  EXPECT_EQ(lists.ranges().size(), 2 * elements.forest().leafSlots());
  EXPECT_TRUE(lists.triangles().empty());
}

/// The lists of a light are those that it has alone, whatever lights come before it: one above the floor, one
/// below it, which the floor turns away from, and the sun.
TEST(BlockerLists, DoNotDependOnOtherLights) {
  const BlockedWorld world;
  glsl::Light below = square(0.4f);
  below.position.y = -1;
  below.direction.y = 1;
  const std::array bounds{LightBounds::of(square(0.4f)), LightBounds::of(below), LightBounds::of(sun(0.2f))};
  const size_t leaves = world.elements->forest().leafSlots();
  BlockerLists all, alone;
  all.build(*world.elements, nullptr, bounds, kPlenty);
  ASSERT_EQ(all.ranges().size(), bounds.size() * leaves);
  for (size_t l = 0; l < bounds.size(); ++l) {
    alone.build(*world.elements, nullptr, std::span(&bounds[l], 1), kPlenty);
    size_t unlisted = 0, listed = 0;
    for (size_t leaf = 0; leaf < leaves; ++leaf) {
      const BlockerLists::Range own = alone.ranges()[leaf], found = all.ranges()[l * leaves + leaf];
      ASSERT_EQ(found.count, own.count) << "light " << l << ", leaf " << leaf;
      if (own.count == BlockerLists::kUnlisted) {
        ++unlisted;
        continue;
      }
      listed += own.count;
      EXPECT_TRUE(std::ranges::equal(all.triangles().subspan(found.first, found.count),
                                     alone.triangles().subspan(own.first, own.count)))
          << "light " << l << ", leaf " << leaf;
    }
    EXPECT_GT(unlisted, 20u) << l;
    EXPECT_GT(listed, 20u) << l;
  }
}

/// Over the disc of a wide sun points on a plane are not even, whatever was listed before.
TEST(BlockerLists, AreNotMadeForWideSuns) {
  const BlockedWorld world;
  BlockerLists lists;
  const auto unlisted = [&](float diameter) {
    const std::array bounds{LightBounds::of(sun(diameter))};
    lists.build(*world.elements, nullptr, bounds, kPlenty);
    return std::ranges::count(lists.ranges(), BlockerLists::kUnlisted, &BlockerLists::Range::count);
  };
  const auto all = static_cast<std::ptrdiff_t>(world.elements->forest().leafSlots());
  EXPECT_LT(unlisted(0.99f * LightBounds::kWidestDisc), all);
  EXPECT_FALSE(lists.triangles().empty());
  EXPECT_EQ(unlisted(1.01f * LightBounds::kWidestDisc), all);
  EXPECT_TRUE(lists.triangles().empty());
}

/// All of a floor below a plate, which comes before it: there are more leaves than are listed at a time.
TEST(BlockerLists, HoldWhatHidesALightFromManyLeaves) {
  scene::Scene scene;
  scene::Pose pose;
  const int plate = test::addMesh(scene, test::floorPrimitive(1, test::addMaterial(scene)));
  test::addInstance(scene, pose, plate, glm::translate(glm::mat4(1), {0, 0.5f, 0}));
  test::addInstance(scene, pose, plate);
  const SceneElements elements(scene, pose, 0.016f, 1u << 20);
  const std::array bounds{LightBounds::of(square(0))};
  BlockerLists lists;
  lists.build(elements, nullptr, bounds, kPlenty);
  const auto objectOf = [&](uint32_t leaf) { return elements.forest().groups()[leaf / 4].object; };
  size_t hidden = 0;
  for (uint32_t leaf = 0; leaf < elements.forest().leafSlots(); ++leaf) {
    if (elements.leaves()[leaf].used == 0 || objectOf(leaf) != 1) continue;
    ++hidden;
    const BlockerLists::Range range = lists.ranges()[leaf];
    ASSERT_NE(range.count, BlockerLists::kUnlisted) << leaf;
    const auto own = lists.triangles().subspan(range.first, range.count);
    EXPECT_TRUE(std::ranges::any_of(own, [&](uint32_t entry) {
      return objectOf(elements.triangles()[3 * (entry & ~BlockerLists::kBothSides)]) == 0;
    })) << leaf;
  }
  EXPECT_GT(hidden, size_t{1} << 14);
}

TEST(BlockerLists, KeepToTheirRoomAndLeaveOutFullShadow) {
  const BlockedWorld world;
  const SceneElements& elements = *world.elements;
  const std::array bounds{LightBounds::of(square(0.05f))};
  BlockerLists all, few, partly;
  all.build(elements, nullptr, bounds, kPlenty);
  few.build(elements, nullptr, bounds, all.triangles().size() / 2);
  EXPECT_LE(few.triangles().size(), all.triangles().size() / 2);
  EXPECT_GT(few.triangles().size(), 0u);
  for (const BlockerLists::Range& range : few.ranges())
    if (range.count != BlockerLists::kUnlisted) {
      EXPECT_LE(range.first + range.count, few.triangles().size());
    }

  Links links;
  links.build(elements.forest(), {.resolution = 16});
  partly.build(elements, &links, bounds, kPlenty);
  EXPECT_LT(partly.triangles().size(), all.triangles().size());
  const auto unlisted = [](const BlockerLists& lists) {
    return std::ranges::count(lists.ranges(), BlockerLists::kUnlisted, &BlockerLists::Range::count);
  };
  EXPECT_GT(unlisted(partly), unlisted(all));
}

}  // namespace
}  // namespace limn::radiosity
