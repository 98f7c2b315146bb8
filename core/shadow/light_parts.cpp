#include "core/shadow/private/light_parts.h"

#include <algorithm>
#include <cmath>

#include "core/shadow/light_fit.h"
#include "core/shadow/private/light_window.h"
#include "core/shadow/private/pyramid_fit.h"
#include "glsl/light/light_part.glsl"
#include "glsl/shadow/shadow_view.glsl"

namespace limn::shadow {

using glm::vec3;
using scene::Bounds;

namespace {

/// Whether each of several views may have a part of the light.
bool isDivisible(const glsl::Light& light, const ShadowMapDesc& desc) {
  return desc.views != 1 && desc.samples.empty() && glsl::light_has_extent(light) && desc.lightSize != 0;
}

/// The width of the light's kernel, texels, before blockers half way between it and the middle of the scene.
float kernelTexels(const glsl::Light& light, const LightLayout& layout, std::span<const Bounds> boxes,
                   const ShadowMapDesc& desc) {
  const vec3 spread = spreadOf(light, axesOf(light), desc.lightSize);
  const float width = 2 * std::max(spread.x, spread.y);
  const auto size = static_cast<float>(desc.size);
  // The scene is as deep as the map is wide.
  if (layout.projection == glsl::shadow_orthographic) return 0.5f * size * width;
  Bounds all;
  for (const Bounds& box : boxes) all.add(box);
  if (all.empty()) return 0;
  const vec3 origin(light.position);
  const float tangent = wholeWindow(light, origin, axesOf(light), layout, boxes, desc).high.x;
  return size * width / (2 * tangent * glm::distance(origin, all.centre()));
}

/// The views of a light that chooses their number. Lights that stand for an environment are many, and each is
/// a part already.
uint32_t viewsOf(const glsl::Light& light, const LightLayout& layout, std::span<const Bounds> boxes,
                 const ShadowMapDesc& desc) {
  if ((light.flags & glsl::light_flag_environment) != 0) return 1;
  return kernelTexels(light, layout, boxes, desc) > kWideKernel ? 2 : 1;
}

}  // namespace

glm::uvec2 partsAlongSides(const glsl::Light& light, const LightLayout& layout, std::span<const Bounds> boxes,
                           const ShadowMapDesc& desc) {
  if (!isDivisible(light, desc)) return glm::uvec2(1);
  const auto views = desc.views > 0 ? static_cast<uint32_t>(desc.views) : viewsOf(light, layout, boxes, desc);
  if (glsl::light_kind(light) == glsl::light_kind_disc) return glm::uvec2(views);
  const glm::vec2 sides = glsl::light_sides(light, glsl::light_kind(light), desc.lightSize);
  const float longer = std::max(sides.x, sides.y);
  if (!(longer > 0)) return glm::uvec2(1);
  return glm::uvec2(glm::max(glm::ceil(static_cast<float>(views) * sides / longer - 1e-3f), 1.f));
}

std::vector<glsl::Light> partsOf(const glsl::Light& light, const LightLayout& layout,
                                 const ShadowMapDesc& desc) {
  std::vector<glsl::Light> parts;
  for (uint32_t i = 0; i < layout.parts(); ++i)
    parts.push_back(glsl::light_part(light, layout.kind, desc.lightSize, {layout.partsU, layout.partsV}, i));
  return parts;
}

std::optional<MapWindow> partWindow(const glsl::Light& light, const glsl::Light& part,
                                    const LightLayout& layout, std::span<const Bounds> boxes,
                                    const ShadowMapDesc& desc) {
  const uint32_t count = glsl::shadow_face_count(layout.faces);
  if (layout.projection != glsl::shadow_perspective || count > 2) return {};
  const MapAxes axes = axesOf(light);
  const MapWindow whole = wholeWindow(light, light.position, axes, layout, boxes, desc);
  const vec3 r = part.position - light.position;
  const glm::vec2 shift =
      glm::vec2(glm::dot(axes.x, r), glm::dot(axes.y, r)) / std::max(whole.near, 0.125f * whole.far);
  const glm::vec2 low = whole.low - glm::max(shift, 0.f);
  const glm::vec2 high = low + (whole.high - whole.low) + std::max(std::abs(shift.x), std::abs(shift.y));
  const float tangent = std::max({-low.x, -low.y, high.x, high.y});
  const DepthRange range = widened(pyramidRange(part.position, axes, count, 5, tangent, boxes));
  return MapWindow{low, high, range.near, range.far};
}

}  // namespace limn::shadow
