#include "core/brdf/model_brdf.h"

#include <algorithm>
#include <cstddef>
#include <span>

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

}  // namespace

Brdf modelBrdf(const glsl::MaterialModel& model, const std::vector<glm::vec3>& measured) {
  return [&measured, model](const glm::dvec3& l, const glm::dvec3& v) {
    return glm::dvec3(glsl::model_response(measured, model, glm::vec3(v), glm::vec3(l))) / l.z;
  };
}

bool sameModel(const glsl::MaterialModel& a, const glsl::MaterialModel& b,
               const std::vector<glm::vec3>& measured) {
  if (a.kind != b.kind || a.eta != b.eta || a.k != b.k || a.kd != b.kd || a.ks != b.ks ||
      a.exponent != b.exponent || a.options != b.options || a.roughness != b.roughness || a.nodes != b.nodes)
    return false;
  return a.kind != glsl::model_measured || a.table == b.table ||
         std::ranges::equal(tableOf(a, measured), tableOf(b, measured));
}

}  // namespace limn::brdf
