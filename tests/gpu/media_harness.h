// What tests of media and caustics share.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "core/reference/reference.h"
#include "tests/gpu/render_test.h"

namespace limn {

class MediaHarness : public RenderTest {
 protected:
  static constexpr int width = 128, height = 96;

  static Image reference(render::Renderer& renderer, const scene::Scene& scene, Term term, int spp,
                         int light = reference::kAllLights) {
    reference::Request asked = test::request(renderer, scene, {width, height}, term, spp);
    asked.light = light;
    return reference::render(asked).image;
  }

  /// The same scene with black, matte surfaces for the specular ones, which cast the same shadows: what its
  /// medium scatters is airlight alone.
  static scene::Scene withoutCaustics(scene::Scene scene) {
    for (scene::Material& m : scene.materials) {
      if (!m.specularSurface()) continue;
      m = {};
      m.baseColour = glm::vec4(0, 0, 0, 1);
      m.metallic = 0;
      m.specularFactor = 0;
    }
    return scene;
  }

  /// The mean of the light of lines in a picture of 64 x 48 pixels: what the reference loses where specular
  /// surfaces turn black. Both references have the same samples of airlight.
  static double meanOfLines(render::Renderer& renderer, const scene::Scene& scene) {
    const auto ofLight = [&](const scene::Scene& of) {
      return mean(reference::render(test::request(renderer, of, {64, 48}, Term::media, 64)).image);
    };
    return ofLight(scene) - ofLight(withoutCaustics(scene));
  }

  static double mean(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        for (int c = 0; c < 3; ++c) sum += image.at(x, y, c);
    return sum / (3.0 * image.width() * image.height());
  }

  /// Of the green channel.
  static double relativeRms(const Image& image, const Image& truth) {
    double difference = 0, square = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double a = double(truth.at(x, y, 1)), b = double(image.at(x, y, 1));
        difference += (a - b) * (a - b);
        square += a * a;
      }
    return std::sqrt(difference / square);
  }

  static bool sameBits(const Image& a, const Image& b) {
    return std::equal(a.data().begin(), a.data().end(), b.data().begin(), b.data().end());
  }

  static std::string stateOf(const render::Renderer& renderer, const std::string& technique,
                             const std::string& pass) {
    for (const auto& report : renderer.explain())
      if (report.technique == technique && report.name == pass)
        return report.state == frame::PassState::leftOut ? report.reason : "run";
    return "unknown";
  }
};

}  // namespace limn
