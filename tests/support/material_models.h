// A material model of every kind and option.
#pragma once

#include <string>
#include <vector>

#include "glsl/materials/model.glsl"

namespace limn::test {

struct NamedModel {
  std::string name;
  glsl::MaterialModel model;
};

inline std::vector<NamedModel> materialModels() {
  glsl::MaterialModel plain{};
  plain.eta = glm::vec3(1.5f);
  plain.ks = glm::vec3(1);
  plain.roughness = glm::vec2(0.3f);
  plain.exponent = 32;
  const auto with = [&](uint32_t kind, uint32_t options, const auto& change) {
    glsl::MaterialModel m = plain;
    m.kind = kind;
    m.options = options;
    change(m);
    return m;
  };
  const auto copper = [](glsl::MaterialModel& m) {
    m.eta = {0.2f, 0.92f, 1.1f};
    m.k = {3.91f, 2.45f, 2.14f};
  };
  const auto painted = [](glsl::MaterialModel& m) {
    m.kd = {0.3f, 0.2f, 0.1f};
    m.ks = glm::vec3(0.2f);
  };
  const auto none = [](glsl::MaterialModel&) {};
  using namespace glsl;
  return {{"copper", with(model_torrance_sparrow, 0, copper)},
          {"gaussian", with(model_torrance_sparrow, model_option_gaussian, copper)},
          {"product", with(model_torrance_sparrow, model_option_product, none)},
          {"brushed", with(model_ward, 0,
                           [&](MaterialModel& m) {
                             copper(m);
                             m.roughness = {0.15f, 0.5f};
                           })},
          {"hair", with(model_banks, 0, painted)},
          {"hair as printed", with(model_banks, model_option_printed, painted)},
          {"phong", with(model_phong, 0, painted)},
          {"varnish", with(model_coated, model_option_physical, painted)}};
}

}  // namespace limn::test
