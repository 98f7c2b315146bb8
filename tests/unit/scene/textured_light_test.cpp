// Rectangles with an emissive texture become several uniform lights: what they sum to, against the texture
// itself.
#include <cmath>
#include <random>

#include "core/image/byte_values.h"
#include "core/scene/emissive_quad.h"
#include "core/scene/texture_lookup.h"
#include "glsl/light/rectangle_light.glsl"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using scene::Scene;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kRepeat = 10497, kClamp = 33071;

/// A square of 1 m in the plane z = 0 that faces +Z, with an emissive texture whose first row is at y = 1.
Scene lamp(const std::vector<std::uint8_t>& rgba,
           const std::vector<glm::vec2>& uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}}, glm::uvec2 size = {8, 8},
           int wrap = kClamp) {
  GltfBuilder b;
  const std::vector<std::byte> image = png(size.x, size.y, rgba);
  b.append("images", {{"bufferView", b.view(image.data(), image.size())}, {"mimeType", "image/png"}});
  b.append("samplers", {{"wrapS", wrap}, {"wrapT", wrap}});
  b.append("textures", {{"source", 0}, {"sampler", 0}});
  const int material =
      b.append("materials", {{"emissiveFactor", {1, 0.5, 1}}, {"emissiveTexture", {{"index", 0}}}});
  const int positions = b.vec3({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  b.meshNode(b.mesh({{"POSITION", positions}, {"TEXCOORD_0", b.vec2(uvs)}}, b.indices({0, 1, 2, 0, 2, 3}),
                    material));
  return loadBuilt(b);
}

std::vector<std::uint8_t> uniform(std::uint8_t value) {
  return std::vector<std::uint8_t>(8 * 8 * 4, value);
}

/// Dim noise with a bright spot.
std::vector<std::uint8_t> uneven() {
  std::mt19937 random(7);
  std::vector<std::uint8_t> rgba = uniform(255);
  for (std::size_t i = 0; i < rgba.size(); i += 4)
    for (std::size_t c = 0; c < 3; ++c) rgba[i + c] = static_cast<std::uint8_t>(random() % 120);
  for (const std::size_t texel : {2 * 8 + 5, 2 * 8 + 6, 3 * 8 + 5, 3 * 8 + 6})
    for (std::size_t c = 0; c < 3; ++c) rgba[4 * static_cast<std::size_t>(texel) + c] = 255;
  return rgba;
}

glm::dvec3 radianceAt(const Scene& scene, double x, double y) {
  const scene::Material& m = scene.materials.at(0);
  return glm::dvec3(m.emission) *
         glm::dvec3(scene::sampleTexture(scene, m.emissiveTexture, glm::vec2(x, 1 - y), 0));
}

TEST(TexturedLight, AUniformTextureIsOneLight) {
  const scene::Pose pose = scene::evaluate(lamp(uniform(255)), 0);
  ASSERT_EQ(pose.lights.size(), 1u);
  EXPECT_EQ(pose.lights[0].emission, glm::vec3(1, 0.5f, 1));
  EXPECT_EQ(pose.lights[0].length_u * pose.lights[0].length_v, 1);
  EXPECT_THAT(pose.lightNames, ElementsAre("n"));
}

TEST(TexturedLight, PowerIsThatOfTheTexture) {
  const Scene scene = lamp(uneven());
  glm::dvec3 expected(0), sum(0);
  constexpr int n = 512;
  for (int i = 0; i < n * n; ++i)
    expected += radianceAt(scene, (i % n + 0.5) / n, (i / n + 0.5) / n) / double(n * n);
  const scene::Pose pose = scene::evaluate(scene, 0);
  EXPECT_GT(pose.lights.size(), 1u);
  EXPECT_LE(pose.lights.size(), std::size_t{scene::kMostTexturedLightParts});
  EXPECT_EQ(pose.lightNames[1], "n#1");
  for (const glsl::Light& light : pose.lights)
    sum += double(light.length_u * light.length_v) * glm::dvec3(light.emission);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 0.01 * expected[c]) << c;
}

TEST(TexturedLight, IrradianceIsCloseToTheTextures) {
  const Scene scene = lamp(uneven());
  const scene::Pose pose = scene::evaluate(scene, 0);
  const glm::vec3 receivers[] = {
      {0.5f, 0.5f, 0.25f}, {0.7f, 0.7f, 0.5f}, {0, 0, 0.5f}, {0.5f, 0.5f, 2}, {-1, 0.3f, 1}};
  for (const glm::vec3& p : receivers) {
    const glm::vec3 n = glm::normalize(glm::vec3(0.5f, 0.5f, 0) - p);
    double expected = 0, sum = 0;
    constexpr int cells = 256;
    for (int i = 0; i < cells * cells; ++i) {
      const glm::dvec2 at((i % cells + 0.5) / cells, (i / cells + 0.5) / cells);
      const glm::dvec3 offset = glm::dvec3(at, 0) - glm::dvec3(p);
      const double d2 = glm::dot(offset, offset), towards = glm::dot(offset, glm::dvec3(n)) * -offset.z;
      expected += std::max(towards, 0.0) / (d2 * d2) * radianceAt(scene, at.x, at.y).x / (cells * cells);
    }
    for (const glsl::Light& light : pose.lights)
      sum += double{light.emission.x} * glsl::rectangle_irradiance(glsl::rectangle_from(light, p), n);
    const double allowed = p.z < 0.5f ? 0.1 : 0.02;  // three lights for this texture
    EXPECT_NEAR(sum, expected, allowed * expected) << p.x << " " << p.y << " " << p.z;
  }
}

/// Cells of many texels are read from a smaller level, which holds the same light.
TEST(TexturedLight, PowerIsThatOfALargeTexture) {
  std::mt19937 random(3);
  std::vector<std::uint8_t> rgba;
  for (int i = 0; i < 120 * 120 * 4; ++i) rgba.push_back(static_cast<std::uint8_t>(random() % 256));
  const Scene scene = lamp(rgba, {{0, 8}, {8, 8}, {8, 0}, {0, 0}}, {120, 120}, kRepeat);
  glm::dvec3 expected(0), sum(0);
  for (std::size_t i = 0; i < rgba.size(); ++i)
    if (i % 4 != 3) expected[static_cast<int>(i % 4)] += double{byteValues(true)[rgba[i]]} / (120 * 120);
  for (const glsl::Light& light : scene::evaluate(scene, 0).lights)
    sum += double(light.length_u * light.length_v) * glm::dvec3(light.emission);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(sum[c] / scene.materials.at(0).emission[c], expected[c], 0.005) << c;
}

/// What is long has many texels along one side of a cell, and keeps what is told apart along the other.
TEST(TexturedLight, ALongTextureKeepsItsRows) {
  std::vector<std::uint8_t> rgba(1000 * 16 * 4, 255);
  for (std::size_t i = 1000 * 8 * 4; i < rgba.size(); ++i)
    if (i % 4 != 3) rgba[i] = 0;
  const scene::Pose pose = scene::evaluate(lamp(rgba, {{0, 1}, {1, 1}, {1, 0}, {0, 0}}, {1000, 16}), 0);
  ASSERT_EQ(pose.lights.size(), 1u);
  expectNear(pose.lights[0].position, {0.5f, 0.75f, 0});
  expectNear(pose.lights[0].emission, {1, 0.5f, 1});
}

TEST(TexturedLight, CoordinatesThatAreNoAffineMapLightNothing) {
  const Scene scene = lamp(uneven(), {{0, 1}, {1, 1}, {0.5f, 0.5f}, {0, 0}});
  EXPECT_TRUE(scene::evaluate(scene, 0).lights.empty());
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("displayed but light nothing")));
  EXPECT_TRUE(scene::evaluate(lamp(uniform(0)), 0).lights.empty());
}

}  // namespace
}  // namespace limn::test
