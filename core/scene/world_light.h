// Internal: lights and cameras of nodes in world space. A node's scale changes neither.
#pragma once

#include <optional>

#include "core/scene/scene.h"

namespace limn::scene {

glsl::Light punctualLight(const LightSource& source, const glm::vec2& area, const glm::mat4& nodeToWorld);

/// The light that a part of an emissive quad is; nothing if the transform makes it no rectangle any more.
std::optional<glsl::Light> quadLight(const EmissivePart& part, const Material& material,
                                     const glm::mat4& objectToWorld, uint32_t instance);

/// A part of the environment, in the world.
LIMN_API glsl::Light distantLight(const DistantRectangle& rectangle, const Environment& environment);

glm::mat4 worldToView(const glm::mat4& nodeToWorld);

/// `first`, else `second`, else "#index"; reuses the memory of `out`.
void setName(std::string& out, const std::string& first, const std::string& second, int index);

}  // namespace limn::scene
