#include "core/brdf/measured_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "glsl/materials/measured.glsl"

namespace limn::brdf {
namespace {

constexpr int kViews = 8;     ///< from head-on to grazing, of equal share in hemispherical light
constexpr int kAzimuths = 4;  ///< of a table that depends on it
constexpr int kSteps = 48;    ///< along each side of the half vectors that a view's albedo sums over
constexpr int kMostNodes = 1023;

uint32_t nodesOf(const glm::ivec3& size) {
  if (std::max({size.x, size.y, size.z}) > kMostNodes || size.x < 1)
    throw Error(fmt::format("a table of {} x {} x {} nodes; 1 to {} are accepted", size.x, size.y, size.z,
                            kMostNodes));
  return glsl::measured_nodes(glm::uvec3(size));
}

/// Fills in what the table reflects, by views at `azimuths` azimuths.
MeasuredModel measure(const BrdfFunction& f, int azimuths) {
  MeasuredModel out;
  out.model.kind = glsl::model_measured;
  out.model.ks = glm::vec3(1);
  out.model.roughness = glm::vec2(1);
  glm::dvec3 mean(0);
  for (int i = 0; i < kViews; ++i) {
    const float cosine = std::sqrt((static_cast<float>(i) + 0.5f) / kViews);
    const float sine = std::sqrt(1 - cosine * cosine);
    for (int j = 0; j < azimuths; ++j) {
      const float azimuth = 2 * glsl::pi * static_cast<float>(j) / static_cast<float>(azimuths);
      const glm::dvec3 share =
          albedoOfBrdf(f, {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine}, kSteps);
      out.largestAlbedo =
          std::max(out.largestAlbedo, static_cast<float>(std::max({share.x, share.y, share.z})));
      mean += share / static_cast<double>(kViews * azimuths);
    }
  }
  out.model.k = glm::vec3(mean);
  out.model.kd = out.model.k;
  return out;
}

/// Returns f of head-on views by light at that angle from the normal, radians.
glm::vec3 headOn(const TabulatedBrdf& table, float angle) {
  return table.evaluate({std::sin(angle), 0, std::cos(angle)}, {0, 0, 1});
}

/// Returns the width of the GGX lobe that falls to half of its peak where the table does, 1 where it never
/// does. f is as D / cos(l), and D of GGX as (1 + tan^2 / alpha^2)^-2 / cos^4 of the half vector's angle; the
/// power is 1/2 at tan = 0.644 alpha.
float lobeWidth(const TabulatedBrdf& table, const glm::vec3& floor) {
  const auto slopes = [&](float halfAngle) {
    const glm::vec3 f = headOn(table, 2 * halfAngle) - floor;
    return (f.x + f.y + f.z) * std::cos(2 * halfAngle) * std::pow(std::cos(halfAngle), 4.f);
  };
  constexpr float kStep = 0.002f, kLast = 0.75f;  // radians; light at twice that is still above the horizon
  const float peak = slopes(0);
  if (!(peak > 0)) return 1;
  for (float angle = kStep; angle < kLast; angle += kStep)
    if (slopes(angle) < 0.5f * peak)
      return std::clamp(std::tan(angle) / 0.644f, glsl::model_min_roughness, 1.f);
  return 1;
}

}  // namespace

MeasuredModel measuredModel(const TabulatedBrdf& table) {
  const uint32_t nodes = nodesOf(table.size);
  MeasuredModel out = measure([&](const auto& l, const auto& v) { return table.evaluate(l, v); }, 1);
  out.model.nodes = nodes;
  glm::vec3 floor = headOn(table, 0);
  for (const float degrees : {40.f, 50.f, 60.f, 70.f})
    floor = glm::min(floor, headOn(table, glm::radians(degrees)));
  out.model.roughness = glm::vec2(lobeWidth(table, floor));
  out.model.kd = glm::min(glsl::pi * floor, out.model.k);
  return out;
}

MeasuredModel measuredModel(const AnisotropicTable& table) {
  const uint32_t nodes = nodesOf({table.size, 0, 0});
  MeasuredModel out = measure([&](const auto& l, const auto& v) { return table.evaluate(l, v); }, kAzimuths);
  out.model.nodes = nodes;
  out.model.options = glsl::model_option_pairs;
  return out;
}

}  // namespace limn::brdf
