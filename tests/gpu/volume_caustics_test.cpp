// Lines of volume caustics alone, against closed forms and against themselves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/render/supersample.h"
#include "core/scene/camera.h"
#include "tests/gpu/media_harness.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using VolumeCausticsTest = MediaHarness;

/// The sun shines through a horizontal pane of 1 m, which changes nothing, on an eye 2 m below its middle.
/// Light lies in a prism about the eye: a pixel holds no more of it than sigma_s p E times its way through
/// the prism. Beams to the left and right of the eye reach past it; each was drawn across the whole picture
/// once, which made it 2 to 3 times as bright. Lines alone are as bright in the mean, but a line near the eye
/// puts into one pixel what belongs to all that its beam covers: no bound holds for a pixel.
TEST_F(VolumeCausticsTest, AnEyeAmongBeamsSeesWhatItsWayThroughThemScatters) {
  constexpr int across = 64, down = 48;
  constexpr double half = 0.5, sigma = 0.01;
  scene::Scene scene;
  scene.medium.sigmaS = glm::vec3(float(sigma));
  scene::Material pane = test::glass(1);
  pane.thickness = 0;
  test::show(scene, test::quad({0, 2, 0}, {2 * float(half), 0, 0}, {0, 0, -2 * float(half)},
                               test::addMaterial(scene, pane)));
  test::show(scene,
             test::quad({0, -2, 0}, {2, 0, 0}, {0, 0, -2}, test::addMaterial(scene, test::lambertian(0))));
  test::shine(scene, test::lamp(glsl::light_directional, 1), {0, 3, 0});
  render::Renderer renderer(device(), scene);
  const scene::CameraPose camera = scene::lookAt({0, 0, 0}, {0, 0, -1}, 0.4f);
  const test::ViewRays rays(camera, renderer.pose().bounds, {across, down});
  const double radius = double(renderer.pose().bounds.radius());  // of the medium, about the eye
  for (const char* beams : {"true", "false"}) {
    renderer.configure(settings(across, down, Term::media,
                                {technique("volume_caustics", {{"buffer_size", "512"}, {"beams", beams}})}));
    renderer.setCamera(camera);
    renderer.render();
    const Image light = renderer.read();
    double drawn = 0, expected = 0, most = 0;
    for (int y = 0; y < down; ++y)
      for (int x = 0; x < across; ++x) {
        const double seen = double(light.at(x, y, 1));
        const glm::dvec3 w = rays.direction(x, y);
        const double way = std::min(half / std::abs(w.x), half / std::abs(w.z));
        most = std::max(most, seen / (sigma / (4 * M_PI) * way));
        drawn += seen;
        constexpr int steps = 50;
        for (int i = 0; i < steps; ++i) {
          const double l = way * (i + 0.5) / steps;
          const glm::dvec3 p = l * w;
          const double fromSun = std::sqrt(radius * radius - p.x * p.x - p.z * p.z) - p.y;
          expected += sigma / (4 * M_PI) * way / steps * std::exp(-sigma * (fromSun + l));
        }
      }
    SCOPED_TRACE(fmt::format("beams {}: mean {} of what is expected, brightest pixel {} of its bound", beams,
                             drawn / expected, most));
    EXPECT_NEAR(drawn / expected, 1, 0.03);
    if (std::string(beams) == "true") {
      EXPECT_LE(most, 1.1);
    }
  }
}

/// A line puts into a pixel what the pixel's whole area has of it. Samples beside its middle do not move the
/// line, or their mean would be that over two pixels: here of 256 lines whose pixels nothing else is in.
TEST_F(VolumeCausticsTest, LinesArePixelsWideHoweverManySamplesAPixelHas) {
  scene::Scene scene;
  scene.medium.sigmaS = glm::vec3(0.01f);
  scene::Material pane = test::glass(1);
  pane.thickness = 0;
  test::show(scene, test::quad({0, 2, 0}, {1, 0, 0}, {0, 0, -1}, test::addMaterial(scene, pane)));
  test::show(scene,
             test::quad({0, -2, 0}, {2, 0, 0}, {0, 0, -2}, test::addMaterial(scene, test::lambertian(0))));
  test::shine(scene, test::lamp(glsl::light_directional, 1), {0, 3, 0}, {0.1f, -1, 0.03f});
  render::Renderer renderer(device(), scene);
  const scene::CameraPose camera = scene::lookAt({0.1f, 0.2f, 4}, {0, 0, 0}, 0.4f);  // beside pane and floor
  renderer.configure(settings(
      width, height, Term::media,
      {technique("volume_caustics", {{"buffer_size", "16"}, {"beams", "false"}, {"paths", "refraction"}})}));
  const Image one = render::supersample(renderer, camera, {width, height}, 1);
  ASSERT_GT(mean(one), 0);
  EXPECT_LT(relativeRms(render::supersample(renderer, camera, {width, height}, 4), one), 0.05);
}

/// From the lamp to the ball light goes 2.3 m through the medium, which leaves exp(-391) of it: less than any
/// number of single precision.
TEST_F(VolumeCausticsTest, LinesThroughAnOpticalThicknessOf1000AreBlack) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium.sigmaS = glm::vec3(1000.f / 6);
  render::Renderer renderer(device(), scene);
  for (const char* beams : {"true", "false"}) {
    const Image lines = picture(
        renderer, settings(width, height, Term::media, {technique("volume_caustics", {{"beams", beams}})}));
    float brightest = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < 3; ++c) brightest = std::max(brightest, std::abs(lines.at(x, y, c)));
    EXPECT_EQ(brightest, 0) << "beams " << beams << ", mean " << mean(lines);
  }
}

/// Where the medium takes next to nothing, all points of a viewing ray are alike, and what they share is what
/// one has. Without the sum of the weights it would be .23 to 1.67 times as much at a radius of half a step,
/// and mostly nothing at a tenth.
TEST_F(VolumeCausticsTest, PointsOfAViewingRayShareAllOfAFragmentsLight) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium.sigmaA = glm::vec3(0);
  scene.medium.sigmaS = glm::vec3(1e-5f);
  render::Renderer renderer(device(), scene);
  const auto lines = [&](const char* steps, const char* radius) {
    return picture(renderer,
                   settings(width, height, Term::media,
                            {technique("volume_caustics", {{"steps", steps}, {"filter_radius", radius}})}));
  };
  const Image one = lines("1", "1");
  ASSERT_GT(mean(one), 0);
  for (const char* radius : {"0.1", "0.5", "1"}) {
    const Image four = lines("4", radius);
    EXPECT_LT(relativeRms(four, one), 1e-3)
        << "radius " << radius << ", mean " << mean(four) / mean(one) << " of that of one point";
  }
}

}  // namespace
}  // namespace limn
