// What tests of light below surfaces from points in the image share: a floor of one matter, and what leaves
// it by closed forms.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "glsl/diffusion/colours.glsl"
#include "tests/gpu/two_bodies.h"

namespace limn {

class SubsurfaceHarness : public TwoBodiesTest {
 protected:
  using Choices = std::vector<std::pair<std::string, std::string>>;

  static constexpr float kMatterIor = 1.3f;
  static constexpr float kExtinction = 40;  ///< per metre; light gets 50 mm in the mean, 4 pixels
  static constexpr float kAbsorption = 0.04f;
  static inline const std::vector<std::string> kProfileNames{"dipole", "normalised_diffusion"};

  /// A floor that absorbs that share of what it does not let through, under light from straight above.
  static scene::Scene floor(float extinction, float absorption) {
    scene::Scene scene = floorUnder({0, 1, 0}, {});
    scene::Material& material = scene.materials[0];
    material.ior = kMatterIor;
    material.baseColour = glm::vec4(glm::vec3(albedo(absorption)), 1);
    material.subsurface =
        scene::Subsurface{.extinction = glm::vec3(extinction), .absorption = glm::vec3(absorption)};
    return scene;
  }
  static float albedo(float absorption) {
    return glsl::walk_albedo(glsl::walk_reflectance(glsl::diffusion_boundary(kMatterIor)), absorption);
  }
  /// C of a profile over the albedo of the local limit.
  static double reflectanceOverAlbedo(size_t profile, float absorption) {
    if (profile == 1) return 1;
    const glsl::DiffusionDipole dipole =
        glsl::diffusion_dipole(absorption, glsl::diffusion_boundary(kMatterIor));
    return static_cast<double>(dipole.reflectance / albedo(absorption));
  }
  /// The largest of |a / b / ratio - 1| over the points of the floor.
  static double largestDifference(const Image& a, const Image& b, double ratio) {
    std::vector<double> wanted;
    forEachPoint(
        b, [&](float value, const glm::vec3&) { wanted.push_back(static_cast<double>(value) * ratio); });
    double largest = 0;
    size_t i = 0;
    forEachPoint(a, [&](float value, const glm::vec3&) {
      const double difference = std::abs(static_cast<double>(value) / wanted[i++] - 1);
      largest =
          std::isnan(difference) ? std::numeric_limits<double>::infinity() : std::max(largest, difference);
    });
    EXPECT_GT(i, 1500u);
    return largest;
  }
  /// A picture of what leaves the bodies of a scene, with the given parameters of the technique.
  Image below(const scene::Scene& scene, const Choices& values) {
    return drawn(scene, Term::subsurface,
                 {technique("hard_shadow_map", {{"shadow_map_size", "2048"}}),
                  technique("subsurface_scattering", values)});
  }
};

}  // namespace limn
