// Traces from the lights the light that specular objects send into the medium and onto surfaces: one
// reflection, or the refractions into and out of a body, as the techniques have it (LS DE, LSS DE), or with
// Request::interfaces == kAllInterfaces chains of any length (L S+ D E). Every point of the light's way in
// the medium, and the surface where it ends, is joined to the camera. The result is unbiased, except for the
// point that decides whether a pixel sees a place in the medium (the pixel's centre).
#pragma once

#include <memory>
#include <vector>

#include "core/reference/private/film.h"
#include "core/reference/private/light_view.h"
#include "core/reference/private/medium_view.h"

namespace limn::reference {

class LightTracer {
 public:
  /// Takes a view whose hits are found.
  LightTracer(const View& view, const Request& request);

  /// Returns whether any light may reach the camera this way.
  bool present() const { return !lights_.empty() && objects_.radius() > 0; }
  /// Adds samples first .. first + count - 1 of each half to `sums` (2 * pixel + half): each traces as many
  /// light paths as there are pixels. When asked to stop (Request::stop), it may add anything.
  void trace(uint32_t first, uint32_t count, std::vector<Sums>& sums);

 private:
  struct Film;
  struct Path;
  /// A sphere that light is sent to: around one specular object, or around all.
  struct Target {
    glm::vec3 centre{0};
    float radius = 0;
    uint32_t draw = glsl::no_instance;  ///< the one that it is around; no_instance: all
  };
  std::vector<float> sharesOf(const glsl::Light& light) const;
  bool emit(const Sampler& sampler, uint64_t index, Path& path) const;
  void follow(const Path& path, const Sampler& sampler, Film& film) const;
  void refract(const Path& path, const glsl::Optics& optics, const glm::vec3& flux,
               const glm::vec3& direction, const Sampler& sampler, Film& film) const;
  void wander(const Path& path, const Sampler& sampler, Film& film) const;
  void segment(const glm::vec3& from, const glm::vec3& direction, const glm::vec3& flux,
               const Sampler& sampler, Film& film) const;
  void arrive(const glm::vec3& from, const glm::vec3& direction, const glm::vec3& flux, const Hit* hit,
              const Sampler& sampler, Film& film) const;
  void scatter(const glm::vec3& from, const glm::vec3& direction, float metres, float length,
               const glm::vec3& flux, Film& film) const;
  void reflect(const Hit& hit, const glm::vec3& direction, const glm::vec3& flux, Film& film) const;
  bool project(const glm::vec3& x, size_t& pixel, float& depth, double& perSolidAngle) const;

  const View& view_;
  const Request& request_;
  glm::dmat4 worldToView_;
  glm::dvec2 spacing_;  ///< of pixels at depth 1, along x and y
  std::vector<glsl::Light> lights_;
  glsl::Medium medium_;
  scene::Bounds objects_;       ///< specular ones
  std::vector<Target> bodies_;  ///< each of them
  Target all_;                  ///< all of them
  /// For each light the share of its paths that go to one of the bodies or those before it, whole numbers of
  /// the steps of random numbers, 2^-24; none: all paths go to all_.
  std::vector<std::vector<float>> upTo_;
  bool media_, surfaces_;
  std::vector<std::vector<glm::dvec3>> films_;
};

}  // namespace limn::reference
