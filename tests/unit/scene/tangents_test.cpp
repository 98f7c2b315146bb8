// Tangents along textures, with the sign that glTF gives them.
#include "core/scene/tangents.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/scene_files.h"

namespace limn::scene {
namespace {

/// Of the direction in which v falls, which is up in the picture: the bitangent (glTF 2.0, 3.8.3 and 3.9.3).
glm::vec3 up(const glm::vec4& tangent, const glm::vec3& normal) {
  return tangent.w * glm::cross(normal, glm::vec3(tangent));
}

TEST(Tangents, FollowTheTexture) {
  const std::vector<glm::vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, n(3, glm::vec3(0, 0, 1));
  const std::vector<std::uint32_t> indices = {0, 1, 2};
  const float angle = 0.6f, c = std::cos(angle), s = std::sin(angle);
  // u grows along (c, s, 0) and v along (-s, c, 0); upright, it falls along it.
  std::vector<glm::vec2> mirrored, upright;
  for (const glm::vec3& v : p) {
    mirrored.emplace_back(3 * (c * v.x + s * v.y), c * v.y - s * v.x);
    upright.emplace_back(mirrored.back().x, -mirrored.back().y);
  }
  for (const glm::vec4& t : generateTangents(p, n, upright, indices)) {
    test::expectNear(t, {c, s, 0});
    EXPECT_EQ(t.w, 1) << "as most files have it";
    test::expectNear(up(t, n[0]), {-s, c, 0});
  }
  for (const glm::vec4& t : generateTangents(p, n, mirrored, indices)) {
    test::expectNear(t, {c, s, 0});
    EXPECT_EQ(t.w, -1);
    test::expectNear(up(t, n[0]), {s, -c, 0});
  }
  for (const glm::vec4& t : generateTangents(p, n, std::vector<glm::vec2>(3), indices)) {
    EXPECT_NEAR(glm::length(glm::vec3(t)), 1, 1e-6);  // no direction in the texture: any perpendicular
    EXPECT_NEAR(t.z, 0, 1e-6);
    EXPECT_EQ(t.w, 1);
  }
}

/// mikktspace.h: "vec3 bitangent = fSign * cross(vN, tangent)" points to growing v, and glTF's exporters and
/// viewers that use it turn its sign (three.js, computeMikkTSpaceTangents, negateSign). Of a body whose
/// halves share a mirrored texture each has its own sign; a triangle without extent in the texture has none
/// to say.
TEST(Tangents, AreThoseOfMikkTSpaceWithItsSignTurned) {
  const std::vector<glm::vec3> p = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 0},
                                    {1, 0, 0},  {0, 1, 0}, {0, 2, 0}, {0, 1, 0}};
  const std::vector<glm::vec3> n(p.size(), glm::vec3(0, 0, 1));
  const std::vector<glm::vec2> uv = {{1, 1}, {0, 1}, {0, 0}, {0, 1}, {1, 1}, {0, 0}, {0, 0}, {0, 0}};
  const std::vector<std::uint32_t> left = {0, 1, 2}, right = {3, 4, 5}, flat = {5, 6, 7};
  std::vector<std::uint32_t> all;
  for (const auto* part : {&left, &right, &flat}) all.insert(all.end(), part->begin(), part->end());
  const std::vector<glm::vec4> tangents = generateTangents(p, n, uv, all);
  for (const std::uint32_t i : left) {
    test::expectNear(tangents[i], {-1, 0, 0});
    EXPECT_EQ(tangents[i].w, -1);
    test::expectNear(up(tangents[i], n[i]), {0, 1, 0});
  }
  for (const std::uint32_t i : right) {
    test::expectNear(tangents[i], {1, 0, 0});
    EXPECT_EQ(tangents[i].w, 1);
    test::expectNear(up(tangents[i], n[i]), {0, 1, 0});
  }
}

}  // namespace
}  // namespace limn::scene
