// Declares how a light looks at a scene through its shadow maps: along which axes, from how wide a piece of
// itself, and through which window it sees all that it lights. No OpenGL.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/shadow/private/pyramid_fit.h"
#include "core/shadow/private/window_fit.h"
#include "core/shadow/shadow_map.h"
#include "glsl/scene/light.glsl"

namespace limn::shadow {

/// Returns the axes of a light's first map.
MapAxes axesOf(const glsl::Light& light);

/// Returns half of a light's sides, each as far as it reaches along the axes of its map. `size` as in
/// light_view().
glm::vec3 spreadOf(const glsl::Light& light, const MapAxes& axes, float size);

/// Returns the point of a light that a sample of ShadowMapDesc stands for.
glm::vec3 samplePoint(const glsl::Light& light, const glm::vec2& sample);

/// Returns whether the light has a cone that one perspective view can hold.
bool hasCone(const glsl::Light& light);

/// Returns by how much a map is wider than what it shows: two texels more on each side, of few texels an
/// eighth of that width, so that no map shows far more of its surroundings than of what it is for.
float widening(int size);

/// Returns the window around a map's axis.
MapWindow squareWindow(float half, const DepthRange& range);

/// Returns the window of perspective views from `origin`: all boxes that they may see, as far as there is
/// light.
MapWindow wholeWindow(const glsl::Light& light, const glm::vec3& origin, const MapAxes& axes,
                      const LightLayout& layout, std::span<const scene::Bounds> boxes,
                      const ShadowMapDesc& desc);

/// Returns of the boxes, with MapFit::view, what lies as near to the light's centre as its range, or as
/// points of the light themselves: no more is lit, or lies on the way there. Other maps may be asked where
/// light goes on to. `kept` holds them.
std::span<const scene::Bounds> withinRange(const glsl::Light& light, std::span<const scene::Bounds> boxes,
                                           const ShadowMapDesc& desc, std::vector<scene::Bounds>& kept);

}  // namespace limn::shadow
