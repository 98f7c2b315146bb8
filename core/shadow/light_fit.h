// Which views a light's shadow maps need, fitted to what they must cover. No OpenGL.
#pragma once

#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "core/shadow/shadow_map.h"
#include "core/shadow/visible_scene.h"
#include "glsl/light.glsl"
#include "glsl/shadow_view.glsl"

namespace limn::shadow {

/// Beyond this half angle a perspective map gives way to cube faces, radians.
constexpr float largestHalfAngle = 75.f * glsl::pi / 180.f;
/// near is at least this fraction of far.
constexpr float leastNear = 1e-4f;

/// How a light is covered, whichever the sample on it: the layout of its layers.
struct LightLayout {
  uint32_t projection = glsl::shadow_perspective;
  uint32_t faces = glsl::shadow_faces_single;
  bool operator==(const LightLayout&) const = default;
};

/// `boxes`: world bounds of everything that casts or receives shadows.
LIMN_API LightLayout fitLayout(const glsl::Light& light, std::span<const scene::Bounds> boxes,
                               const ShadowMapDesc& desc);

/// Appends the views of one light, for every sample of `desc` in turn, with layers numbered from
/// views.size(), and one ShadowLight per sample. `visible`: what maps of one view per sample are fitted to
/// with MapFit::view; null: to the boxes.
LIMN_API void appendViews(const glsl::Light& light, uint32_t lightIndex, const LightLayout& layout,
                          std::span<const scene::Bounds> boxes, const ShadowMapDesc& desc,
                          const VisibleScene* visible, std::vector<glsl::ShadowView>& views,
                          std::vector<glsl::ShadowLight>& lights);

/// Samples that need maps of their own: all of `desc`, or the centre for lights without extent.
LIMN_API std::vector<glm::vec2> samplesOf(const glsl::Light& light, const ShadowMapDesc& desc);

/// World planes of a view, for culling.
LIMN_API scene::CullVolume cullVolume(const glsl::ShadowView& view);

}  // namespace limn::shadow
