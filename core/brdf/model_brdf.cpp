#include "core/brdf/model_brdf.h"

#include "glsl/materials/model.glsl"

namespace limn::brdf {

Brdf modelBrdf(const glsl::MaterialModel& model, const std::vector<glm::vec3>& measured) {
  return [&measured, model](const glm::dvec3& l, const glm::dvec3& v) {
    return glm::dvec3(glsl::model_response(measured, model, glm::vec3(v), glm::vec3(l))) / l.z;
  };
}

}  // namespace limn::brdf
