// What tests of techniques share that spread the light below surfaces: floors of one matter under a spot or
// half in shadow, and pictures of them against closed forms and the local limit.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "glsl/diffusion/normalised.glsl"
#include "techniques/separable_subsurface/line_kernel.h"
#include "tests/gpu/two_bodies.h"

namespace limn {

class SubsurfaceSpreadTest : public TwoBodiesTest {
 protected:
  using Values = std::vector<std::pair<std::string, std::string>>;

  static constexpr float kIor = 1.3f;
  static constexpr float kLit = 0.5f;   ///< radius of the spot's light on the floor, m
  static constexpr float kHeight = 40;  ///< of the spot, m
  inline static const std::vector<std::string> kProfiles{"dipole", "normalised_diffusion"};

  explicit SubsurfaceSpreadTest(std::string name) : name_(std::move(name)) {}

  static scene::Material matter(float extinction, float absorption, float ior = kIor) {
    const glsl::WalkReflectance walk = glsl::walk_reflectance(glsl::diffusion_boundary(ior));
    scene::Material material;
    material.metallic = 0;
    material.specularFactor = 0;
    material.ior = ior;
    material.baseColour = glm::vec4(glm::vec3(glsl::walk_albedo(walk, absorption)), 1);
    material.subsurface =
        scene::Subsurface{.extinction = glm::vec3(extinction), .absorption = glm::vec3(absorption)};
    return material;
  }

  /// A floor of 2 m x 2 m under a spot far above it, which lights a disc of that radius.
  static scene::Scene lit(const scene::Material& material, float radius) {
    scene::Scene scene = floorUnder({0, 1, 0}, {});
    scene.materials[0] = material;
    scene::LightSource& light = scene.lights[0];
    light.type = glsl::light_spot;
    light.intensity = kHeight * kHeight;
    light.outerCone = std::atan(radius / kHeight);
    light.innerCone = 0.9999f * light.outerCone;
    scene.nodes.back().transform.translation = {0, kHeight, 0};
    return scene;
  }

  /// The scene with white vertices on its floor: an albedo that is the base colour is then each pixel's own.
  static scene::Scene whiteVertices(scene::Scene scene) {
    scene::Primitive& floor = scene.meshes[0].primitives[0];
    floor.colours.assign(floor.positions.size(), glm::vec4(1));
    return scene;
  }

  /// Light from straight above a floor, none of which a plate above the camera lets through to where
  /// dot(place, side) < edge. The whole scene is turned by `turn`.
  static scene::Scene shadowed(const scene::Material& material, const glm::vec3& side, float edge,
                               const glm::quat& turn = glm::quat(1, 0, 0, 0)) {
    scene::Scene scene = floorUnder({0, 1, 0}, {});
    scene.materials[0] = material;
    scene::Node plate;
    plate.mesh = test::addMesh(scene, test::floorPrimitive(2, test::addMaterial(scene)));
    plate.transform.translation = glm::vec3(0, 3, 0) + (edge - 2) * side;
    scene.nodes.push_back(plate);
    for (scene::Node& node : scene.nodes) {
      node.transform.translation = turn * node.transform.translation;
      node.transform.rotation = turn * node.transform.rotation;
    }
    return scene;
  }

  Image belowShadow(const scene::Scene& scene, const Values& values = {}) {
    return drawn(scene, Term::subsurface,
                 {technique("hard_shadow_map", {{"shadow_map_size", "2048"}}), technique(name_, values)});
  }

  Image below(const scene::Scene& scene, const Values& values = {}) {
    return drawn(scene, Term::subsurface, {technique(name_, values)});
  }

  /// The largest of |a / b / ratio - 1| over the points that b lights.
  static double largestDifference(const Image& a, const Image& b, double ratio = 1) {
    double largest = 0;
    int counted = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const auto wanted = static_cast<double>(b.at(x, y, 0)) * ratio;
        const auto seen = static_cast<double>(a.at(x, y, 0));
        if (wanted == 0) {
          EXPECT_EQ(seen, 0);
          continue;
        }
        const double difference = std::abs(seen / wanted - 1);
        if (std::isnan(difference)) return std::numeric_limits<double>::infinity();
        largest = std::max(largest, difference);
        ++counted;
      }
    EXPECT_GT(counted, 1500);
    return largest;
  }

