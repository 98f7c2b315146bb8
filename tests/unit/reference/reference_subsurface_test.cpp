// Light below translucent surfaces in the reference: against closed forms, Chandrasekhar's functions and
// quadrature.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/base/error.h"
#include "glsl/diffusion/dipole.glsl"
#include "tests/support/translucent_worlds.h"

namespace limn::reference {
namespace {

using namespace test;
using glm::dvec3;
using glm::vec3;

constexpr float kIor = 1.3f;

double entry(double cosine) {
  return static_cast<double>(
      glsl::diffusion_entry(glsl::diffusion_boundary(kIor), static_cast<float>(cosine)));
}
double exitAt(double cosine) {
  return static_cast<double>(
      glsl::diffusion_exit(glsl::diffusion_boundary(kIor), static_cast<float>(cosine)));
}
glsl::DiffusionDipole dipole(float absorption) {
  return glsl::diffusion_dipole(absorption, glsl::diffusion_boundary(kIor));
}

/// A plane of `width` metres seen from straight above, under light of 1 W/m^2 at that cosine.
World planeUnder(double lightCosine, const vec3& extinction, const vec3& absorption, float width = 4) {
  World world;
  world.addQuad({0, 0, 0}, {width, 0, 0}, {0, 0, -width},
                addTranslucent(world, extinction, absorption, kIor));
  const auto sine = static_cast<float>(std::sqrt(1 - lightCosine * lightCosine));
  world.addLight(glsl::light_directional, vec3(0), {sine, -static_cast<float>(lightCosine), 0}, vec3(1));
  world.camera = distantCamera(1, 0.01f * width);
  return world;
}

/// The unit sphere under light of 1 W/m^2 from +z, seen from there.
World sphereUnder(const vec3& extinction, const vec3& absorption) {
  World world;
  world.addInstance(world.addMesh(World::sphere(192, addTranslucent(world, extinction, absorption, kIor))));
  world.addLight(glsl::light_directional, vec3(0), {0, 0, -1}, vec3(1));
  world.camera = scene::lookAt({0, 0, 3}, vec3(0), 0.7f);
  return world;
}

Image picture(const World& world, SubsurfaceModel model, int side, int spp, Term term = Term::subsurface) {
  Request request = world.request(side, term, spp);
  request.subsurface = model;
  return render(request).image;
}

TEST(ReferenceSubsurface, LocalLightLeavesWhereItEnters) {
  const vec3 absorption{0.5f, 0.1f, 0.01f};
  const World world = planeUnder(0.6, vec3(100), absorption);
  const Image image = picture(world, SubsurfaceModel::local, 4, 2);
  for (int c = 0; c < 3; ++c) {
    const double albedo = static_cast<double>(world.scene.materials[0].baseColour[c]);
    EXPECT_NEAR(measured(image, c).mean, albedo * entry(0.6) * 0.6 * exitAt(1), 1e-5);
  }
}

/// Evenly lit, all of the profile counts.
TEST(ReferenceSubsurface, DipoleOfAnEvenlyLitPlaneReflectsItsWhole) {
  const vec3 absorption{0.5f, 0.1f, 0.02f};
  const Image image =
      picture(planeUnder(0.6, vec3(500, 300, 400), absorption), SubsurfaceModel::bssrdf, 16, 256);
  const Measured all = measured(image);
  for (int c = 0; c < 3; ++c) {
    const double expected =
        static_cast<double>(dipole(absorption[c]).reflectance) * entry(0.6) * 0.6 * exitAt(1);
    EXPECT_NEAR(measured(image, c).mean, expected, 4 * std::sqrt(3.0) * all.deviation);
    EXPECT_LT(all.deviation, 0.01 * expected);
  }
}

/// Two wide faces of one body, lit alike: each has the light of its own, and of the other what the profile
/// has beyond their distance. Where they all but touch that is twice the whole.
TEST(ReferenceSubsurface, DipoleOfFacesLitAlikeIsUpToTwiceItsWhole) {
  constexpr float kExtinction = 300, kAbsorption = 0.05f;
  const glsl::DiffusionDipole profile = dipole(kAbsorption);
  const auto whole = static_cast<double>(profile.reflectance);
  for (const float meanPaths : {0.03f, 1.f, 3.f, 10.f}) {
    const float distance = meanPaths / kExtinction;
    World world;
    world.addInstance(world.addMesh(
        box({0.8f, distance, 0.8f}, addTranslucent(world, vec3(kExtinction), vec3(kAbsorption), kIor))));
    for (const float side : {-1.f, 1.f})
      world.addLight(glsl::light_directional, vec3(0), {0, side, 0}, vec3(1));
    world.camera = distantCamera(1, 0.01f);
    const Measured m = measured(picture(world, SubsurfaceModel::bssrdf, 16, 256));
    const double unit = entry(1) * exitAt(1) * whole;
    const double expected = 2 - static_cast<double>(glsl::diffusion_dipole_share(profile, meanPaths));
    EXPECT_NEAR(m.mean / unit, expected, 1e-3 + 4 * m.deviation / unit) << meanPaths << " mean free paths";
    EXPECT_LT(m.deviation, 0.01 * unit) << meanPaths;
    if (meanPaths < 0.1f) {
      EXPECT_GT(m.mean / unit, 1.9) << meanPaths;
    }
  }
}

/// A straight shadow edge: the light that crosses it is the integral of the profile over the lit half.
TEST(ReferenceSubsurface, DipoleCrossesAShadowEdge) {
  constexpr float kExtinction = 300, kAbsorption = 0.05f;
  World world = planeUnder(1, vec3(kExtinction), vec3(kAbsorption));
  world.addQuad({1, 0.5f, 0}, {2, 0, 0}, {0, 0, -8}, world.addMaterial(vec3(0), true));
  world.camera = scene::lookAt({-0.2f, 0.4f, 0}, vec3(0), 0.05f);
  Request request = world.request(24, Term::subsurface, 1024);
  const Image image = render(request).image;
  const glsl::DiffusionDipole profile = dipole(kAbsorption);
  const auto lit = [&](double x) {  // share of the profile's light beyond the line at distance x
    double sum = 0;
    for (int i = 0; i < 4000; ++i) {
      const double r =
          static_cast<double>(glsl::diffusion_dipole_radius(profile, (i + 0.5f) / 4000)) / kExtinction;
      sum += r > std::abs(x) ? std::acos(std::abs(x) / r) / M_PI / 4000 : 0;
    }
    return x > 0 ? sum : 1 - sum;
  };
  double difference = 0, total = 0, variance = 0;
  for (int x = 0; x < 24; ++x) {
    double mean = 0, expected = 0;
    for (int y = 0; y < 24; ++y) {
      const dvec3 p = positionOf(world, image, x, y);
      const dvec3 view = glm::normalize(dvec3(-0.2, 0.4, 0) - p);
      mean += static_cast<double>(image.at(x, y, 0)) / 24;
      expected += lit(p.x) * static_cast<double>(profile.reflectance) * entry(1) * exitAt(view.y) / 24;
      variance += static_cast<double>(image.at(x, y, 3)) / (24. * 24);
    }
    difference += (mean - expected) * (mean - expected);
    total += expected;
  }
  // Sums of squares of 24 columns: chi squared, with a standard deviation of sqrt(2 / 24).
  EXPECT_LT(difference, variance * (1 + 4 * std::sqrt(2.0 / 24)) + 24 * std::pow(2e-3 * total / 24, 2));
  EXPECT_LT(std::sqrt(variance / 24), 0.02 * total / 24);
}

/// Two colours that meet in a line, evenly lit: across it light follows the root of both profiles.
TEST(ReferenceSubsurface, DipoleOfTwoColoursIsTheRootOfBoth) {
  constexpr float kExtinction = 300, kDark = 0.3f, kBright = 0.8f;
  World world = planeUnder(1, vec3(kExtinction), vec3(0));
  scene::Material& material = world.scene.materials[0];
  material.baseColour = glm::vec4(1);
  material.subsurface->albedoFromBaseColour = true;
  scene::Primitive& plane = world.scene.meshes[0].primitives[0];  // dark at x < 0
  plane = World::quad({-1, 0, 0}, {2, 0, 0}, {0, 0, -4}, 0);
  const scene::Primitive other = World::quad({1, 0, 0}, {2, 0, 0}, {0, 0, -4}, 0);
  plane.positions.insert(plane.positions.end(), other.positions.begin(), other.positions.end());
  plane.normals.insert(plane.normals.end(), other.normals.begin(), other.normals.end());
  plane.uvs.clear();
  plane.indices.insert(plane.indices.end(), {4, 5, 6, 4, 6, 7});
  for (size_t i = 0; i < 8; ++i) plane.colours.emplace_back(vec3(i < 4 ? kDark : kBright), 1);
  const glsl::WalkReflectance walk = glsl::walk_reflectance(glsl::diffusion_boundary(kIor));
  const glsl::DiffusionDipole dark = dipole(glsl::walk_absorption(walk, kDark)),
                              bright = dipole(glsl::walk_absorption(walk, kBright));
  const float mean = 1 / kExtinction;
  for (const float x : {-2 * mean, -0.5f * mean, 0.5f * mean, 2 * mean}) {
    world.camera = scene::lookAt({x, 0.1f, 0}, {x, 0, 0}, 1e-4f);
    const Measured m = measured(picture(world, SubsurfaceModel::bssrdf, 12, 1024));
    const glsl::DiffusionDipole& own = x < 0 ? dark : bright;
    const double edge = static_cast<double>(std::abs(x) * kExtinction);
    double beyond = 0, across = 0;  // own profile and root over the other half, per mean free path
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) / kSteps, r = edge + t / (1 - t);
      const double area = 2 * r * std::acos(edge / r) / (kSteps * (1 - t) * (1 - t));
      const auto value = [&](const glsl::DiffusionDipole& d) {
        return static_cast<double>(glsl::diffusion_dipole_profile(d, static_cast<float>(r)));
      };
      beyond += area * value(own);
      across += area * std::sqrt(value(dark) * value(bright));
    }
    const double unit = entry(1) * exitAt(1);
    const double expected = static_cast<double>(own.reflectance) - beyond + across;
    EXPECT_NEAR(m.mean / unit, expected, 2e-3 + 4 * m.deviation / unit) << x;
    EXPECT_LT(m.deviation, 0.01 * unit);
  }
}

