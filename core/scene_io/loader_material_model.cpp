// The models of extras.limn_material (glsl/materials).
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/brdf/measured_file.h"
#include "core/brdf/measured_model.h"
#include "core/scene/material_model.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

struct ModelName {
  const char* name;
  uint32_t kind;
};
constexpr std::array<ModelName, 6> kModels{{{"torrance_sparrow", glsl::model_torrance_sparrow},
                                            {"ward", glsl::model_ward},
                                            {"banks", glsl::model_banks},
                                            {"phong", glsl::model_phong},
                                            {"coated", glsl::model_coated},
                                            {"measured", glsl::model_measured}}};

/// A choice between texts: the bit that each stands for.
struct Option {
  const char* name;
  uint32_t bit;
};
struct Choice {
  const char* key;
  std::vector<Option> options;
};
const std::vector<Choice>& choices() {
  static const std::vector<Choice> all{
      {"distribution", {{"beckmann", 0}, {"gaussian", glsl::model_option_gaussian}}},
      {"masking", {{"correlated", 0}, {"product", glsl::model_option_product}}},
      {"banks", {{"stalling", 0}, {"printed", glsl::model_option_printed}}},
      {"combine",
       {{"sum", 0}, {"blend", glsl::model_option_blend}, {"physical", glsl::model_option_physical}}}};
  return all;
}

template <class Range>
std::string namesOf(const Range& entries) {
  std::vector<std::string> names;
  names.reserve(std::size(entries));
  for (const auto& entry : entries) names.emplace_back(entry.name);
  return joined(names);
}

constexpr double kMostIndex = 1000, kMostExponent = 1e6;
constexpr float kLeastIndex = 1e-3f;
/// OpenGL's storage buffers have 128 MiB at least, of 12 bytes a value.
constexpr std::size_t kMostMeasuredValues = (128u << 20) / 12;

}  // namespace

glsl::MaterialModel Loader::readModel(const tinygltf::Value& extras, const std::string& what) {
  if (!extras.IsObject() || !extras.Get("model").IsString())
    fail(fmt::format("{}: an object with a model is accepted: {}", what, namesOf(kModels)));
  const auto& name = extras.Get("model").Get<std::string>();
  const auto* found = std::ranges::find(kModels, name, &ModelName::name);
  if (found == kModels.end())
    fail(fmt::format("{} model: '{}'; {} are accepted", what, oneLine(name, 40), namesOf(kModels)));
  glsl::MaterialModel m{};
  m.kind = found->kind;
  const bool measured = m.kind == glsl::model_measured;
  if (measured) m = readMeasured(extras.Get("file"), what + " file");

  const auto colour = [&](const char* key, float absent, double low, double high) {
    if (!extras.Has(key)) return glm::vec3(absent);
    const tinygltf::Value& value = extras.Get(key);
    const std::string place = fmt::format("{} {}", what, key);
    if (value.IsNumber()) return glm::vec3(ranged(value.GetNumberAsDouble(), low, high, place));
    const std::vector<float> rgb = numbers(value, 3, place);
    glm::vec3 out;
    for (int c = 0; c < 3; ++c) out[c] = ranged(rgb[static_cast<size_t>(c)], low, high, place);
    return out;
  };
  if (measured) {
    m.ks = colour("ks", 1, 0, 1) * m.ks;
    m.kd *= m.ks;
    m.k *= m.ks;
    return m;
  }
  m.eta = colour("eta", 1.5f, kLeastIndex, kMostIndex);
  m.k = colour("k", 0, 0, kMostIndex);
  const bool reflects = m.kind == glsl::model_phong || m.kind == glsl::model_banks;
  m.kd = colour("kd", m.kind == glsl::model_coated ? 0.5f : 0.f, 0, 1);
  m.ks = colour("ks", reflects ? 0.5f : 1.f, 0, 1);
  const tinygltf::Value& roughness = extras.Get("roughness");
  if (roughness.IsArray()) {
    const std::vector<float> both = numbers(roughness, 2, what + " roughness");
    m.roughness = {ranged(both[0], 0, 1, what + " roughness"), ranged(both[1], 0, 1, what + " roughness")};
  } else {
    m.roughness = glm::vec2(
        ranged(roughness.IsNumber() ? roughness.GetNumberAsDouble() : 0.3, 0, 1, what + " roughness"));
  }
  const tinygltf::Value& exponent = extras.Get("exponent");
  m.exponent =
      ranged(exponent.IsNumber() ? exponent.GetNumberAsDouble() : 32, 0, kMostExponent, what + " exponent");
  for (const Choice& choice : choices()) {
    if (!extras.Has(choice.key)) continue;
    const tinygltf::Value& value = extras.Get(choice.key);
    const std::string chosen = value.IsString() ? value.Get<std::string>() : "";
    const auto option = std::ranges::find(choice.options, chosen, &Option::name);
    if (option == choice.options.end())
      fail(fmt::format("{} {}: '{}'; {} are accepted", what, choice.key, oneLine(chosen, 40),
                       namesOf(choice.options)));
    m.options |= option->bit;
  }
  limitEnergy(m, what);
  return m;
}

glsl::MaterialModel Loader::readMeasured(const tinygltf::Value& file, const std::string& what) {
  if (!file.IsString()) fail(what + ": the name of a file of measured reflectance is expected");
  const auto& uri = file.Get<std::string>();
  const auto known = measured_.find(uri);
  if (known != measured_.end()) return known->second;
  const std::vector<std::byte> bytes = readUri(uri, what, brdf::kLargestMeasuredFile);
  const std::string named = isDataUri(uri) ? what : fmt::format("{} '{}'", what, oneLine(uri, 80));
  brdf::MeasuredModel out;
  std::vector<glm::vec3> values;
  try {
    std::visit(
        [&](auto&& table) {
          out = brdf::measuredModel(table);
          values = std::move(table.values);
        },
        brdf::decodeMeasured(bytes, named));
  } catch (const Error& error) {
    fail(error.what());
  }
  if (values.size() > kMostMeasuredValues - scene_.measured.size())
    fail(fmt::format("{}: {} values more; a scene can hold {} of measured reflectance", what, values.size(),
                     kMostMeasuredValues));
  spend(3 * values.size(), what);
  out.model.table = static_cast<uint32_t>(scene_.measured.size());
  scene_.measured.insert(scene_.measured.end(), values.begin(), values.end());
  if (out.largestAlbedo > 1) {
    out.model.ks /= out.largestAlbedo;
    warn(fmt::format("{} reflects up to {:.3g} times the light, and is divided by that", named,
                     out.largestAlbedo));
  }
  measured_.emplace(uri, out.model);
  return out.model;
}

/// Keeps a model from reflecting more light than there is, where that takes more than numbers in [0, 1].
void Loader::limitEnergy(glsl::MaterialModel& m, const std::string& what) {
  const float most = modelExcess(m);
  if (most <= 1) return;
  m.kd /= most;
  m.ks /= most;
  warn(fmt::format("{}: it would reflect up to {:.3g} times the light; kd and ks are divided by that", what,
                   most));
}

void Loader::applyModel(Material& material, const glsl::MaterialModel& model, const std::string& what) {
  if (material.metalRoughTexture.image != kNone ||
      (material.baseColourTexture.image != kNone && material.alphaCutoff == 0))
    warn(what + ": textures of metallic-roughness have no part in it");
  setModel(material, model);
}

}  // namespace limn::scene