  /// RMS of a - b over that of b.
  static double rmsDifference(const Image& a, const Image& b) {
    double error = 0, power = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const auto wanted = static_cast<double>(b.at(x, y, 0));
        error += std::pow(static_cast<double>(a.at(x, y, 0)) - wanted, 2);
        power += wanted * wanted;
      }
    return std::sqrt(error / power);
  }

  /// An albedo that is the base colour, of the material or of each pixel by itself, scatters as coefficients
  /// with that albedo do, but for rounding, which may move taps to other pixels.
  void expectAlbedosAsCoefficientsSay() {
    for (const float absorption : {0.001f, 0.2f}) {
      scene::Material material = matter(30, absorption);
      const scene::Scene coefficients = lit(material, kLit);
      material.subsurface->albedoFromBaseColour = true;
      const scene::Scene plain = lit(material, kLit);
      for (const std::string& profile : kProfiles) {
        const Image wanted = below(coefficients, {{"profile", profile}});
        for (const scene::Scene& albedo : {plain, whiteVertices(plain)})
          EXPECT_LT(rmsDifference(below(albedo, {{"profile", profile}}), wanted), 2e-3)
              << profile << ' ' << absorption;
      }
    }
  }

  /// C of a profile over the albedo of the local limit.
  static double reflectanceOverAlbedo(const scene::Material& material, bool normalised) {
    const auto profile = scene::diffusionProfile(material.subsurface->extinction,
                                                 material.subsurface->absorption, material.ior, normalised);
    return profile[0].reflectance / static_cast<double>(material.baseColour.x);
  }

  /// Expects the light across shadows' edges, along two axes and seen from two sides, to be what the
  /// integrals of the profile along lines say, within `bound` of all light (RMS).
  void expectEdgesAsLineIntegralsSay(const Values& values, double bound) {
    const scene::Material material = matter(30, 0.04f);
    for (const float degrees : {0.f, -35.f}) {  // seen at 19 and at 54 degrees
      const glm::quat turn = glm::angleAxis(glm::radians(degrees), glm::vec3(1, 0, 0));
      for (const glm::vec3 side : {glm::vec3(1, 0, 0), glm::vec3(0, 0, 1)}) {
        const scene::Scene scene = shadowed(material, side, 0, turn);
        const Image whole = drawn(scene, Term::subsurface, {});
        std::vector<double> lit;
        forEachPoint(whole,
                     [&](float value, const glm::vec3&) { lit.push_back(static_cast<double>(value)); });
        for (const bool normalised : {false, true}) {
          const auto profile = scene::diffusionProfile(material.subsurface->extinction,
                                                       material.subsurface->absorption, kIor, normalised)[0];
          const double ratio = reflectanceOverAlbedo(material, normalised);
          double squares = 0;
          size_t index = 0;
          int counted = 0;
          Values chosen = values;
          chosen.emplace_back("profile", kProfiles[normalised]);
          forEachPoint(belowShadow(scene, chosen), [&](float value, const glm::vec3& p) {
            const double all = lit[index++] * ratio;
            const glm::vec3 place = glm::inverse(turn) * p;
            const auto x = static_cast<double>(dot(place, side));
            if (std::abs(place.x) > 0.4f || std::abs(place.z) > 0.4f) return;
            const double share = separable_subsurface::lineShare(profile, std::abs(x));
            const double error = static_cast<double>(value) / all - 0.5 - std::copysign(0.5 * share, x);
            squares += error * error;
            ++counted;
          });
          EXPECT_GT(counted, 2000);
          EXPECT_LT(std::sqrt(squares / counted), bound)
              << kProfiles[normalised] << ' ' << side.x << ' ' << degrees;
        }
      }
    }
  }

  /// Expects matter of extreme mean free paths, absorptions and indices to let out no more light than enters,
  /// and no less than none. `choices`: settings to try in turn.
  void expectNoMoreThanEnters(const std::vector<Values>& choices) {
    for (const float extinction : {1e-6f, 1.f, 1e9f})
      for (const float absorption : {0.f, 1e-5f, 1.f})
        for (const float ior : {1.f, 3.f}) {
          scene::Material material = matter(extinction, absorption, ior);
          material.baseColour = glm::vec4(1);
          const scene::Scene scene = lit(material, kLit);
          const Image entering = drawn(lit(material, 5), Term::subsurface, {});
          for (const Values& values : choices) {
            const Image seen = below(scene, values);
            for (int y = 0; y < kSide; ++y)
              for (int x = 0; x < kSide; ++x) {
                EXPECT_GE(seen.at(x, y, 0), 0);
                EXPECT_LE(seen.at(x, y, 0), 1.0001f * entering.at(x, y, 0));
              }
          }
        }
  }

  /// Expects a scene without translucent materials to have no pass of the technique, and the same bits.
  void expectOpaqueScenesLeftAlone() {
    const scene::Scene scene = floorUnder({1, 1, 0.5f}, {});
    std::vector<frame::PassReport> passes;
    EXPECT_TRUE(same(drawn(scene, Term::final, {technique(name_)}, &passes), drawn(scene, Term::final, {})));
    for (const frame::PassReport& pass : passes)
      if (pass.technique == name_) {
        EXPECT_EQ(pass.state, frame::PassState::leftOut);
      }
  }

 private:
  std::string name_;
};

}  // namespace limn