/// Radiosity of a sphere under parallel light along z, by quadrature over the lit half.
double sphereRadiosity(const glsl::DiffusionDipole& profile, double extinction, const dvec3& x) {
  constexpr int kRings = 150, kTurns = 256;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double polar = 0.5 * M_PI * (i + 0.5) / kRings, z = std::cos(polar), ring = std::sin(polar);
    double around = 0;
    for (int k = 0; k < kTurns; ++k) {
      const double angle = 2 * M_PI * (k + 0.5) / kTurns;
      const double r = glm::length(dvec3(ring * std::cos(angle), ring * std::sin(angle), z) - x) * extinction;
      around += static_cast<double>(glsl::diffusion_dipole_profile(profile, static_cast<float>(r)));
    }
    sum += around * z * entry(z) * ring;
  }
  return sum * extinction * extinction * M_PI * M_PI / (kRings * kTurns);
}

/// What the pixels of a sphere's picture are over what they should be.
struct OverExpected {
  double value = 0, expected = 0, square = 0, variance = 0;
  int count = 0;
  void add(double v, double e, double noise) {
    value += v;
    expected += e;
    square += (v - e) * (v - e);
    variance += noise;
    ++count;
  }
};

TEST(ReferenceSubsurface, DipoleOfASphereIsTheWholeSpheresIntegral) {
  constexpr float kAbsorption = 0.05f;
  constexpr int kSide = 16;
  for (const float extinction : {0.5f, 5.f, 20.f}) {
    const World world = sphereUnder(vec3(extinction), vec3(kAbsorption));
    const Image image = picture(world, SubsurfaceModel::bssrdf, kSide, 1024);
    OverExpected all, rim;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        if (image.at(x, y, image.channel("coverage")) == 0.f) continue;
        const dvec3 p = glm::normalize(positionOf(world, image, x, y));
        const double cosine = glm::dot(p, glm::normalize(dvec3(0, 0, 3) - p));
        const double expected = sphereRadiosity(dipole(kAbsorption), extinction, p) * exitAt(cosine);
        for (OverExpected* part : {&all, &rim})
          if (part == &all || cosine < 0.5)
            part->add(static_cast<double>(image.at(x, y, 0)), expected,
                      static_cast<double>(image.at(x, y, image.channel("variance"))));
      }
    // Chords of 192 segments are 2e-4 short of the sphere.
    for (const OverExpected* part : {&all, &rim}) {
      EXPECT_GT(part->count, 20);
      EXPECT_NEAR(part->value, part->expected, 2e-3 * part->expected + 4 * std::sqrt(part->variance))
          << extinction;
      EXPECT_LT(std::sqrt(part->variance), 0.01 * part->expected) << extinction;
    }
    // Chi squared, twice over: the variance comes from two halves.
    EXPECT_LT(all.square, all.variance * (1 + 4 * std::sqrt(4.0 / all.count)) +
                              std::pow(5e-3 * all.expected, 2) / all.count)
        << extinction;
  }
}

