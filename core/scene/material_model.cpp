#include "core/scene/material_model.h"

#include <algorithm>
#include <cmath>

#include "glsl/materials/model.glsl"
#include "glsl/surface/reflectance.glsl"

namespace limn::scene {
namespace {

/// The perceptual roughness of the metal that is about as wide.
float nearestRoughness(const glsl::MaterialModel& m) {
  if (m.kind == glsl::model_phong) return std::pow(2.f * m.exponent + 1.f, -0.25f);
  if (m.kind == glsl::model_torrance_sparrow || m.kind == glsl::model_ward || m.kind == glsl::model_measured)
    return std::sqrt(std::max(m.roughness.x, m.roughness.y));
  return 1;
}

}  // namespace

float modelExcess(const glsl::MaterialModel& model) {
  return glsl::model_excess(model);
}

void setModel(Material& material, const glsl::MaterialModel& model) {
  material.model = model;
  material.metalRoughTexture = {};
  if (material.alphaCutoff == 0) material.baseColourTexture = {};
  material.transmission = 0;
  const glm::vec3 albedo = glm::clamp(glsl::model_albedo(model), 0.f, 1.f);
  const glm::vec3 f0 = (albedo - glsl::mean_schlick_weight) / (1 - glsl::mean_schlick_weight);
  material.baseColour = glm::vec4(glm::clamp(f0, 0.f, 1.f), material.baseColour.a);
  material.metallic = 1;
  material.roughness = nearestRoughness(model);
  material.specularFactor = 1;
  material.specularColour = glm::vec3(1);
}

}  // namespace limn::scene
