// A ball of one matter under light from the side, and what leaves it by integrals over the whole ball.
#pragma once

#include <algorithm>
#include <cmath>

#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/sampling.glsl"
#include "tests/gpu/subsurface_harness.h"
#include "tests/support/scene_nodes.h"

namespace limn {

class SubsurfaceBallTest : public SubsurfaceHarness {
 protected:
  static constexpr float kBallRadius = 0.7f;  ///< it fills the picture: a third of the way from the camera
  static constexpr float kLight = 2;          ///< irradiance across the light's direction

  /// A ball whose radius is that number of mean distances, under light from the side.
  static scene::Scene ball(float meanDistances) {
    scene::Scene scene = floor(meanDistances * meanPaths() / kBallRadius, kAbsorption);
    scene.nodes[0].mesh = test::addMesh(scene, test::spherePrimitive(kBallRadius, 0, 128));
    scene.nodes[1].transform.rotation = glm::quatLookAt(-fromSide(), glm::vec3(0, 0, 1));
    return scene;
  }
  static glm::vec3 eye() { return glm::inverse(camera().worldToView)[3]; }
  static glm::vec3 fromSide() { return glm::normalize(glm::vec3(1, 0.6f, 0.2f)); }

  /// Light that enters under kLight where it comes at that cosine.
  static double entering(float cosine) {
    return cosine <= 0
               ? 0
               : static_cast<double>(kLight * cosine *
                                     glsl::diffusion_entry(glsl::diffusion_boundary(kMatterIor), cosine));
  }
  /// What a pixel shows of the dipole's matter for a mean of entering light of 1.
  static double shownOfOne(const glm::vec3& p, const glm::vec3& normal) {
    const glsl::DiffusionBoundary boundary = glsl::diffusion_boundary(kMatterIor);
    const float cosine = dot(normal, glm::normalize(eye() - p));
    return static_cast<double>(glsl::diffusion_exit(boundary, cosine) *
                               glsl::diffusion_dipole(kAbsorption, boundary).reflectance);
  }
  /// The mean distance of the dipole's light, in mean free paths.
  static float meanPaths() {
    const glsl::DiffusionDipole dipole =
        glsl::diffusion_dipole(kAbsorption, glsl::diffusion_boundary(kMatterIor));
    constexpr int kQuantiles = 1000;
    float sum = 0;
    for (int i = 0; i < kQuantiles; ++i)
      sum += glsl::diffusion_dipole_radius(dipole, (static_cast<float>(i) + 0.5f) / kQuantiles);
    return sum / kQuantiles;
  }
  /// The mean over the dipole's profile of the light that enters the ball, around the place with that normal:
  /// the whole ball's integral, since on a sphere an area of 2 pi r dr has the chord r.
  static double meanOverBall(const glm::vec3& normal, float meanDistances) {
    const glsl::DiffusionDipole dipole =
        glsl::diffusion_dipole(kAbsorption, glsl::diffusion_boundary(kMatterIor));
    const glsl::Frame frame = glsl::frame_around(normal);
    const float paths = meanDistances * meanPaths();  // in a radius
    constexpr uint32_t kDraws = 1000;
    double sum = 0;
    for (uint32_t i = 1; i <= kDraws; ++i) {
      const glm::vec3 u = glsl::r3_sequence(i);
      const float chord = glsl::diffusion_dipole_radius(dipole, u.y) / paths;
      if (chord > 2) continue;
      const float angle = 2 * glsl::pi * u.x, cosine = 1 - 0.5f * chord * chord;
      const float sine = std::sqrt(std::max(1 - cosine * cosine, 0.f));
      const glm::vec3 across = std::cos(angle) * frame.t + std::sin(angle) * frame.b;
      sum += entering(dot(cosine * frame.n + sine * across, fromSide()));
    }
    return sum / kDraws;
  }
};

}  // namespace limn
