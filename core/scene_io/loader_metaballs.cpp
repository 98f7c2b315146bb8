// Nodes with extras.limn_metaballs: geometry that is made again for every time.
#include <tiny_gltf.h>

#include <cmath>
#include <utility>

#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

constexpr std::size_t kMaxSources = 16;  ///< in one scene

/// Of a node at rest, from Scene::origin.
glm::mat4 nodeToWorld(const Scene& scene, int node) {
  glm::dmat4 matrix(1);
  for (int n = node; n != kNone; n = scene.nodes[static_cast<std::size_t>(n)].parent) {
    const Node& at = scene.nodes[static_cast<std::size_t>(n)];
    glm::dmat4 local(at.matrix ? *at.matrix : at.transform.matrix());
    local[3] += glm::dvec4(at.base, 0);
    matrix = local * matrix;
  }
  matrix[3] -= glm::dvec4(scene.origin, 0);
  return glm::mat4(matrix);
}

}  // namespace

void Loader::readMetaballs() {
  scene_.dynamic.clear();
  for (std::size_t i = 0; i < fileIndex_.size(); ++i) {
    const auto file = static_cast<std::size_t>(fileIndex_[i]);
    const tinygltf::Node& source = model_->nodes[file];
    if (!visible_[file] || !source.extras.IsObject() || !source.extras.Has("limn_metaballs")) continue;
    const std::string what = fmt::format("node {} limn_metaballs", file);
    if (scene_.dynamic.size() == kMaxSources)
      fail(fmt::format("{}: more than {} such nodes in a scene are not accepted", what, kMaxSources));
    const tinygltf::Value& extras = source.extras.Get("limn_metaballs");
    Metaballs metaballs = readMetaballs(extras, what);
    metaballs.toWorld = nodeToWorld(scene_, static_cast<int>(i));
    const double volume = glm::determinant(glm::dmat3(glm::dmat4(metaballs.toWorld)));
    if (!std::isfinite(volume) || volume == 0) fail(what + ": the node's matrix cannot be inverted");
    const int material = metaballMaterial(extras, what);
    metaballs.tangents = scene_.materials[static_cast<std::size_t>(material)].tangents();
    scene_.dynamic.push_back({.name = source.name, .source = makeMetaballs(metaballs), .material = material});
  }
}

Metaballs Loader::readMetaballs(const tinygltf::Value& extras, const std::string& what) const {
  if (!extras.IsObject()) fail(what + ": an object {count, resolution, radius, seed, material} is accepted");
  for (const std::string& key : extras.Keys())
    if (key != "count" && key != "resolution" && key != "radius" && key != "seed" && key != "material")
      fail(fmt::format("{}: unknown key '{}'; known are count, resolution, radius, seed, material", what,
                       key));
  if (!extras.Has("count")) fail(what + ": the number of balls, 'count', is missing");
  const auto whole = [&](const char* key, std::int64_t otherwise, std::int64_t low, std::int64_t high) {
    if (!extras.Has(key)) return otherwise;
    const tinygltf::Value& value = extras.Get(key);
    const double given = value.IsNumber() ? value.GetNumberAsDouble() : NAN;
    if (!(given >= static_cast<double>(low) && given <= static_cast<double>(high)) ||
        given != std::floor(given))
      fail(fmt::format("{} {}: a whole number in {} .. {} is accepted", what, key, low, high));
    return static_cast<std::int64_t>(given);
  };
  Metaballs m;
  m.count = static_cast<int>(whole("count", m.count, 1, Metaballs::maxCount));
  m.resolution =
      static_cast<int>(whole("resolution", m.resolution, Metaballs::minResolution, Metaballs::maxResolution));
  m.seed = static_cast<uint32_t>(whole("seed", m.seed, 0, UINT32_MAX));
  if (extras.Has("radius")) {
    const tinygltf::Value& radius = extras.Get("radius");
    m.radius = radius.IsNumber() ? static_cast<float>(radius.GetNumberAsDouble()) : NAN;
    if (!(m.radius >= Metaballs::minRadius && m.radius <= Metaballs::maxRadius))
      fail(fmt::format("{} radius: a number in {} .. {} is accepted", what, Metaballs::minRadius,
                       Metaballs::maxRadius));
  }
  return m;
}

int Loader::metaballMaterial(const tinygltf::Value& extras, const std::string& what) {
  if (!extras.Has("material")) return defaultMaterial();
  const tinygltf::Value& material = extras.Get("material");
  const int index = material.IsInt() ? material.GetNumberAsInt() : kNone;
  if (index < 0 || static_cast<std::size_t>(index) >= model_->materials.size())
    fail(fmt::format("{} material: an index of the file's {} materials is accepted", what,
                     model_->materials.size()));
  const Material& chosen = scene_.materials[static_cast<std::size_t>(index)];
  if (chosen.emission != glm::vec3(0) && !chosen.unlit)
    warn(what + " material: its emission is displayed but lights nothing");
  return untexturedMaterial(index, what);
}

int Loader::untexturedMaterial(int index, const std::string& what) {
  if (!scene_.materials[static_cast<std::size_t>(index)].textured()) return index;
  const auto [known, added] = untextured_.emplace(index, static_cast<int>(scene_.materials.size()));
  if (!added) return known->second;
  warn(what + " material: balls have no texture coordinates; its textures are left out");
  Material plain = scene_.materials[static_cast<std::size_t>(index)];
  plain.baseColourTexture = plain.metalRoughTexture = plain.normalTexture = plain.emissiveTexture = {};
  plain.height = kNone;
  scene_.materials.push_back(std::move(plain));
  uvUses_.push_back({});
  return known->second;
}

}  // namespace limn::scene
