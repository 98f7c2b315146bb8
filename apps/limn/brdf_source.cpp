#include "apps/limn/brdf_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/brdf/groove.h"
#include "core/brdf/measured_file.h"
#include "core/brdf/model_brdf.h"
#include "core/scene_io/load.h"
#include "core/session/find.h"
#include "glsl/materials/model.glsl"
#include "glsl/surface/brdf.glsl"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

using glm::dvec3;
using glm::vec3;

constexpr const char* kModels = "metal:ALPHA, plastic:ALPHA and groove";

brdf::Brdf metallicRoughness(const glsl::SurfaceBrdf& surface) {
  return [surface](const dvec3& l, const dvec3& v) {
    return dvec3(glsl::brdf(surface, vec3(0, 0, 1), vec3(v), vec3(l)));
  };
}

/// The renderer's own metal (copper's colour) and plastic, of width ALPHA.
BrdfSource glossy(const std::string& source, bool metal, const std::string& width) {
  const std::optional<double> alpha = parseNumber(width);
  if (!alpha || !(*alpha >= 1e-3 && *alpha <= 1))
    throw UsageError(fmt::format("model '{}' is not accepted; expected an ALPHA from 0.001 to 1", source));
  const vec3 colour = metal ? vec3(0.95f, 0.64f, 0.54f) : vec3(0.6f, 0.3f, 0.1f);
  return {.name = source,
          .kind = fmt::format("metallic-roughness, {}, alpha {}", metal ? "metal" : "plastic", *alpha),
          .f = metallicRoughness(glsl::surface_brdf(colour, metal ? 1.0f : 0.0f,
                                                    std::sqrt(static_cast<float>(*alpha)), 1, vec3(1), 1.5f)),
          .isotropic = true,
          .nodes = {},
          .largest = 0,
          .bytes = 0};
}

BrdfSource groove(const std::string& source) {
  const auto simulated = std::make_shared<const brdf::GrooveBrdf>(brdf::Groove{});
  return {.name = source,
          .kind = "V-grooves of two colours, simulated",
          .f = [simulated](const dvec3& l, const dvec3& v) { return simulated->evaluate(l, v); },
          .isotropic = false,
          .nodes = {},
          .largest = 0,
          .bytes = 0};
}

template <class Table>
BrdfSource measured(const fs::path& file, Table read, const std::string& kind,
                    const std::vector<int>& nodes) {
  const auto table = std::make_shared<const Table>(std::move(read));
  float largest = 0;
  for (const vec3& f : table->values) largest = std::max({largest, f.x, f.y, f.z});
  return {.name = file.string(),
          .kind = kind,
          .f = [table](const dvec3& l, const dvec3& v) { return dvec3(table->evaluate(vec3(l), vec3(v))); },
          .isotropic = std::is_same_v<Table, brdf::TabulatedBrdf>,
          .nodes = nodes,
          .largest = static_cast<double>(largest),
          .bytes = table->values.size() * sizeof(vec3)};
}

BrdfSource fromFile(const fs::path& file) {
  brdf::MeasuredBrdf read = brdf::readMeasured(file);
  if (auto* isotropic = std::get_if<brdf::TabulatedBrdf>(&read)) {
    const glm::ivec3 size = isotropic->size;
    return measured(file, std::move(*isotropic), "measured, over half and difference angles",
                    {size.x, size.y, size.z});
  }
  auto& pairs = std::get<brdf::AnisotropicTable>(read);
  const int side = pairs.size;
  return measured(file, std::move(pairs), "measured, over two directions", {side, side, side, side});
}

BrdfSource fromScene(const fs::path& nameOrFile, const std::string& name) {
  const scene::Scene scene = scene::load(session::findScene(nameOrFile));
  for (const std::string& warning : scene.warnings) warn(warning);
  std::vector<std::string> names;
  for (const scene::Material& material : scene.materials) names.push_back(material.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw UsageError(fmt::format("{}: no material '{}'{}; it has {}", nameOrFile.string(), oneLine(name, 60),
                                 didYouMean(name, names), names.empty() ? "none" : joined(names)));
  const scene::Material& material = scene.materials[static_cast<std::size_t>(found - names.begin())];
  BrdfSource source{.name = fmt::format("{} of {}", name, nameOrFile.string()),
                    .kind = "metallic-roughness",
                    .f = {},
                    .isotropic = true,
                    .nodes = {},
                    .largest = 0,
                    .bytes = 0};
  if (material.model) {
    const glsl::MaterialModel model = *material.model;
    source.kind = "extras.limn_material";
    source.isotropic = !glsl::model_anisotropic(model);
    const auto measured = std::make_shared<const std::vector<vec3>>(scene.measured);
    source.f = [measured, f = brdf::modelBrdf(model, *measured)](const dvec3& l, const dvec3& v) {
      return f(l, v);
    };
    return source;
  }
  if (material.textured())
    warn(fmt::format("{}: material '{}' has textures, which are taken as white", nameOrFile.string(), name));
  source.f =
      metallicRoughness(glsl::surface_brdf(vec3(material.baseColour), material.metallic, material.roughness,
                                           material.specularFactor, material.specularColour, material.ior));
  return source;
}

}  // namespace

void BrdfChoice::addTo(CLI::App& command) {
  command.add_option("source", source,
                     "File of measured data (MERL .binary, RGL or limn .bsdf), or a model: metal:ALPHA, "
                     "plastic:ALPHA (limn's metallic-roughness of that width) or groove");
  CLI::Option* ofScene =
      command.add_option("--scene", scene, "Scene, whose --material is taken in place of a source");
  CLI::Option* named = command.add_option("--material", material, "Name of the scene's material");
  ofScene->needs(named);
  named->needs(ofScene);
}

BrdfSource openBrdf(const BrdfChoice& choice) {
  if (choice.source.empty() == choice.scene.empty())
    throw UsageError(fmt::format(
        "either a source (a file, or one of {}) or --scene with --material is expected", kModels));
  if (!choice.scene.empty()) return fromScene(choice.scene, choice.material);
  const std::string& source = choice.source;
  if (source == "groove") return groove(source);
  const std::size_t colon = source.find(':');
  const std::string model = source.substr(0, colon);
  if (colon != std::string::npos && (model == "metal" || model == "plastic"))
    return glossy(source, model == "metal", source.substr(colon + 1));
  std::error_code ignored;
  if (!fs::path(source).has_extension() && !fs::exists(source, ignored))
    throw UsageError(fmt::format("'{}' is neither a file of measured data nor a model; known models are {}",
                                 oneLine(source, 60), kModels));
  return fromFile(source);
}

vec3 parseAlbedo(const std::string& flag, const std::string& text) {
  std::vector<float> numbers;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::optional<double> number = parseNumber(part);
    if (!number || !(*number >= 0 && *number <= 1)) {
      numbers.clear();
      break;
    }
    numbers.push_back(static_cast<float>(*number));
  }
  if ((numbers.size() != 1 && numbers.size() != 3) || text.ends_with(','))
    throw UsageError(fmt::format(
        "{} '{}' is not accepted; expected one number or red,green,blue, each from 0 to 1", flag, text));
  return numbers.size() == 1 ? vec3(numbers[0]) : vec3(numbers[0], numbers[1], numbers[2]);
}

}  // namespace limn::app
