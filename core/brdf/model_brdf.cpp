#include "core/brdf/model_brdf.h"

#include <algorithm>
#include <iterator>
#include <list>
#include <mutex>
#include <span>
#include <utility>

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

/// Is a fit, and what it is of. A measured model's table is a copy, which outlives the scene.
struct KeptFit {
  glsl::MaterialModel model;
  std::vector<glm::vec3> table;
  FitSettings settings;
  std::shared_ptr<const FactoredBrdf> fit;

  std::size_t bytes() const {
    std::size_t values = table.size();
    for (const FactorTable& factor : fit->tables) values += factor.texels.size();
    return values * sizeof(glm::vec3);
  }
};

/// Holds the fits of this process, the one that was asked for last first.
class KeptFits {
 public:
  /// Returns null where there is none of these.
  std::shared_ptr<const FactoredBrdf> find(const glsl::MaterialModel& model, std::span<const glm::vec3> table,
                                           const FitSettings& settings) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(fits_, [&](const KeptFit& kept) {
      return kept.settings == settings && sameNumbers(kept.model, model) &&
             std::ranges::equal(kept.table, table);
    });
    if (found == fits_.end()) return nullptr;
    fits_.splice(fits_.begin(), fits_, found);
    return found->fit;
  }
  void add(KeptFit made) {
    const std::lock_guard lock(mutex_);
    fits_.push_front(std::move(made));
    std::size_t bytes = 0;
    for (auto fit = std::next(fits_.begin()); fit != fits_.end(); ++fit) {
      bytes += fit->bytes();
      if (bytes <= kKeptFitBytes) continue;
      fits_.erase(fit, fits_.end());
      return;
    }
  }

 private:
  std::mutex mutex_;
  std::list<KeptFit> fits_;
};

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
  static KeptFits kept;
  std::span<const glm::vec3> table;
  if (model.kind == glsl::model_measured) table = tableOf(model, measured);
  if (auto found = kept.find(model, table, settings)) return found;
  auto fit = std::make_shared<const FactoredBrdf>(fitBrdf(modelBrdf(model, measured), settings));
  kept.add({model, {table.begin(), table.end()}, settings, fit});
  return fit;
}

}  // namespace limn::brdf
