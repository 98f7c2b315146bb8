// Declares lights as one receiver sees them: what arrives from a sampled or a given direction.
#pragma once

#include <glm/glm.hpp>

#include "core/reference/private/ray_scene.h"
#include "core/reference/private/surface.h"
#include "core/reference/reference.h"
#include "core/scene/environment_light.h"
#include "glsl/light/rectangle_light.glsl"
#include "glsl/scene/light.glsl"

namespace limn::reference {

/// Holds which light a request asks for: of Pose::lights those from `first` to the one before `last`, and
/// whether that of the environment's map.
struct AskedLights {
  int first = 0, last = 0;
  bool environment = false;
  int count() const { return last - first; }
};
AskedLights askedLights(const Request& request);

/// Holds light that arrives along a line, unless something blocks it.
struct Arrival {
  glm::vec3 direction{0};  ///< unit, from the receiver
  glm::vec3 target{0};     ///< where it comes from, just clear of the light's own surface, if finite
  float end = 1;           ///< share of the way there on which surfaces block it
  bool finite = false;
  float pdf = 0;          ///< density of sample() for this direction, 1/sr; 0: nothing arrives
  glm::vec3 radiance{0};  ///< W/(sr m^2)
  float irradianceWeight =
      0;  ///< proportional to the irradiance that a piece of the light's area gives the receiver
};

bool unblocked(const RayScene& rays, const Surface& receiver, const Arrival& arrival);

/// Samples a point or spot light, or a directional one without angular size: one direction.
class PointView {
 public:
  PointView(const glsl::Light& light, const Surface& receiver);
  /// Returns whether the light lies above the receiver's geometric tangent plane and the receiver inside the
  /// light's cone and range.
  bool above() const { return above_; }
  const Arrival& arrival() const { return arrival_; }
  const glm::vec3& irradiance() const { return irradiance_; }  ///< on a surface facing the light, W/m^2

 private:
  Arrival arrival_;
  glm::vec3 irradiance_{0};
  bool above_ = false;
};

/// Samples the part of a rectangle, distant or not, that lies above the receiver's geometric tangent plane;
/// samples are uniform in its area.
class RectangleView {
 public:
  RectangleView(const glsl::Light& light, const Surface& receiver);
  bool above() const { return part_.count > 0; }
  bool dark() const { return radiance_ == glm::vec3(0); }
  Arrival sample(glm::vec2 u) const;
  Arrival towards(const glm::vec3& direction) const;

 private:
  Arrival at(glm::vec2 ab) const;

  const glsl::Light& light_;
  glsl::Rectangle rectangle_{};
  glsl::RectanglePart part_{};
  glm::vec3 receiver_, normal_, radiance_{0}, clearance_{0};
  glm::vec3 facing_{0};  ///< across the rectangle, towards the receiver or away from it
  bool finite_ = false;  ///< else lengths are in units of the distant plane's distance
  float area_ = 0;       ///< of the part, m^2
};

/// Samples a directional light with an angular diameter: a cone of uniform radiance; samples are uniform in
/// its solid angle.
class ConeView {
 public:
  ConeView(const glsl::Light& light, const Surface& receiver);
  bool above() const { return above_; }  ///< at least partly above the geometric tangent plane
  bool dark() const { return radiance_ == glm::vec3(0); }
  Arrival sample(glm::vec2 u) const;
  Arrival towards(const glm::vec3& direction) const;

 private:
  Arrival along(const glm::vec3& direction) const;

  glsl::Frame frame_{};  ///< n points to the light's centre
  glm::vec3 normal_, radiance_{0};
  float oneMinusCosine_ = 0;  ///< of half the angular diameter
  bool above_ = false;
};

/// Samples an environment that is not dark; samples follow its radiance.
class EnvironmentView {
 public:
  explicit EnvironmentView(const scene::EnvironmentLight& environment) : environment_(environment) {}
  Arrival sample(glm::vec2 u) const { return towards(environment_.sample(u)); }
  Arrival towards(const glm::vec3& direction) const;

 private:
  const scene::EnvironmentLight& environment_;
};

/// Returns the weight of a strategy of density `own` > 0 beside one of density `other` (Veach 1997, power
/// heuristic with exponent 2).
inline float powerHeuristic(float own, float other) {
  const float ratio = other / own;
  return 1.f / (1.f + ratio * ratio);
}

/// Returns whether a light has a single direction for every receiver.
bool isPunctual(const glsl::Light& light);

}  // namespace limn::reference