void addUniformSky(World& world) {
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, vec3(1));
}

/// Without absorption all that enters leaves: with the boundary's reflection the surface vanishes before an
/// even sky.
TEST(ReferenceSubsurface, FurnaceOfWhiteMatterIsEven) {
  World plane;  // of 40000 mean free paths: beyond its edge lies 1e-4 of the light
  plane.addQuad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, addTranslucent(plane, vec3(1e4f), vec3(0), kIor));
  plane.camera = distantCamera(0.8f, 0.01f);
  addUniformSky(plane);
  World sphere;
  sphere.addInstance(sphere.addMesh(World::sphere(64, addTranslucent(sphere, vec3(4), vec3(0), kIor))));
  sphere.camera = scene::lookAt({0, 0, 3000}, vec3(0), 2e-4f);
  addUniformSky(sphere);
  const Measured dipoles = measured(picture(plane, SubsurfaceModel::bssrdf, 32, 512)),
                 walks = measured(picture(sphere, SubsurfaceModel::walk, 16, 256)),
                 locals = measured(picture(plane, SubsurfaceModel::local, 16, 256));
  EXPECT_NEAR(dipoles.mean, entry(0.8), 1e-3 + 4 * dipoles.deviation);
  EXPECT_NEAR(walks.mean, entry(1), 1e-3 + 4 * walks.deviation);
  EXPECT_NEAR(locals.mean, entry(0.8), 1e-3 + 4 * locals.deviation);
}

