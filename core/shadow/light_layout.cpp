#include <algorithm>
#include <cmath>

#include "core/shadow/light_fit.h"
#include "core/shadow/private/light_parts.h"
#include "core/shadow/private/light_window.h"
#include "core/shadow/private/pyramid_fit.h"

namespace limn::shadow {

using glm::vec3;
using scene::Bounds;

namespace {

bool twoSided(const glsl::Light& light) {
  return (light.flags & glsl::light_flag_two_sided) != 0;
}

/// The layout of a light that is not cut.
LightLayout fitWhole(const glsl::Light& light, std::span<const Bounds> boxes, const ShadowMapDesc& desc) {
  const uint32_t kind = glsl::light_kind(light);
  if (light.type == glsl::light_directional)
    return {glsl::shadow_orthographic, glsl::shadow_faces_single, kind};
  const LightLayout cube{glsl::shadow_perspective, glsl::shadow_faces_cube, kind};
  const LightLayout single{glsl::shadow_perspective, glsl::shadow_faces_single, kind};
  if (light.type == glsl::light_point || desc.projection == Projection::cube) return cube;
  if (light.type == glsl::light_spot) return hasCone(light) ? single : cube;

  const MapAxes axes = axesOf(light);
  const bool both = twoSided(light);
  float tangent = 0;
  for (const glm::vec2& sample : samplesOf(light, desc)) {
    const vec3 origin = samplePoint(light, sample);
    tangent = std::max(tangent, fittedTangent(origin, axes, boxes));
    if (both) tangent = std::max(tangent, fittedTangent(origin, faceAxes(axes, 5), boxes));
  }
  if (tangent <= std::tan(kLargestHalfAngle) || (!both && hasCone(light) && desc.samples.empty()))
    return both ? LightLayout{glsl::shadow_perspective, glsl::shadow_faces_pair, kind} : single;
  return both ? cube : LightLayout{glsl::shadow_perspective, glsl::shadow_faces_hemicube, kind};
}

}  // namespace

std::vector<glm::vec2> samplesOf(const glsl::Light& light, const ShadowMapDesc& desc) {
  if (desc.samples.empty()) return {glm::vec2(0.5f)};
  return glsl::light_has_extent(light) ? desc.samples : std::vector<glm::vec2>{glm::vec2(0.5f)};
}

LightLayout fitLayout(const glsl::Light& light, std::span<const Bounds> boxes, const ShadowMapDesc& desc) {
  std::vector<Bounds> kept;
  const std::span<const Bounds> lit = withinRange(light, boxes, desc, kept);
  LightLayout layout = fitWhole(light, lit, desc);
  const glm::uvec2 parts = partsAlongSides(light, layout, lit, desc);
  layout.partsU = parts.x;
  layout.partsV = parts.y;
  return layout;
}

}  // namespace limn::shadow
