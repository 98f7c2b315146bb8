// What the reference's camera sees in specular surfaces, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/reference/private/specular_paths.h"
#include "glsl/scene/media.glsl"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;
using glm::dvec3;
using glm::vec3;

constexpr double kAlbedo = 0.5, kIntensity = 20;

int addMirror(World& world) {
  const int material = world.addMaterial(vec3(1));
  world.scene.materials.back().metallic = 1;
  world.scene.materials.back().roughness = 0;
  return material;
}

/// The primitive with all that the parts have.
scene::Primitive joined(const std::vector<scene::Primitive>& parts) {
  scene::Primitive whole = parts.front();
  for (size_t i = 1; i < parts.size(); ++i) {
    const auto first = static_cast<uint32_t>(whole.positions.size());
    whole.positions.insert(whole.positions.end(), parts[i].positions.begin(), parts[i].positions.end());
    whole.normals.insert(whole.normals.end(), parts[i].normals.begin(), parts[i].normals.end());
    whole.uvs.insert(whole.uvs.end(), parts[i].uvs.begin(), parts[i].uvs.end());
    for (const uint32_t index : parts[i].indices) whole.indices.push_back(first + index);
  }
  return whole;
}

/// A wall of 8 x 8 m at `place`, facing along `normal` (an axis), lit by a lamp 1.5 m before it and 0.3 m
/// aside: what is mirrored and refracted has a closed form everywhere.
struct Wall {
  dvec3 normal, lamp;
  double height;  ///< of its plane along the normal

  Wall(World& world, const vec3& place, const vec3& facing)
      : normal(facing), lamp(dvec3(place) + 1.5 * dvec3(facing)), height(glm::dot(dvec3(place), normal)) {
    const vec3 u = std::abs(facing.y) > 0.5f ? vec3(1, 0, 0) : glm::cross(vec3(0, 1, 0), facing);
    lamp += 0.3 * dvec3(u);
    world.addQuad(place, 8.f * u, 8.f * glm::cross(facing, u), world.addMaterial(vec3(kAlbedo)));
    world.addLight(glsl::light_point, vec3(lamp), {0, -1, 0}, vec3(kIntensity));
  }

  /// Radiance along a ray that meets it.
  double along(const dvec3& origin, const dvec3& direction) const {
    const double t = (height - glm::dot(normal, origin)) / glm::dot(normal, direction);
    const dvec3 towards = lamp - (origin + t * direction);
    const double distance = glm::length(towards);
    return kAlbedo / double(glsl::pi) * kIntensity * glm::dot(normal, towards) / std::pow(distance, 3);
  }
};

/// Unit direction of the view ray of a pixel of a square picture, rows from the top.
dvec3 rayOf(const World& world, int size, int x, int y) {
  glsl::FrameBlock frame{};
  scene::setCamera(frame, world.camera, world.pose.bounds, size, size);
  return glm::normalize(dvec3(vec3(frame.view_ray_origin) + static_cast<float>(x) * vec3(frame.view_ray_dx) +
                              static_cast<float>(size - 1 - y) * vec3(frame.view_ray_dy)));
}

Request specularRequest(const World& world, int size, int interfaces, int spp = 2) {
  Request request = world.request(size, Term::specular, spp);
  request.interfaces = interfaces;
  return request;
}

/// A plate of glass between z = -0.5 and 0.5 before a wall at z = -3, seen from z = 3.
struct Slab {
  World world;
  Wall wall;
  dvec3 eye{0.2, 0.1, 3};

  explicit Slab(float ior) : wall(world, {0, 0, -3}, {0, 0, 1}) {
    const int glass = world.addClearGlass(ior);
    world.addInstance(world.addMesh(joined({World::quad({0, 0, 0.5f}, {6, 0, 0}, {0, 6, 0}, glass),
                                            World::quad({0, 0, -0.5f}, {6, 0, 0}, {0, -6, 0}, glass)})));
    world.camera = scene::lookAt(vec3(eye), vec3(eye) - vec3(0, 0, 1), 0.9f);
  }
};

