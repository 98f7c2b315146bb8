// The reference's caustics against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "core/reference/private/ray_scene.h"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;
using glm::vec3;

/// Flux that the caustics bring to a floor of albedo 1, from the radiance of all its pixels.
double causticFlux(const World& world, int size) {
  const Image image = render(world.request(size, Term::caustic, 64)).image;
  glsl::FrameBlock frame{};
  scene::setCamera(frame, world.camera, world.pose.bounds, size, size);
  const double dx = glm::length(glm::dvec3(vec3(frame.view_ray_dx)));
  double flux = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      if (image.at(x, y, image.channel("coverage")) == 0.f) continue;
      const glm::dvec3 p = positionOf(world, image, x, y), away = p - glm::dvec3(vec3(frame.camera_position));
      const double depth = double(image.at(x, y, image.channel("Z"))), r = glm::length(away);
      const double solidAngle = std::pow(depth / r, 3) * dx * dx, cosine = -away.y / r;
      flux += double(image.at(x, y, 0)) * M_PI * solidAngle * r * r / cosine;
    }
  return flux;
}

TEST(ReferenceCaustic, EnergyThroughASphereIsWhatFresnelLeaves) {
  for (const float ior : {1.0001f, 1.5f}) {
    World world;
    world.addQuad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, world.addMaterial(vec3(1)));
    world.addInstance(world.addMesh(World::sphere(256, world.addClearGlass(ior))),
                      glm::translate(glm::mat4(1), vec3(0, 1, 0)) * glm::scale(glm::mat4(1), vec3(0.3f)));
    world.addLight(glsl::light_directional, {0, 0, 0}, {0, -1, 0}, vec3(2));
    world.camera = scene::lookAt({0, 4, 5}, {0, 0, 0}, 0.9f);
    double arrives = 0;
    constexpr int n = 4000;
    for (int i = 0; i < n; ++i) {
      const double sine = (i + 0.5) / n, cosine = std::sqrt(1 - sine * sine);
      const double rho = double(glsl::fresnel_reflectance(float(cosine), 1, ior));
      const double sineTwice = 2 * sine * cosine, cosineTwice = 1 - 2 * sine * sine;
      const double place =
          0.3 * sine - (1 + 0.3 * cosine) * sineTwice / cosineTwice;  // of what is mirrored down
      const bool mirrored = cosineTwice < 0 && place < 2.2;
      const double in = std::asin(sine), out = std::asin(sine / double(ior)), turned = 2 * (in - out);
      const double exit = in + M_PI - 2 * out;  // angle of the place on the sphere where it leaves
      const double passing = 0.3 * std::sin(exit) - (1 + 0.3 * std::cos(exit)) * std::tan(turned);
      const bool passes = turned < 0.5 * M_PI && std::abs(passing) < 2.2;
      arrives += 2 * sine / n * ((passes ? std::pow(1 - rho, 2) : 0) + (mirrored ? rho : 0));
    }
    const double total = arrives * 2 * M_PI * 0.3 * 0.3;
    EXPECT_NEAR(causticFlux(world, 96) / total, 1, 0.01) << ior;
  }
}

/// A second ball, 200 m away, sends no light here. Of paths to the sphere around both two in a quarter of a
/// million would meet the first one under the sun, so that nothing would be known of its light; of paths to
/// each a sixth meets it, whose noise is 0.5 % in one picture over another.
TEST(ReferenceCaustic, ABodyFarAwayLeavesTheLightOfAnotherAsItIs) {
  const auto flux = [](uint32_t type, bool second) {
    World world;
    world.addQuad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, world.addMaterial(vec3(1)));
    const int ball = world.addMesh(World::sphere(64, world.addClearGlass(1.5f)));
    const auto at = [](float x) {
      return glm::translate(glm::mat4(1), vec3(x, 1, 0)) * glm::scale(glm::mat4(1), vec3(0.3f));
    };
    world.addInstance(ball, at(0));
    if (second) world.addInstance(ball, at(200));
    world.addLight(type, {0, 3, 0}, {0, -1, 0}, vec3(2));
    world.camera = scene::lookAt({0, 4, 5}, {0, 0, 0}, 0.9f);
    return causticFlux(world, 64);
  };
  for (const uint32_t type : {glsl::light_directional, glsl::light_point}) {
    const double alone = flux(type, false);
    ASSERT_GT(alone, 0);
    EXPECT_NEAR(flux(type, true) / alone, 1, 0.02) << type;
  }
}

