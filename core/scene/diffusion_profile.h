// How far the light of translucent materials goes below a surface, and which materials of a scene scatter
// alike.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "core/base/parameters.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Holds one channel of a profile over a plane.
struct ChannelProfile {
  double reflectance = 0;               ///< C: of all light that enters, what leaves
  std::function<double(double)> share;  ///< of the light that leaves, what does so within a radius in metres
};
using Profile = std::array<ChannelProfile, 3>;

inline constexpr const char* kProfileNames[] = {"dipole", "normalised_diffusion"};
/// Returns the parameter of techniques that choose between two profiles.
constexpr Parameter profileParameter() {
  return choice(
      "profile", 0, kProfileNames,
      "Light over the distance from where it entered: the dipole of sources, or two exponentials with "
      "the reflectance of a random walk");
}
/// Returns whether normalised diffusion is chosen, which is NORMALISED of glsl/diffusion/profile.glsl.
inline bool normalisedProfile(const ParameterValues& parameters) {
  return parameters.choice("profile") == 1;
}

/// Returns the dipole's profile of a half space, or that of normalised diffusion. `extinction`: sigma_t', per
/// metre; `absorption`: sigma_a / sigma_t'.
LIMN_API Profile diffusionProfile(const glm::vec3& extinction, const glm::vec3& absorption, float ior,
                                  bool normalised);

/// Returns the distance from which on `holds` is true, in metres from 1e-15 to 1e12: mean free paths are 1e-9
/// to 1e6.
LIMN_API double leastDistance(const std::function<bool(double)>& holds);

/// Says which texels stand for a texture.
enum class OfTexels {
  mean,     ///< the mean of all
  largest,  ///< in each channel the largest
};

/// Returns whether the albedo of a translucent material is that of its base colour and another one from place
/// to place of a primitive: it has a texture, or the vertices have colours.
LIMN_API bool albedoVaries(const Material& material, const Primitive& primitive);

/// Returns the albedo of a material whose base colour is its albedo: the factor times the texture's. Vertex
/// colours only make it smaller.
LIMN_API glm::vec3 baseAlbedo(const Scene& scene, const Material& material, OfTexels which);

/// Holds what translucent materials that scatter alike have in common.
struct TranslucentKind {
  glm::vec3 extinction{0};  ///< sigma_t', per metre
  glm::vec3 absorption{0};  ///< sigma_a / sigma_t'; of the mean albedo where that is the base colour
  /// Where it is the base colour: the mean of its texels times that of its vertices' colours.
  glm::vec3 albedo{0};
  float ior = 1;          ///< 1 to 3
  bool textured = false;  ///< it varies (albedoVaries()): it is the base colour of each pixel
};

/// Holds the translucent materials that a scene draws, those that scatter alike once.
struct TranslucentKinds {
  std::vector<TranslucentKind> kinds;
  std::vector<uint32_t> ofMaterials;  ///< for each material of the scene an index into `kinds`; ~0: it is
                                      ///< opaque, or nothing is drawn with it
  bool textured = false;              ///< at least one kind's albedo varies
};

/// Returns the kinds of the translucent materials of a pose's instances, none where all are opaque.
LIMN_API TranslucentKinds translucentKinds(const Scene& scene, const Pose& pose);

}  // namespace limn::scene
