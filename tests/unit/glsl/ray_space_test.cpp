// Rays against boxes and triangles: walks find what brute force finds, and nothing slips through closed
// meshes.
#include "glsl/rays/ray_space.glsl"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "core/rays/bvh.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using glm::vec3;

struct Triangles {
  std::vector<vec3> corners;
  explicit Triangles(const scene::Primitive& primitive) {
    for (const uint32_t index : primitive.indices) corners.push_back(primitive.positions[index]);
  }
  uint32_t count() const { return static_cast<uint32_t>(corners.size() / 3); }
  bool meets(uint32_t i, const glsl::RaySpace& ray, float end) const {
    vec3 weights;
    return glsl::ray_meets_triangle(ray, corners[3 * i], corners[3 * i + 1], corners[3 * i + 2], end,
                                    weights);
  }
  std::vector<glsl::RayBox> boxes() const {
    std::vector<glsl::RayBox> result;
    for (uint32_t i = 0; i < count(); ++i) {
      glsl::RayBox box = glsl::ray_box_empty();
      for (uint32_t k = 0; k < 3; ++k)
        box = glsl::ray_box_join(box, {corners[3 * i + k], corners[3 * i + k]});
      result.push_back(glsl::ray_box_grown(box));
    }
    return result;
  }
};

/// Returns whether a walk through the hierarchy meets a triangle.
bool walk(const rays::BvhBuilder& tree, const Triangles& triangles, const glsl::RaySpace& ray, float end) {
  std::vector<uint32_t> stack{0};
  while (!stack.empty()) {
    const uint32_t current = stack.back();
    stack.pop_back();
    if (glsl::ray_is_leaf(current)) {
      const uint32_t first = glsl::ray_leaf_first(current);
      for (uint32_t i = first; i < first + glsl::ray_leaf_count(current); ++i)
        if (triangles.meets(tree.order()[i], ray, end)) return true;
      continue;
    }
    const glsl::RayNode& node = tree.nodes()[current];
    const glm::bvec4 met = glsl::ray_meets_children(node, ray, end);
    for (int i = 3; i >= 0; --i)
      if (met[i]) stack.push_back(node.child[i]);
    EXPECT_LE(stack.size(), static_cast<size_t>(tree.stack()));
  }
  return false;
}

TEST(RaySpaceTest, WalksFindWhatBruteForceFinds) {
  const Triangles ball(test::spherePrimitive(1, 0, 12));
  rays::BvhBuilder tree;
  tree.build(ball.boxes(), 4, rays::Split::surfaceArea);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-2, 2);
  int met = 0;
  for (int i = 0; i < 4000; ++i) {
    vec3 direction(place(random), place(random), place(random));
    if (i % 5 == 0) direction[i % 3] = 0;  // along a plane of the axes
    const glsl::RaySpace ray = glsl::ray_space({place(random), place(random), place(random)}, direction);
    const float end = i % 2 == 0 ? 1.f : 3e38f;
    bool any = false;
    for (uint32_t t = 0; t < ball.count(); ++t) any = any || ball.meets(t, ray, end);
    EXPECT_EQ(walk(tree, ball, ray, end), any) << i;
    if (any) ++met;
  }
  EXPECT_GT(met, 400);
  EXPECT_LT(met, 3600);
}

TEST(RaySpaceTest, NothingLeavesAClosedMeshThroughEdgesAndCorners) {
  for (const float far : {0.f, 100.f}) {
    scene::Primitive primitive = test::spherePrimitive(1, 0, 16);
    // Both ends of a circle of latitude, a rounding apart, become one place.
    for (vec3& p : primitive.positions) p = glm::round(p * 1024.f) / 1024.f + far;
    const Triangles ball(primitive);
    rays::BvhBuilder tree;
    tree.build(ball.boxes(), 4, rays::Split::surfaceArea);
    const vec3 inside = vec3(far) + vec3(0.1f, -0.2f, 0.05f);
    std::mt19937 random(2);
    std::uniform_real_distribution<float> share(0, 1);
    for (uint32_t t = 0; t < ball.count(); ++t) {
      for (uint32_t k = 0; k < 3; ++k) {
        const vec3 a = ball.corners[3 * t + k], b = ball.corners[3 * t + (k + 1) % 3];
        for (const vec3& target : {a, glm::mix(a, b, share(random)), glm::mix(a, b, 0.5f)})
          EXPECT_TRUE(walk(tree, ball, glsl::ray_space(inside, target - inside), 3e38f)) << t;
      }
    }
  }
}

TEST(RaySpaceTest, SegmentsEndWhereTheySay) {
  const Triangles square(test::floorPrimitive(1, 0));
  const glsl::RaySpace down = glsl::ray_space({0.2f, 2, 0.3f}, {0, -1, 0});
  EXPECT_TRUE(square.meets(0, down, 2.0001f) || square.meets(1, down, 2.0001f));
  EXPECT_FALSE(square.meets(0, down, 1.9999f) || square.meets(1, down, 1.9999f));
  const glsl::RaySpace up = glsl::ray_space({0.2f, 2, 0.3f}, {0, 1, 0});
  const glsl::RaySpace along = glsl::ray_space({-3, 0, 0.3f}, {1, 0, 0});
  for (uint32_t i = 0; i < 2; ++i) {
    EXPECT_FALSE(square.meets(i, up, 3e38f));
    EXPECT_FALSE(square.meets(i, along, 3e38f));
  }
}

TEST(RaySpaceTest, WeightsAreThoseOfTheCorners) {
  const vec3 a(0, 1, 2), b(3, 1, 0), c(-1, 4, 1), inside = 0.2f * a + 0.3f * b + 0.5f * c;
  const vec3 origin(1, -3, 7);
  vec3 weights;
  float end = 1.001f;
  ASSERT_TRUE(glsl::ray_meets_triangle(glsl::ray_space(origin, inside - origin), a, b, c, end, weights));
  EXPECT_NEAR(end, 1, 1e-6f);
  weights /= weights.x + weights.y + weights.z;
  EXPECT_NEAR(weights.x, 0.2f, 1e-5f);
  EXPECT_NEAR(weights.y, 0.3f, 1e-5f);
  EXPECT_NEAR(weights.z, 0.5f, 1e-5f);
}

TEST(RaySpaceTest, BodiesTakeRaysIntoTheirOwnSpace) {
  const glm::mat4 toWorld = glm::rotate(test::at(3, -1, 2, 0.5f), 0.7f, vec3(1, 2, 3));
  const glm::mat4 inverse = glm::inverse(toWorld);
  glsl::RayBody body{};
  const glm::mat3 rows = glm::transpose(glm::mat3(inverse));
  body.row_x = rows[0];
  body.row_y = rows[1];
  body.row_z = rows[2];
  body.shift_x = inverse[3].x;
  body.shift_y = inverse[3].y;
  body.shift_z = inverse[3].z;
  const vec3 origin(0.3f, 1, -2), direction(2, 1, 0.5f);
  const glsl::RaySpace ray = glsl::ray_into_body(body, origin, direction);
  for (const float t : {0.f, 0.7f, 3.f}) {
    const vec3 back(toWorld * glm::vec4(ray.origin + t * ray.direction, 1));
    EXPECT_LT(glm::distance(back, origin + t * direction), 1e-5f);
  }
}

}  // namespace
}  // namespace limn
