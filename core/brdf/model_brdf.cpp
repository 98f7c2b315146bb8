#include "core/brdf/model_brdf.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdint>

#include "core/base/error.h"
#include "core/base/kept_results.h"
#include "glsl/materials/model.glsl"

namespace limn::brdf {
namespace {

/// Returns the values of a measured model's table.
std::span<const glm::vec3> tableOf(const glsl::MaterialModel& model, const std::vector<glm::vec3>& measured) {
  const glm::uvec3 size = glsl::measured_size(model.nodes);
  const std::size_t n = size.x;
  const bool pairs = (model.options & glsl::model_option_pairs) != 0;
  return std::span(measured).subspan(model.table, pairs ? n * n * n * n : n * size.y * size.z);
}

/// Says whether two models have the same numbers, wherever their tables lie.
bool sameNumbers(const glsl::MaterialModel& a, const glsl::MaterialModel& b) {
  return a.kind == b.kind && a.eta == b.eta && a.k == b.k && a.kd == b.kd && a.ks == b.ks &&
         a.exponent == b.exponent && a.options == b.options && a.roughness == b.roughness &&
         a.nodes == b.nodes;
}

/// Tells fits apart.
struct FitKey {
  glsl::MaterialModel model;
  uint64_t low = 0, high = 0;  ///< hash of a measured model's table
  FitSettings settings;

  bool operator==(const FitKey& other) const {
    return low == other.low && high == other.high && settings == other.settings &&
           sameNumbers(model, other.model);
  }
};

FitKey keyOf(const glsl::MaterialModel& model, const std::vector<glm::vec3>& measured,
             const FitSettings& settings) {
  FitKey key{.model = model, .settings = settings};
  if (model.kind != glsl::model_measured) return key;
  const std::span<const glm::vec3> table = tableOf(model, measured);
  const XXH128_hash_t hash = XXH3_128bits(table.data(), table.size_bytes());
  key.low = hash.low64;
  key.high = hash.high64;
  return key;
}

/// Returns what a fit takes here, where texels are floats whatever their format.
std::size_t memoryOf(const FactoredBrdf& fit) {
  std::size_t texels = 0;
  for (const FactorTable& table : fit.tables) texels += table.texels.size();
  return texels * sizeof(glm::vec3);
}

}  // namespace

Brdf modelBrdf(const glsl::MaterialModel& model, const std::vector<glm::vec3>& measured) {
  return [&measured, model](const glm::dvec3& l, const glm::dvec3& v) {
    return glm::dvec3(glsl::model_response(measured, model, glm::vec3(v), glm::vec3(l))) / l.z;
  };
}

bool sameModel(const glsl::MaterialModel& a, const glsl::MaterialModel& b,
               const std::vector<glm::vec3>& measured) {
  if (!sameNumbers(a, b)) return false;
  return a.kind != glsl::model_measured || a.table == b.table ||
         std::ranges::equal(tableOf(a, measured), tableOf(b, measured));
}

std::shared_ptr<const FactoredBrdf> fitModel(const glsl::MaterialModel& model,
                                             const std::vector<glm::vec3>& measured,
                                             const FitSettings& settings) {
  static KeptResults<FitKey, FactoredBrdf> kept(kKeptFitBytes, memoryOf);
  return kept.of(keyOf(model, measured, settings),
                 [&] { return fitBrdf(modelBrdf(model, measured), settings); });
}

std::vector<std::shared_ptr<const FactoredBrdf>> fitModels(std::span<const glsl::MaterialModel> models,
                                                           const std::vector<glm::vec3>& measured,
                                                           const FitSettings& settings) {
  std::vector<std::shared_ptr<const FactoredBrdf>> fits(models.size());
  const auto fit = [&](std::size_t i) {
    try {
      // Else a thread that waits for a part of this fit would begin others meanwhile, one within another.
      tbb::this_task_arena::isolate([&] { fits[i] = fitModel(models[i], measured, settings); });
    } catch (const UsageError&) {
      throw;
    } catch (const Error&) {
      // black
    }
  };
  // One after the other where each takes up to 144 MB meanwhile.
  if (settings.factorisation == Factorisation::svd)
    for (std::size_t i = 0; i < fits.size(); ++i) fit(i);
  else
    tbb::parallel_for(std::size_t{0}, fits.size(), fit);
  return fits;
}

}  // namespace limn::brdf