TEST(ReferenceSpecular, AMirrorShowsTheMirroredWall) {
  World world;
  const Wall wall(world, {0, 0, 4}, {0, 0, -1});
  world.addQuad({0, 0, 0}, {6, 0, 0}, {0, 6, 0}, addMirror(world));
  const dvec3 eye(0.5, 0.2, 2);
  world.camera = scene::lookAt(vec3(eye), {0, 0, 0}, 0.6f);
  constexpr int size = 24;
  for (const int interfaces : {1, 2, kAllInterfaces}) {
    const Image image = render(specularRequest(world, size, interfaces)).image;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const dvec3 d = rayOf(world, size, x, y), p = eye - eye.z / d.z * d;
        const double expected = wall.along(p, {d.x, d.y, -d.z});
        ASSERT_NEAR(double(image.at(x, y, 0)) / expected, 1, 2e-4) << x << " " << y;
      }
  }
}

TEST(ReferenceSpecular, ASlabShiftsTheWallByItsClosedForm) {
  constexpr int size = 24;
  for (const float ior : {1.2f, 1.5f, 3.f}) {
    const Slab slab(ior);
    const Image image = render(specularRequest(slab.world, size, 2)).image;
    double largestShift = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const dvec3 d = rayOf(slab.world, size, x, y);
        const dvec3 front = slab.eye + (0.5 - slab.eye.z) / d.z * d;
        const dvec3 inside(d.x / double(ior), d.y / double(ior),
                           -std::sqrt(1 - (d.x * d.x + d.y * d.y) / double(ior * ior)));
        const dvec3 back = front - inside / inside.z;
        const double reflectance = double(glsl::fresnel_reflectance(float(-d.z), 1, ior));
        const double expected = std::pow(1 - reflectance, 2) * slab.wall.along(back, d);
        ASSERT_NEAR(double(image.at(x, y, 0)) / expected, 1, 3e-4) << ior << ": " << x << " " << y;
        largestShift =
            std::max(largestShift, std::abs(slab.wall.along(slab.eye, d) / slab.wall.along(back, d) - 1));
      }
    EXPECT_GT(largestShift, 0.02) << "the shift must show";
  }
}

TEST(ReferenceSpecular, FresnelAtNormalIncidence) {
  for (const float ior : {1.33f, 1.5f, 2.42f}) {
    World world;
    const Wall wall(world, {0, 0, 4}, {0, 0, -1});
    world.addQuad({0, 0, 0}, {6, 0, 0}, {0, 6, 0}, world.addClearGlass(ior));
    world.camera = scene::lookAt({0, 0, 2}, {0, 0, 0}, 0.01f);
    const double reflectance = std::pow((double(ior) - 1) / (double(ior) + 1), 2);
    const Image image = render(specularRequest(world, 3, 2)).image;
    EXPECT_NEAR(double(image.at(1, 1, 0)) / wall.along({0, 0, 0}, {0, 0, 1}), reflectance,
                1e-3 * reflectance);
  }
}

TEST(ReferenceSpecular, GlassThatDoesNotBendIsNotSeen) {
  Slab slab(1);
  const Image image = render(specularRequest(slab.world, 16, 2)).image;
  const Image truth = render(specularRequest(slab.world, 16, kAllInterfaces, 4)).image;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const double expected = slab.wall.along(slab.eye, rayOf(slab.world, 16, x, y));
      ASSERT_NEAR(double(image.at(x, y, 0)) / expected, 1, 2e-4);
      ASSERT_NEAR(double(truth.at(x, y, 0)) / expected, 1, 2e-4);
    }
}

TEST(ReferenceSpecular, WithoutLimitASlabPassesTheGeometricSeries) {
  Slab slab(1.5f);
  slab.world.camera = scene::lookAt(vec3(slab.eye), vec3(slab.eye) - vec3(0, 0, 1), 0.01f);
  const double reflectance = 0.04, straight = slab.wall.along(slab.eye, {0, 0, -1});
  const Image limited = render(specularRequest(slab.world, 3, 2)).image;
  EXPECT_NEAR(double(limited.at(1, 1, 0)) / straight, std::pow(1 - reflectance, 2), 1e-3);
  const Image truth = render(specularRequest(slab.world, 3, kAllInterfaces, 16384)).image;
  EXPECT_NEAR(double(truth.at(1, 1, 0)) / straight, (1 - reflectance) / (1 + reflectance), 4e-3);
}

