// The studio that lights scenes without light: what it brings to a surface, in closed form, and how bright a
// white one is under all of the default lights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/default_lights.h"
#include "core/scene_io/load.h"
#include "glsl/numeric/equirectangular.glsl"
#include "tests/support/closed_forms.h"
#include "tests/support/glb.h"

namespace limn {
namespace {

using glm::dvec3;

constexpr double kFloor = 0.05, kWalls = 0.15;
constexpr double kCove = 0.15;  ///< |d.y| up to which the radiance is linear in d.y

struct Panel {
  dvec3 towards;
  double halfWidth, halfHeight;  ///< at distance 1
  double radiance;

  std::vector<dvec3> corners() const {
    const dvec3 centre = normalize(towards), right = normalize(cross(centre, dvec3(0, 1, 0))),
                up = cross(right, centre);
    const dvec3 u = halfWidth * right, v = halfHeight * up;
    return {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
  }
  double solidAngle() const {
    const double a = halfWidth * halfWidth, b = halfHeight * halfHeight;
    return 4 * std::asin(std::sqrt(a * b / ((1 + a) * (1 + b))));
  }
};
const Panel kPanels[] = {{{-1, 0.6, 0.15}, 0.5, 0.36, 0.85}, {{1, 0.55, -0.2}, 0.12, 0.35, 2}};

/// Irradiance over pi. Of the room it is the mean of floor and walls on a surface that stands upright, by
/// symmetry; on one that lies, the cosine's integral over the cove adds (1 - kCove^2 / 3) / 2 of their
/// difference or takes it. The panels hang before the walls, above the cove.
double irradiance(const dvec3& n) {
  double sum = (kWalls + kFloor) / 2 + n.y * (kWalls - kFloor) / 2 * (1 - kCove * kCove / 3);
  for (const Panel& panel : kPanels)
    sum += (panel.radiance - kWalls) * test::lambertIrradiance(dvec3(0), n, panel.corners()) / glsl::pi;
  return sum;
}

scene::Environment studio() {
  std::vector<std::string> warnings;
  scene::Environment map = scene::loadEnvironment(test::kAssets / "environments" / "studio.exr", warnings);
  EXPECT_TRUE(warnings.empty());
  return map;
}

TEST(Studio, PanelsHangAboveTheCove) {
  for (const Panel& panel : kPanels)
    for (const dvec3& corner : panel.corners()) EXPECT_GT(normalize(corner).y, kCove);
}

/// Calls `visit` with direction, solid angle and radiance of every pixel.
template <class Visit>
void forEachPixel(const scene::Environment& map, const Visit& visit) {
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(map.width),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(map.height));
      visit(glsl::equirectangular_direction(uv),
            glsl::equirectangular_pixel_solid_angle(y, map.width, map.height),
            map.texels[static_cast<size_t>(y * map.width + x)]);
    }
}

/// Over pi, summed over the pixels.
double irradianceOf(const scene::Environment& map, const glm::vec3& n) {
  double sum = 0;
  forEachPixel(map, [&](const glm::vec3& direction, float solidAngle, const glm::vec3& radiance) {
    sum += double(std::max(dot(n, direction), 0.f) * solidAngle * radiance.x);
  });
  return sum / glsl::pi;
}

/// Pixels are 1.4 degrees wide and averaged from 16 x 16 samples, so that the edges of a panel lie where they
/// should to 1.4 / 32 = 0.044 degrees. Both are 6e-3 of the strip's width of 14 degrees, and the strip brings
/// a seventh of all light.
TEST(Studio, HasItsMeanRadiance) {
  const scene::Environment map = studio();
  double mean = 0;
  forEachPixel(map, [&](const glm::vec3&, float solidAngle, const glm::vec3& radiance) {
    EXPECT_EQ(radiance, glm::vec3(radiance.x)) << "grey";
    EXPECT_GE(radiance.x, 0.9999f * static_cast<float>(kFloor));
    mean += double(solidAngle * radiance.x) / (4 * glsl::pi);
  });
  double expected = (kWalls + kFloor) / 2;
  for (const Panel& panel : kPanels)
    expected += (panel.radiance - kWalls) * panel.solidAngle() / (4 * glsl::pi);
  EXPECT_NEAR(mean / expected, 1, 1e-3);
}

/// Likewise; the strip brings a third of the light to a surface that faces it.
TEST(Studio, LightsSurfacesAsItsRoomAndItsPanelsDo) {
  const scene::Environment map = studio();
  for (const dvec3 n :
       {dvec3(0, 1, 0), dvec3(0, -1, 0), dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 0, 1), dvec3(0, 0, -1)})
    EXPECT_NEAR(irradianceOf(map, n) / irradiance(n), 1, 2e-3) << n.x << ", " << n.y << ", " << n.z;
}

/// Of a white dielectric 4 % are reflected at its surface; the diffuse rest stays within what a picture shows
/// at exposure 0.
TEST(Studio, WithTheDefaultLightsDoesNotOverexposeWhite) {
  const scene::Environment map = studio();
  scene::Bounds bounds;
  bounds.add(glm::vec3(-1));
  bounds.add(glm::vec3(1));
  scene::Scene scene;
  scene::addDefaultLights(scene, scene::frameBounds(bounds), bounds);
  const scene::Pose pose = scene::evaluate(scene, 0);
  float brightest = 0;
  constexpr int count = 500;
  for (int i = 0; i < count; ++i) {  // a spiral of directions about 9 degrees apart
    const float y = 1 - (2 * static_cast<float>(i) + 1) / count, azimuth = 2.399963f * static_cast<float>(i);
    const glm::vec3 n(std::sqrt(1 - y * y) * std::cos(azimuth), y, std::sqrt(1 - y * y) * std::sin(azimuth));
    float sum = static_cast<float>(irradianceOf(map, n)) * glsl::pi;
    for (const glsl::Light& light : pose.lights) {
      const glm::vec3 to =
          light.type == glsl::light_directional ? -light.direction : glm::vec3(light.position);
      sum += glsl::punctual_irradiance(light, glm::vec3(0)).x * std::max(dot(n, normalize(to)), 0.f);
    }
    brightest = std::max(brightest, 0.96f * sum / glsl::pi);
  }
  EXPECT_LE(brightest, 1);
  EXPECT_GT(brightest, 0.9f);
}

}  // namespace
}  // namespace limn
