// Declares how a light is cut into parts that have shadow maps of their own (ShadowMapDesc::views). No
// OpenGL.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/shadow/private/window_fit.h"
#include "core/shadow/shadow_map.h"
#include "glsl/scene/light.glsl"

namespace limn::shadow {

/// Returns the number of parts along each side of a light whose maps have `layout`, which says nothing of
/// parts yet. `boxes` as for fitLayout(), within the light's range.
glm::uvec2 partsAlongSides(const glsl::Light& light, const LightLayout& layout,
                           std::span<const scene::Bounds> boxes, const ShadowMapDesc& desc);

/// Returns the parts of a light that is cut.
std::vector<glsl::Light> partsOf(const glsl::Light& light, const LightLayout& layout,
                                 const ShadowMapDesc& desc);

/// Returns, of one perspective view, or two, of a part, what the light's own hold from an eighth of their
/// depth on. Nearer to the light only parts on the receiver's side are sure to see it: the others do not
/// count there. None for other layouts.
std::optional<MapWindow> partWindow(const glsl::Light& light, const glsl::Light& part,
                                    const LightLayout& layout, std::span<const scene::Bounds> boxes,
                                    const ShadowMapDesc& desc);

}  // namespace limn::shadow
