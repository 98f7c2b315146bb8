// A normal map, or a height map, is the surface whose bumps it stands for: lit from the side, it shines as
// that surface would.
#include <nlohmann/json.hpp>

#include "tests/support/gltf_builder.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"
#include "tests/truth/truth_test.h"

namespace limn {
namespace {

using glm::dvec2;
using glm::vec3;
using json = nlohmann::json;

constexpr int kTexels = 64;
constexpr double kGrey = 0.8, kIrradiance = 3;

/// Gradient of bumps h = 0.03 sin(2 pi x) + 0.05 cos(2 pi y) + 0.02 sin(2 pi (x + y)), in sides of the quad,
/// over the place (x to the right, y up) on the upright picture; lopsided, so that no two ways of turning it
/// look alike.
dvec2 slope(const dvec2& p) {
  const double both = 2 * M_PI * 0.02 * std::cos(2 * M_PI * (p.x + p.y));
  return {2 * M_PI * 0.03 * std::cos(2 * M_PI * p.x) + both,
          -2 * M_PI * 0.05 * std::sin(2 * M_PI * p.y) + both};
}

/// Those bumps, in sides of the quad.
double height(const dvec2& p) {
  return 0.03 * std::sin(2 * M_PI * p.x) + 0.05 * std::cos(2 * M_PI * p.y) +
         0.02 * std::sin(2 * M_PI * (p.x + p.y));
}

/// The place of a texel's centre on the upright picture.
dvec2 centreOf(int column, int row) {
  return {(column + 0.5) / kTexels, 1 - (row + 0.5) / kTexels};
}

/// glTF 2.0, 3.9.3: red is to the right of the picture, green is up, blue is towards the viewer.
std::vector<std::byte> normalMap() {
  std::vector<std::uint8_t> rgba;
  for (int row = 0; row < kTexels; ++row)
    for (int column = 0; column < kTexels; ++column) {
      const dvec2 s = slope(centreOf(column, row));
      const glm::dvec3 n = glm::normalize(glm::dvec3(-s.x, -s.y, 1));
      for (int c = 0; c < 3; ++c)
        rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * (0.5 * n[c] + 0.5))));
      rgba.push_back(255);
    }
  return test::png(kTexels, kTexels, rgba);
}

/// Heights are kScale value - kScale / 2.
constexpr double kScale = 0.25;
std::vector<std::byte> heightMap() {
  std::vector<std::uint16_t> values;
  for (int row = 0; row < kTexels; ++row)
    for (int column = 0; column < kTexels; ++column)
      values.push_back(
          static_cast<std::uint16_t>(std::lround(65535 * (height(centreOf(column, row)) / kScale + 0.5))));
  return test::png16(kTexels, kTexels, values);
}

enum class Map { normals, heights };

struct Setting {
  const char* name;
  bool tangents;         ///< in the file
  bool mirroredTexture;  ///< its picture stands mirrored on the quad
  glm::vec3 scale;       ///< of the node
};

