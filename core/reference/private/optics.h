// Computes the optics of a material where light meets it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "core/scene/scene.h"
#include "glsl/scene/media.glsl"

namespace limn::reference {

constexpr float kLeastCosine = 1e-4f;        ///< of directions to a smooth surface, as in the shaders
constexpr int kMostEvents = 512;             ///< reflections and refractions of a path without limit
constexpr uint32_t kFirstEventRoulette = 8;  ///< from this event on a path goes on with a probability alone

/// Returns the optics with a surface's own base colour, in [0, 1], and metallic.
inline glsl::Optics opticsOf(const scene::Material& m, const glm::vec3& base, float metallic) {
  return {.base = base,
          .metallic = metallic,
          .transmission = m.transmission,
          .ior = glm::clamp(m.ior, 1.f, 3.f),
          .thickness = m.thickness,
          .attenuation = m.attenuationColour,
          .attenuation_distance = m.attenuationDistance};
}

/// Returns the optics as caustics use them: without textures.
inline glsl::Optics opticsOf(const scene::Material& m) {
  return opticsOf(m, glm::clamp(glm::vec3(m.baseColour), 0.f, 1.f), m.metallic);
}

/// Returns the body within which light goes on that met a surface from its front or its `back`: the surface's
/// own where light was mirrored at the back or passed the front, else none.
inline std::optional<glsl::Optics> bodyBehind(const glsl::Optics& met, bool back, bool mirrored) {
  return met.thickness > 0 && mirrored == back ? std::optional(met) : std::nullopt;
}

/// Returns the body that light crossed to a surface: what lies before the back of one is its inside, and
/// elsewhere it is the body in which light went on before, if any. No medium fills it.
inline std::optional<glsl::Optics> bodyBefore(const glsl::Optics& met, bool back,
                                              const std::optional<glsl::Optics>& body) {
  return met.thickness > 0 && back ? std::optional(met) : body;
}

}  // namespace limn::reference