TEST(ReferenceSpecular, GlassAbsorbsOverTheWayThroughIt) {
  Slab slab(1.5f);
  scene::Material& glass = slab.world.scene.materials.back();
  const Image clear = render(specularRequest(slab.world, 9, 2)).image;
  glass.attenuationColour = {0.8f, 0.5f, 0.2f};
  glass.attenuationDistance = 0.7f;
  const Image tinted = render(specularRequest(slab.world, 9, 2)).image;
  const dvec3 d = rayOf(slab.world, 9, 1, 2);
  const double way = 1 / std::sqrt(1 - (d.x * d.x + d.y * d.y) / 2.25);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(double(tinted.at(1, 2, c)) / double(clear.at(1, 2, c)),
                std::pow(double(glass.attenuationColour[c]), way / 0.7), 1e-3);
}

TEST(ReferenceSpecular, AThinWallTintsAndDoesNotBend) {
  World world;
  const Wall wall(world, {0, 0, -3}, {0, 0, 1});
  const int pane = world.addClearGlass(1.5f, 0);
  world.scene.materials[static_cast<size_t>(pane)].baseColour = {0.9f, 0.6f, 0.3f, 1};
  world.addQuad({0, 0, 0}, {6, 0, 0}, {0, 6, 0}, pane);
  const dvec3 eye(0.3, 0, 3);
  world.camera = scene::lookAt(vec3(eye), {0.3f, 0, 0}, 0.8f);
  const Image image = render(specularRequest(world, 9, 1)).image;
  const dvec3 d = rayOf(world, 9, 7, 3);
  const double passes = 1 - double(glsl::fresnel_reflectance(float(-d.z), 1, 1.5f));
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(double(image.at(7, 3, c)) / wall.along(eye, d), passes * (0.9 - 0.3 * c), 1e-3);
}

/// A prism of 45 degrees: through a leg, off the other side of the glass, out through the other leg.
void addPrism(World& world, int glass) {
  const vec3 across = glm::normalize(vec3(1, 0, -1));
  world.addInstance(
      world.addMesh(joined({World::quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, glass),
                            World::quad({1, 0, -1}, {0, 0, -2}, {0, 2, 0}, glass),
                            World::quad({0, 0, -1}, {0, 2, 0}, std::sqrt(8.f) * across, glass)})));
}

TEST(ReferenceSpecular, APrismReflectsTotally) {
  World world;
  const Wall wall(world, {4, 0, -1}, {-1, 0, 0});
  addPrism(world, world.addClearGlass(1.5f));
  world.camera = scene::lookAt({0, 0.2f, 3}, {0, 0.2f, 0}, 0.01f);
  EXPECT_EQ(render(specularRequest(world, 3, 2)).image.at(1, 1, 0), 0.f) << "it takes three interfaces";
  for (const int interfaces : {3, 8}) {
    const Image image = render(specularRequest(world, 3, interfaces)).image;
    EXPECT_NEAR(double(image.at(1, 1, 0)) / wall.along({1, 0.2, -1}, {1, 0, 0}), 0.96 * 0.96, 1e-3);
  }
  const Image truth = render(specularRequest(world, 3, kAllInterfaces, 8192)).image;
  EXPECT_NEAR(double(truth.at(1, 1, 0)) / wall.along({1, 0.2, -1}, {1, 0, 0}), 0.96 * 0.96, 0.01);
}

TEST(ReferenceSpecular, LightThatLeavesAnObjectPassesThroughOthersInTheLimitAlone) {
  Slab slab(1.5f);
  const Image one = render(specularRequest(slab.world, 8, 2)).image;
  const int black = addMirror(slab.world);
  slab.world.scene.materials[static_cast<size_t>(black)].baseColour = {0, 0, 0, 1};
  slab.world.addQuad({0, 0, -1}, {6, 0, 0}, {0, 6, 0}, black);
  EXPECT_NEAR(double(render(specularRequest(slab.world, 8, 2)).image.at(4, 4, 0)), double(one.at(4, 4, 0)),
              1e-4);
  EXPECT_LT(render(specularRequest(slab.world, 8, kAllInterfaces, 64)).image.at(4, 4, 0),
            0.2f * one.at(4, 4, 0));
}