/// A block that is thick and wide in mean free paths reflects as the half space does, meshed or, with paths
/// too short for its positions, not.
TEST(ReferenceSubsurface, WalkReflectsAsChandrasekharsHalfSpace) {
  for (const float absorption : {0.5f, 0.1f, 0.01f})
    for (const float extinction : {1e3f, 1e8f}) {
      World world;
      const int mesh =
          world.addMesh(box({4, 1, 4}, addTranslucent(world, vec3(extinction), vec3(absorption), kIor)));
      world.addInstance(mesh, glm::translate(glm::mat4(1), vec3(0, -0.5f, 0)));
      world.addLight(glsl::light_directional, vec3(0), {0, -1, 0}, vec3(1));
      const Measured b = radiosity(world, 0.01f, SubsurfaceModel::walk, 16, 64);
      const double expected = limn::test::halfSpaceAlbedo(1 - static_cast<double>(absorption), kIor);
      EXPECT_NEAR(b.mean / entry(1), expected, 2e-3 + 4 * b.deviation / entry(1))
          << absorption << " at " << extinction;
      EXPECT_LT(b.deviation, 0.01);
    }
}

/// More leaves towards grazing views, which look less deep: the walk knows it, the lobe of diffusion does
/// not.
TEST(ReferenceSubsurface, WalkLeavesInEachDirectionAsChandrasekharSays) {
  for (const auto& [cosine, share, weight] : limn::test::halfSpaceShares(0.9, kIor, 4)) {
    World world = planeUnder(1, vec3(1e8f), vec3(0.1f));
    world.camera = distantCamera(static_cast<float>(cosine), 0.01f);
    const Measured m = measured(picture(world, SubsurfaceModel::walk, 16, 512));
    const double unit = entry(1) * exitAt(cosine);
    EXPECT_NEAR(m.mean / unit, share, 2e-3 + 4 * m.deviation / unit) << cosine;
    EXPECT_LT(m.deviation, 0.005 * unit);
  }
}

