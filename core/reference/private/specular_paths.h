// Follows what the camera sees in specular surfaces: paths from the camera, off and through smooth
// interfaces, to the first surface that is not specular.
#pragma once

#include <array>
#include <optional>

#include "core/reference/private/sampler.h"
#include "core/reference/private/surface.h"

namespace limn::reference {

/// Holds the end of such a path.
struct SpecularEnd {
  /// Holds what its radiance is multiplied by on the way, the medium included; 0: it ends nowhere.
  glm::dvec3 throughput{0};
  std::optional<Surface> surface;  ///< nothing: the background
  glm::vec3 background{0};         ///< radiance, W/(sr m^2)
};

class SpecularPaths {
 public:
  /// Takes `interfaces`, the most interfaces of a path, or allInterfaces.
  SpecularPaths(const RayScene& rays, int interfaces);

  /// Returns whether there are many paths, to be sampled, rather than the two of the image-space limit.
  bool many() const;
  /// Returns the ends of the paths that image space can follow: one reflection at the surface that the camera
  /// sees; and one way through the object behind it, which goes on within it where it is totally reflected.
  /// Light that leaves the object passes through others, and an object that is seen from within is an open
  /// sheet. The background lies outside of all bodies, also where nothing bounds the one that a path is in.
  std::array<SpecularEnd, 2> imageSpace(const Surface& seen) const;
  /// Returns the end of one path without limit, reflected and refracted at random; its pairs of random
  /// numbers follow firstPair.
  SpecularEnd sample(const Surface& seen, const Sampler& sampler) const;

  static constexpr uint32_t firstPair = 1u << 30;

 private:
  struct Ray {
    glm::vec3 origin, direction;
    glm::dvec3 throughput;
    /// Holds squares of indices of refraction, where the camera is and where the path has got to: radiance
    /// over them is the same along it (Veach 1997, section 5.2).
    double atCamera = 1, here = 1;
  };
  SpecularEnd matteAlong(const Ray& ray) const;
  SpecularEnd endAt(const Ray& ray, const Hit& hit, const glm::vec3& from,
                    const std::optional<glsl::Optics>& body) const;
  SpecularEnd backgroundAlong(const Ray& ray, const glm::vec3& from) const;
  SpecularEnd throughBody(const Surface& seen, const glsl::Optics& optics, Ray ray) const;

  const RayScene& rays_;
  int interfaces_;
};

}  // namespace limn::reference
