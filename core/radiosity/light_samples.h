// Declares the light of lights at surface elements: what illumination samples begin with.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/radiosity/occlusion.h"
#include "core/radiosity/sample_solver.h"
#include "core/radiosity/scene_elements.h"
#include "glsl/scene/light.glsl"

namespace limn::radiosity {

/// Holds a place that lights shine on, in world space.
struct LitPlace {
  glm::vec3 position{0}, normal{0, 0, 1};
  float alpha = 1;                        ///< of its lobe: lights that are wide for it are taken in pieces
  float clearance = 0;                    ///< of rays, m
  uint32_t seed = 0;                      ///< of the places that rays end at
  uint32_t instance = glsl::no_instance;  ///< that it is on
};

/// Holds the light of lights at a place, in world space.
struct LightAtPlace {
  glm::vec3 irradiance{0};
  std::vector<glsl::IncidentLight> incident;
};

/// Adds the light of a light, whose texture is left out: exact where nothing hides it, attenuated by the
/// medium from the light's centre on, and hidden by `rays` rays or more to an extended light, to strata of
/// its area. Light below the horizon does not arrive, nor does that of the instance that the place is on.
LIMN_API void addLight(const glsl::Light& light, const LitPlace& place, const Occlusion& occlusion, int rays,
                       LightAtPlace& sum);

/// Sets the light of `lights`, as their textures colour it, at all leaves of a solution for these elements.
/// Uses all cores; the result does not depend on their number.
LIMN_API void lightLeaves(const SceneElements& elements, std::span<const glsl::Light> lights,
                          const Occlusion& occlusion, int rays, SampleSolver& solver);

}  // namespace limn::radiosity
