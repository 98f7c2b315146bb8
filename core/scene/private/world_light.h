// Declares how the lights and cameras of nodes are placed in world space. Internal to core/scene. A node's
// scale changes neither, but a node that mirrors turns them round with the scene, upright.
#pragma once

#include <optional>

#include "core/scene/scene.h"

namespace limn::scene {

glsl::Light punctualLight(const LightSource& source, const glm::vec2& area, const glm::mat4& nodeToWorld);

/// Returns the light that a part of an emissive quad becomes, or nothing when the transformed part is not a
/// rectangle. One without area is a light of size 0 that emits nothing: animations may scale a lamp to 0, and
/// the lights of a scene keep their numbers and names.
std::optional<glsl::Light> quadLight(const EmissivePart& part, const Material& material,
                                     const glm::mat4& objectToWorld, uint32_t instance);

/// Returns the light that a part of the environment becomes, in world space.
LIMN_API glsl::Light distantLight(const DistantRectangle& rectangle, const Environment& environment);

glm::mat4 worldToView(const glm::mat4& nodeToWorld);

/// Sets `out` to `first`, or to `second` when `first` is empty, or to "#index" when both are; reuses the
/// memory of `out`.
void setName(std::string& out, const std::string& first, const std::string& second, int index);

}  // namespace limn::scene
