// Declares which views a light's shadow maps need, fitted to what they must cover. No OpenGL.
#pragma once

#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"
#include "core/shadow/shadow_map.h"
#include "core/shadow/visible_scene.h"
#include "glsl/scene/light.glsl"
#include "glsl/shadow/shadow_view.glsl"

namespace limn::shadow {

/// Limits the half angle of a perspective map, radians; beyond it cube faces are used.
constexpr float kLargestHalfAngle = 75.f * glsl::pi / 180.f;
/// Limits the ratio of near to far from below.
constexpr float kLeastNear = 1e-4f;

/// Limits the kernels of a light that is not cut where it chooses (ShadowMapDesc::views), texels. In wider
/// ones each of 2 x 2 parts has 3 x 3 sub-kernels of 2 x 2 texels, as many as single tests of texels take.
constexpr float kWideKernel = 12;

/// Returns the layout of one light. `boxes` are the world bounds of everything that casts or receives
/// shadows.
LIMN_API LightLayout fitLayout(const glsl::Light& light, std::span<const scene::Bounds> boxes,
                               const ShadowMapDesc& desc);

/// Returns whether the view is one in which appendViews() has nothing to show.
LIMN_API bool showsNothing(const glsl::ShadowView& view);

/// Appends the views of one light, for each sample of `desc` or each part in turn, with layers numbered from
/// views.size(), and one ShadowLight per sample or part. With MapFit::view, maps of one view per sample and
/// the faces of samples' cubes and hemicubes are fitted to `visible`, and show nothing where no receiver in
/// it lies; when it is null, to the boxes.
LIMN_API void appendViews(const glsl::Light& light, uint32_t lightIndex, const LightLayout& layout,
                          std::span<const scene::Bounds> boxes, const ShadowMapDesc& desc,
                          const VisibleScene* visible, std::vector<glsl::ShadowView>& views,
                          std::vector<glsl::ShadowLight>& lights);

/// Returns the samples that need their own maps: all of `desc`, or the centre for lights without extent.
LIMN_API std::vector<glm::vec2> samplesOf(const glsl::Light& light, const ShadowMapDesc& desc);

/// Returns the culling volume of a view: its planes in world space.
LIMN_API scene::CullVolume cullVolume(const glsl::ShadowView& view);

}  // namespace limn::shadow