TEST(ReferenceSpecular, TheMediumDimsWhatIsSeenBehindTheGlass) {
  Slab slab(1.5f);
  const Image clear = render(specularRequest(slab.world, 9, 2)).image;
  slab.world.scene.medium.sigmaA = vec3(0.1f, 0.2f, 0.4f);
  const Image dim = render(specularRequest(slab.world, 9, 2)).image;
  // To the plate, from the plate to the wall and from the lamp to the wall; not inside the glass.
  const dvec3 d = rayOf(slab.world, 9, 4, 4);
  const dvec3 front = slab.eye + (0.5 - slab.eye.z) / d.z * d;
  const dvec3 back(front.x, front.y, -0.5), seen = back + 2.5 * d;
  const double way = glm::length(front - slab.eye) + 2.5 + glm::length(slab.wall.lamp - seen);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(double(dim.at(4, 4, c)) / double(clear.at(4, 4, c)),
                std::exp(-double(slab.world.scene.medium.sigmaA[c]) * way), 2e-3);
}

/// A black plate that shines, 1 m behind the front of a slab, or 1.5 m into a prism and behind its total
/// reflection, is seen through as much glass, which no medium fills.
TEST(ReferenceSpecular, WithoutLimitAMatteThingInGlassIsSeenThroughItAlone) {
  const auto addPlate = [](World& world, const vec3& place, const vec3& u) {
    scene::Material& glass = world.scene.materials.back();
    glass.attenuationColour = vec3(0.5f);
    glass.attenuationDistance = 1;
    const int plate = world.addMaterial(vec3(0));
    world.scene.materials.back().emission = vec3(1);
    world.addQuad(place, u, {0, 1, 0}, plate);
    world.camera = scene::lookAt({0, 0.1f, 0.5f}, {0, 0.1f, 0}, 0.01f);
  };
  World slab, prism;
  const int glass = slab.addClearGlass(1.5f);
  slab.addInstance(slab.addMesh(joined({World::quad({0, 0, 0}, {6, 0, 0}, {0, 6, 0}, glass),
                                        World::quad({0, 0, -2}, {6, 0, 0}, {0, -6, 0}, glass)})));
  addPlate(slab, {0, 0, -1}, {1, 0, 0});
  addPrism(prism, prism.addClearGlass(1.5f));
  addPlate(prism, {0.5f, 0, -1}, {0, 0, 1});
  const auto seen = [](const World& world) {
    return double(render(specularRequest(world, 3, kAllInterfaces, 16384)).image.at(1, 1, 0));
  };
  for (const float sigma : {0.f, 1.f}) {
    slab.scene.medium.sigmaA = prism.scene.medium.sigmaA = vec3(sigma);
    const double before = std::exp(-0.5 * double(sigma)), leaves = 0.96 / (1.5 * 1.5);
    EXPECT_NEAR(seen(slab) / before, leaves * 0.5, 3e-3) << sigma;
    EXPECT_NEAR(seen(prism) / before, leaves * std::pow(0.5, 1.5), 3e-3) << sigma;
  }
}

/// A furnace with water or glass in it. Its sky shines with 1, and what is black in a body of index n with
/// n^2, as black bodies there do: radiance over n^2 goes through interfaces, and is 1 wherever it is measured
/// (Veach 1997, section 5.2).
class Furnace {
 public:
  explicit Furnace(float ior)
      : ior_(ior), glass_(world.addClearGlass(ior)), black_(world.addMaterial(vec3(0))) {
    world.scene.materials[static_cast<size_t>(glass_)].doubleSided = true;  // seen from within as well
    world.scene.materials[static_cast<size_t>(black_)].emission = vec3(ior * ior);
    world.scene.environment.width = 4;
    world.scene.environment.height = 2;
    world.scene.environment.texels.assign(8, vec3(1));
  }