/// A lamp in the middle of a ball of glass: its light passes the surface straight, after half a metre that
/// absorbs, and that no medium fills.
TEST(ReferenceCaustic, LightFromWithinABodyIsAbsorbedThereAndMeetsNoMedium) {
  World world = floorWorld();
  const int glass = world.addClearGlass(1.5f);
  world.addInstance(world.addMesh(World::sphere(128, glass)),
                    glm::translate(glm::mat4(1), vec3(0, 1, 0)) * glm::scale(glm::mat4(1), vec3(0.5f)));
  const vec3 lamp(world.addLight(glsl::light_point, {0, 1, 0}, {0, -1, 0}, vec3(1)).position);
  world.camera = scene::lookAt({0, 0.4f, 1.5f}, {0, 0, 0}, 0.1f);
  constexpr int size = 3, middle = 1;
  const auto lit = [&](int interfaces) {
    Request request = world.request(size, Term::caustic, 16384);
    request.interfaces = interfaces;
    return render(request).image;
  };
  for (const int interfaces : {0, kAllInterfaces}) {
    SCOPED_TRACE(interfaces);
    scene::Material& body = world.scene.materials[static_cast<size_t>(glass)];
    body.attenuationDistance = 0;
    world.scene.medium = {};
    const double clear = double(lit(interfaces).at(middle, middle, 0));
    ASSERT_GT(clear, 0);
    body.attenuationColour = vec3(0.5f);
    body.attenuationDistance = 0.1f;
    const double absorbed = double(lit(interfaces).at(middle, middle, 0));
    body.attenuationDistance = 0;
    world.scene.medium.sigmaA = vec3(1);
    const Image foggy = lit(interfaces);
    const glm::dvec3 place = positionOf(world, foggy, middle, middle);
    const double outside =
        glm::distance(place, glm::dvec3(lamp)) - 0.5 + glm::distance(place, glm::dvec3(0, 0.4, 1.5));
    // Within a tenth of a metre the pixel's light comes from one place.
    EXPECT_NEAR(double(foggy.at(middle, middle, 0)) / clear, std::exp(-outside), 0.03 * std::exp(-outside));
    // Light that has gone around inside, without limit, is absorbed more.
    EXPECT_NEAR(absorbed / clear, std::pow(0.5, 5), interfaces == 0 ? 1e-3 : 3e-3);
  }
}

/// A plate 1 m behind the front of a slab of glass, which the sun meets head-on, seen from within the slab.
TEST(ReferenceCaustic, AMatteThingInABodyIsLitThroughItAlone) {
  World world;
  const int glass = world.addClearGlass(1.5f);
  scene::Primitive slab = World::quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, glass);
  const scene::Primitive back = World::quad({0, 0, -2}, {2, 0, 0}, {0, -2, 0}, glass);
  slab.positions.insert(slab.positions.end(), back.positions.begin(), back.positions.end());
  slab.normals.insert(slab.normals.end(), back.normals.begin(), back.normals.end());
  slab.uvs.insert(slab.uvs.end(), back.uvs.begin(), back.uvs.end());
  for (const uint32_t index : back.indices) slab.indices.push_back(4 + index);
  world.addInstance(world.addMesh(slab));
  world.addQuad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, world.addMaterial(vec3(0.5f)));
  world.addLight(glsl::light_directional, {0, 0, 0}, {0, 0, -1}, vec3(1));
  world.pose.bounds = {vec3(-2), vec3(2)};
  world.camera = scene::lookAt({0, 0, -0.5f}, {0, 0, -1}, 0.1f);
  scene::Material& body = world.scene.materials[static_cast<size_t>(glass)];
  const auto lit = [&](float absorbs, float sigma) {
    body.attenuationColour = vec3(absorbs);
    body.attenuationDistance = absorbs < 1 ? 1.f : 0.f;
    world.scene.medium.sigmaA = vec3(sigma);
    Request request = world.request(1, Term::caustic, 1 << 18);
    request.interfaces = kAllInterfaces;
    return double(render(request).image.at(0, 0, 0));
  };
  const double clear = lit(1, 0);
  ASSERT_GT(clear, 0);
  EXPECT_NEAR(lit(0.5f, 0) / clear, 0.5, 1e-3);
  // From the medium's border, at the root of 12, to the front; and from the plate to the camera.
  EXPECT_NEAR(lit(1, 0.5f) / clear, std::exp(-0.5 * (std::sqrt(12) + 0.5)), 1e-3);
}

TEST(ReferenceCaustic, ThereIsNoneWithoutSpecularSurfacesOrLight) {
  World world = floorWorld();
  world.addLight(glsl::light_point, {0, 1, 0}, {0, -1, 0}, vec3(1));
  for (const float v : {render(world.request(8, Term::caustic, 2)).image.at(4, 4, 0)}) EXPECT_EQ(v, 0);
  World dark = floorWorld();
  dark.addInstance(dark.addMesh(World::sphere(16, dark.addClearGlass(1.5f))));
  EXPECT_EQ(render(dark.request(8, Term::caustic, 2)).image.at(4, 4, 0), 0);
}

}  // namespace
}  // namespace limn::reference