/// A quad of side 1 in the plane z = 0 of a node, its picture upright or mirrored.
scene::Scene bumps(const Setting& s, Map map, const vec3& towardsLight) {
  test::GltfBuilder b;
  const int material = b.texturedMaterial(map == Map::heights ? heightMap() : normalMap());
  json& entry = b.root["materials"][static_cast<size_t>(material)];
  entry = {{"pbrMetallicRoughness",
            {{"baseColorFactor", {kGrey, kGrey, kGrey, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
           {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}};
  if (map == Map::heights)
    entry["extras"]["limn_height"] = {
        {"texture", {{"index", 0}}}, {"scale", kScale}, {"offset", -kScale / 2}};
  else
    entry["normalTexture"]["index"] = 0;
  const float left = s.mirroredTexture ? 1.f : 0.f;
  json attributes = {
      {"POSITION", b.vec3({{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}})},
      {"NORMAL", b.vec3(std::vector<vec3>(4, {0, 0, 1}))},
      {"TEXCOORD_0", b.vec2({{left, 1}, {1 - left, 1}, {1 - left, 0}, {left, 0}})}};
  // 3.7.2.1: the bitangent, cross(normal, tangent) * w, points up the picture, here to +y.
  const float side = s.mirroredTexture ? -1.f : 1.f;
  if (s.tangents) attributes["TANGENT"] = b.vec4(std::vector<glm::vec4>(4, {side, 0, 0, side}));
  const int mesh = b.mesh(attributes, b.indices({0, 1, 2, 0, 2, 3}), material);
  b.node({{"mesh", mesh}, {"scale", {s.scale.x, s.scale.y, s.scale.z}}});
  scene::Scene scene = test::loadBuilt(b);
  test::shine(scene, test::lamp(glsl::light_directional, float(kIrradiance)), vec3(0), -towardsLight);
  return scene;
}

class NormalMapTruth : public TruthTest {
 protected:
  /// Lambert: radiance = albedo / pi * irradiance * cosine with the normal (-dh/dx, -dh/dy, 1) of the surface
  /// z = h(x, y).
  void expectTheSurface(Map map);
};

void NormalMapTruth::expectTheSurface(Map map) {
  const Setting all[] = {{"tangents in the file", true, false, vec3(1)},
                         {"generated tangents", false, false, vec3(1)},
                         {"mirrored texture, tangents in the file", true, true, vec3(1)},
                         {"mirrored texture, generated tangents", false, true, vec3(1)},
                         {"mirrored node, tangents in the file", true, false, {-1, 1, 1}},
                         {"mirrored node, generated tangents", false, false, {-1, 1, 1}},
                         {"node mirrored upside down, generated tangents", false, false, {1, -1, 1}},
                         {"mirrored texture and node, generated tangents", false, true, {-1, 1, 1}}};
  for (const Setting& s : all)
    for (const vec3& light : {glm::normalize(vec3(0.8f, 0, 0.6f)), glm::normalize(vec3(0, 0.8f, 0.6f))}) {
      SCOPED_TRACE(std::string(s.name) + (light.x > 0 ? ", lit from the right" : ", lit from above"));
      const scene::Scene scene = bumps(s, map, light);
      const Question q{.camera = scene::lookAt({0, 0, 2}, {0, 0, 0}, 0.45f), .size = {64, 64}};
      expectBoth(scene, q,
                 [&](const dvec3& p, const dvec3&) {
                   if (std::max(std::abs(p.x), std::abs(p.y)) > 0.48)
                     return nothing;  // the border's texels wrap
                   // World to the picture: both scale by +-1.
                   const dvec2 way(double(s.scale.x) * (s.mirroredTexture ? -1 : 1), double(s.scale.y));
                   const dvec2 gradient = way * slope(way * dvec2(p) + 0.5);
                   const dvec3 n = glm::normalize(dvec3(-gradient, 1));
                   return kGrey / M_PI * kIrradiance * std::max(glm::dot(n, dvec3(light)), 0.0);
                 },
                 {.pixels = 1500});
    }
}

TEST_F(NormalMapTruth, ABumpLitFromTheSideIsTheSurfaceItStandsFor) {
  expectTheSurface(Map::normals);
}

TEST_F(NormalMapTruth, AHeightMapLitFromTheSideIsTheSurfaceThatItHolds) {
  expectTheSurface(Map::heights);
}

/// A field that slopes along v alone, v downwards: its surface faces up where heights rise down the picture.
TEST_F(NormalMapTruth, ASlopeAlongVIsBrighterFromTheSideThatItFaces) {
  constexpr double rise = 0.5;
  test::GltfBuilder b;
  std::vector<std::uint16_t> values;
  for (int row = 0; row < kTexels; ++row) values.push_back(static_cast<std::uint16_t>(1024 * row));
  b.texturedMaterial(test::png16(1, kTexels, values));
  b.append("samplers", {{"wrapS", 33071}, {"wrapT", 33071}});
  b.root["textures"][0]["sampler"] = 0;
  b.root["materials"][0] = {
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {kGrey, kGrey, kGrey, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
      {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}},
      {"extras", {{"limn_height", {{"texture", {{"index", 0}}}, {"scale", rise * 65535 / 65536}}}}}};
  const json attributes = {
      {"POSITION", b.vec3({{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}})},
      {"NORMAL", b.vec3(std::vector<vec3>(4, {0, 0, 1}))},
      {"TEXCOORD_0", b.vec2({{0, 1}, {1, 1}, {1, 0}, {0, 0}})}};
  b.meshNode(b.mesh(attributes, b.indices({0, 1, 2, 0, 2, 3}), 0));
  for (const float side : {1.f, -1.f}) {
    SCOPED_TRACE(side > 0 ? "lit from above" : "lit from below");
    const vec3 light = glm::normalize(vec3(0, side * 0.8f, 0.6f));
    scene::Scene scene = test::loadBuilt(b);
    test::shine(scene, test::lamp(glsl::light_directional, float(kIrradiance)), vec3(0), -light);
    const Question q{.camera = scene::lookAt({0, 0, 2}, {0, 0, 0}, 0.45f), .size = {64, 64}};
    expectBoth(scene, q,
               [&](const dvec3& p, const dvec3&) {
                 if (std::max(std::abs(p.x), std::abs(p.y)) > 0.47)
                   return nothing;  // half slopes at the edge
                 const dvec3 n = glm::normalize(dvec3(0, rise, 1));
                 return kGrey / M_PI * kIrradiance * std::max(glm::dot(n, dvec3(light)), 0.0);
               },
               {.pixels = 1500});
  }
}

}  // namespace
}  // namespace limn