  /// Adds a sheet of water over a black ground, 0.5 m deep.
  void addPool() {
    world.addQuad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, glass_);
    world.addQuad({0, -0.5f, 0}, {40, 0, 0}, {0, 0, -40}, black_);
  }
  /// Adds a ball of glass with a black one within.
  void addBall() {
    world.addInstance(world.addMesh(World::sphere(48, glass_)));
    world.addInstance(world.addMesh(World::sphere(24, black_)), glm::scale(glm::mat4(1), vec3(0.4f)));
  }

  /// Expects `radiance` in all pixels that show the glass.
  void expectEvery(double radiance, int interfaces, const vec3& eye, const vec3& target) {
    world.camera = scene::lookAt(eye, target, 0.8f);
    const Image image = render(specularRequest(world, 16, interfaces, 64)).image;
    int shown = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        if (image.at(x, y, image.channel("id")) != 0.f) continue;
        ++shown;
        ASSERT_NEAR(double(image.at(x, y, 0)), radiance, 1e-4 * radiance)
            << ior_ << ", " << interfaces << ": " << x << " " << y;
      }
    EXPECT_GT(shown, 50);
  }

  World world;

 private:
  float ior_;
  int glass_, black_;
};

TEST(ReferenceSpecular, AFurnaceUnderWaterStaysOne) {
  for (const float ior : {1.f, 1.33f, 3.f})
    for (const int interfaces : {2, kAllInterfaces}) {
      Furnace furnace(ior);
      furnace.addPool();
      furnace.expectEvery(1, interfaces, {0.3f, 2, 1.5f}, {0, 0, 0});
      // Under water what lies beyond the critical angle is the ground, mirrored.
      furnace.expectEvery(double(ior) * double(ior), interfaces, {0.1f, -0.4f, 0.3f}, {0, 0, -0.4f});
    }
}

TEST(ReferenceSpecular, AFurnaceInGlassStaysOneOverAnyNumberOfInterfaces) {
  for (const float ior : {1.33f, 1.5f}) {
    Furnace furnace(ior);
    furnace.addBall();
    furnace.expectEvery(1, kAllInterfaces, {0.4f, 0.5f, 2.5f}, {0, 0, 0});
    // Nearer to the middle than 1 / n: from there no light goes round within the ball for ever.
    furnace.expectEvery(double(ior) * double(ior), kAllInterfaces, {0.5f, 0.1f, 0.2f}, {0.5f, 1, 0});
  }
}

TEST(ReferenceSpecular, TermsSumToTheFinalPicture) {
  Slab slab(1.5f);
  slab.world.camera = scene::lookAt({3, 2, 4}, {1, 0, -1}, 1.2f);
  Request request = slab.world.request(16, Term::final, 2);
  request.interfaces = 2;
  const Image whole = render(request).image, seen = render(specularRequest(slab.world, 16, 2)).image,
              direct = render(slab.world.request(16, Term::direct, 2)).image,
              caustic = render(slab.world.request(16, Term::caustic, 2)).image;
  double sum = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      ASSERT_NEAR(whole.at(x, y, 0), seen.at(x, y, 0) + direct.at(x, y, 0) + caustic.at(x, y, 0), 1e-5f);
      sum += double(seen.at(x, y, 0));
    }
  EXPECT_GT(sum, 0);
}

TEST(ReferenceSpecular, RefusesWhatHasNoInterfaces) {
  const Slab slab(1.5f);
  EXPECT_THROW(render(specularRequest(slab.world, 4, 0)), UsageError);
  EXPECT_THROW(render(specularRequest(slab.world, 4, kMaxInterfaces + 1)), UsageError);
  EXPECT_THROW(render(specularRequest(slab.world, 4, -2)), UsageError);
  Request direct = slab.world.request(4, Term::direct, 2);
  direct.interfaces = 2;
  EXPECT_THROW(render(direct), UsageError);
  for (const Term term : {Term::caustic, Term::media}) {
    Request request = slab.world.request(4, term, 2);
    const std::string limited = contentHash(request);
    request.interfaces = kAllInterfaces;
    EXPECT_NO_THROW(render(request)) << name(term);
    EXPECT_NE(contentHash(request), limited) << name(term);
    request.interfaces = 2;
    EXPECT_THROW(render(request), UsageError) << name(term) << " has no other number";
  }
}

}  // namespace
}  // namespace limn::reference