/// Red light through skin, 2, 5 and 10 mm thick (skin1 of Jensen et al. 2001): what the walk lets pass, and
/// the dipole's profile over both faces, as they were found with another program.
TEST(ReferenceSubsurface, SlabsOfSkinPassLight) {
  constexpr float kScattered = 740, kAbsorbed = 32;  // per metre
  struct SkinSlab {
    float thickness;
    double walk, dipole;
  };
  for (const SkinSlab& slab :
       {SkinSlab{0.002f, 0.452, 0.222}, {0.005f, 0.193, 0.075}, {0.01f, 0.050, 0.014}}) {
    World world;
    const int material =
        addTranslucent(world, vec3(kScattered + kAbsorbed), vec3(kAbsorbed / (kScattered + kAbsorbed)), kIor);
    world.addInstance(world.addMesh(box({0.4f, slab.thickness, 0.4f}, material)),
                      glm::translate(glm::mat4(1), vec3(0, -0.5f * slab.thickness, 0)));
    world.addLight(glsl::light_directional, vec3(0), {0, 1, 0}, vec3(1));
    for (const SubsurfaceModel model : {SubsurfaceModel::walk, SubsurfaceModel::bssrdf}) {
      const Measured b = radiosity(world, 0.001f, model, 16, 128);
      EXPECT_NEAR(b.mean / entry(1), model == SubsurfaceModel::walk ? slab.walk : slab.dipole,
                  1e-3 + 4 * b.deviation / entry(1))
          << name(model) << " " << slab.thickness;
      EXPECT_LT(b.deviation, 0.01);
    }
  }
}

/// With short mean free paths all that is left of a profile is how much it reflects.
TEST(ReferenceSubsurface, ShortMeanFreePathsMeetTheLocalLimit) {
  constexpr float kAbsorption = 0.1f;
  const double whole = static_cast<double>(dipole(kAbsorption).reflectance);
  const auto ratio = [&](float extinction, SubsurfaceModel model, double& deviation) {
    const World world = sphereUnder(vec3(extinction), vec3(kAbsorption));
    const Measured local = measured(picture(world, SubsurfaceModel::local, 16, 2)),
                   light = measured(picture(world, model, 16, 1024));
    deviation = light.deviation / local.mean;
    return light.mean / local.mean * static_cast<double>(world.scene.materials[0].baseColour.x);
  };
  double deviation = 0;
  for (const float extinction : {3e4f, 1e5f})
    EXPECT_NEAR(ratio(extinction, SubsurfaceModel::bssrdf, deviation), whole, 1e-3 + 4 * deviation)
        << extinction;
  EXPECT_NEAR(ratio(1e8f, SubsurfaceModel::bssrdf, deviation), whole, 1e-5) << "too short to be probed";
}

}  // namespace
}  // namespace limn::reference
