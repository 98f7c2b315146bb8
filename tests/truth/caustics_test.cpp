// Light over mirrors and glass onto matte surfaces, where it has closed forms.
#include "tests/truth/truth_test.h"

namespace limn {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double kGround = 0.6, kSun = 2;  // W/m^2 across its light

/// The normal +z turned about y, towards +x by `angle`.
dvec3 tilted(double angle) {
  return {std::sin(angle), 0, std::cos(angle)};
}

class CausticTruth : public TruthTest {
 protected:
  static Question question(const scene::CameraPose& camera, int spp) {
    return {
        .camera = camera, .term = Term::caustic, .techniques = {technique("surface_caustics")}, .spp = spp};
  }

  /// In the plane x = 1.2, facing what lies at the origin, above z = 0; the sun that shines along (1, 0, -1)
  /// passes it and lights it, too.
  static void addWall(scene::Scene& scene, const dvec3& normal) {
    scene::Primitive wall = test::quad({1.2f, 0, 2}, {0, 4, 0}, {0, 0, -4},
                                       test::addMaterial(scene, test::lambertian(float(kGround))));
    wall.normals.assign(4, vec3(normal));
    test::show(scene, wall);
  }
  /// From where the light of a patch of 1 m at the origin that leaves it along `direction` is seen on the
  /// wall.
  static scene::CameraPose towardsWall(const dvec3& direction) {
    const float height = float(1.2 * direction.z / direction.x), extent = float(direction.z / direction.x);
    return scene::lookAt({-1.8f, -0.6f, height}, {1.2f, 0, height},
                         2 * std::atan(0.5f * std::max(extent, 0.6f) / 3));
  }
  /// Sees of the patch its middle.
  static bool fullyLit(const dvec3& p, const dvec3& direction) {
    const dvec3 from = p - direction * (p.z / direction.z);
    return std::abs(p.x - 1.2) < 1e-3 && std::abs(from.x) < 0.4 && std::abs(from.y) < 0.4;
  }
};

/// A flat mirror in the plane z = 0 whose normals are tilted sends the sun's light on as if its surface were:
/// radiance is kept, so that a place which sees all of the sun in it is lit as by the sun from there. The
/// same holds for a receiver whose own normals are tilted: radiance = albedo / pi * E * cosine with them.
TEST_F(CausticTruth, AMirrorWithTiltedNormalsIsAsBrightAsTheSun) {
  struct Tilt {
    double mirror, receiver;  ///< radians
  };
  for (const Tilt& c : {Tilt{0, 0}, Tilt{0.15, 0}, Tilt{-0.15, 0}, Tilt{0, 0.4}, Tilt{0.15, -0.4}}) {
    SCOPED_TRACE("mirror " + std::to_string(c.mirror) + ", receiver " + std::to_string(c.receiver));
    const dvec3 light = glm::normalize(dvec3(1, 0, -1)), normal = tilted(c.mirror);
    const dvec3 leaves = test::mirrored(light, normal), facing = tilted(c.receiver - 0.5 * M_PI);
    scene::Scene scene;
    scene::Primitive mirror =
        test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, test::addMaterial(scene, test::silver()));
    mirror.normals.assign(4, vec3(normal));
    test::show(scene, mirror);
    addWall(scene, facing);
    test::shine(scene, test::lamp(glsl::light_directional, float(kSun)), vec3(0), vec3(light));
    const auto expected = [&](const dvec3& p, const dvec3&) {
      return fullyLit(p, leaves) ? kGround / M_PI * kSun * -glm::dot(facing, leaves) : nothing;
    };
    const Question q = question(towardsWall(leaves), 128);
    expectPicture(scene, q, expected, {.average = 0.02, .pixels = 300});
    expectReference(scene, q, expected, {.average = 0.2, .pixels = 300});
  }
}

/// A mirror that is a sheet reflects alike from its back: to both sides of it the sun's whole light goes on.
TEST_F(CausticTruth, AMirrorIsAsBrightFromItsBack) {
  const dvec3 light = glm::normalize(dvec3(1, 0, -1)), leaves(light.x, 0, -light.z);
  for (const float side : {1.f, -1.f}) {
    SCOPED_TRACE(side);
    scene::Scene scene;
    scene::Material mirror = test::silver();
    mirror.doubleSided = true;
    test::show(scene, test::quad({0, 0, 0}, {1, 0, 0}, {0, side, 0}, test::addMaterial(scene, mirror)));
    addWall(scene, {-1, 0, 0});
    test::shine(scene, test::lamp(glsl::light_directional, float(kSun)), vec3(0), vec3(light));
    const auto expected = [&](const dvec3& p, const dvec3&) {
      return fullyLit(p, leaves) ? kGround / M_PI * kSun * leaves.x : nothing;
    };
    Question q = question(towardsWall(leaves), 128);
    expectPicture(scene, q, expected, {.average = 0.02, .pixels = 300});
    for (const int interfaces : {0, reference::kAllInterfaces}) {
      q.interfaces = interfaces;
      expectReference(scene, q, expected, {.average = 0.2, .pixels = 300});
    }
  }
}

/// A pane 0.15 m before the eye, beside the light's way: where it shows its back to the camera and has one
/// side, or lies before the near plane, the camera looks through it, at all of the caustic.
TEST_F(CausticTruth, WhatTheCameraLooksThroughHidesNoCaustics) {
  const dvec3 light = glm::normalize(dvec3(1, 0, -1)), leaves(light.x, 0, -light.z);
  for (const bool clipped : {false, true}) {
    SCOPED_TRACE(clipped ? "before the near plane" : "seen from behind");
    scene::Scene scene;
    test::show(scene, test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, test::addMaterial(scene, test::silver())));
    addWall(scene, {-1, 0, 0});
    scene::Material pane = test::lambertian(0.5f);
    pane.doubleSided = clipped;
    test::show(scene, test::quad({-1.65f, -0.57f, 1.2f}, {0, 0.1f, 0}, {0, 0, 0.1f},
                                 test::addMaterial(scene, pane)));
    test::shine(scene, test::lamp(glsl::light_directional, float(kSun)), vec3(0), vec3(light));
    const auto expected = [&](const dvec3& p, const dvec3&) {
      return fullyLit(p, leaves) ? kGround / M_PI * kSun * leaves.x : nothing;
    };
    Question q = question(towardsWall(leaves), 128);
    if (clipped) q.camera.near = 0.3f;
    expectPicture(scene, q, expected, {.average = 0.02, .pixels = 300});
    for (const int interfaces : {0, reference::kAllInterfaces}) {
      q.interfaces = interfaces;
      expectReference(scene, q, expected, {.average = 0.2, .pixels = 300});
    }
  }
}

/// Half of a mirror is cut out: what it sends to the wall is half of the caustic, with its edge in the
/// middle.
TEST_F(CausticTruth, TheHolesOfAMirrorReflectNothing) {
  const dvec3 light = glm::normalize(dvec3(1, 0, -1)), leaves(light.x, 0, -light.z);
  scene::Scene scene;
  scene::TextureImage image;
  image.levels.push_back({2, 1, {255, 255, 255, 255, 255, 255, 255, 0}});  // there where x < 0
  scene.images.push_back(image);
  scene::Material mirror = test::silver();
  mirror.baseColourTexture = {0, scene::Wrap::clamp, scene::Wrap::clamp};
  mirror.alphaCutoff = 0.5f;
  test::show(scene, test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, test::addMaterial(scene, mirror)));
  addWall(scene, {-1, 0, 0});
  test::shine(scene, test::lamp(glsl::light_directional, float(kSun)), vec3(0), vec3(light));
  const auto expected = [&](const dvec3& p, const dvec3&) {
    const double x = (p - leaves * (p.z / leaves.z)).x;
    if (!fullyLit(p, leaves) || std::abs(x) < 0.1) return nothing;
    return x < 0 ? kGround / M_PI * kSun * leaves.x : 0.0;
  };
  Question q = question(towardsWall(leaves), 512);
  expectPicture(scene, q, expected, {.mean = 0.02, .average = 0.02, .pixels = 300});
  for (const int interfaces : {0, reference::kAllInterfaces}) {
    q.interfaces = interfaces;
    expectReference(scene, q, expected, {.average = 0.2, .pixels = 300});
  }
}

/// The sun through a plate of glass, 0.2 m thick, whose front may have tilted normals: Snell's directions,
/// Fresnel's losses at both sides and Beer's on the way; where a shading normal bends light, its beam's
/// radiance is kept (over the squared index), so that the irradiance across it changes as its solid angle
/// does, by the cosines before and behind. Parallel sides pass the whole geometric series of reflections
/// between them: T^2 a / (1 - R^2 a^2).
TEST_F(CausticTruth, GlassPassesWhatFresnelAndBeerLeave) {
  constexpr double ior = 1.5, thickness = 0.2, absorbed = 1.7;  // 1/m
  for (const double angle : {0.0, 0.2}) {
    SCOPED_TRACE(angle);
    const dvec3 light = glm::normalize(dvec3(0.5, 0, -1)), front = tilted(angle), back(0, 0, 1);
    const dvec3 within = test::snell(light, front, 1 / ior), leaves = test::snell(within, back, ior);
    const double way = thickness / -within.z, passes = std::exp(-absorbed * way);
    const double in = test::fresnel(-glm::dot(light, front), 1, ior), out = test::fresnel(-within.z, ior, 1);
    const double beam = glm::dot(light, front) / glm::dot(within, front) * within.z / leaves.z;
    const double once = (1 - in) * (1 - out) * passes * beam;

    scene::Scene scene;
    scene::Material material = test::glass(float(ior));
    material.attenuationColour = vec3(float(std::exp(-absorbed)));
    material.attenuationDistance = 1;
    const int glass = test::addMaterial(scene, material);
    scene::Primitive plate = test::quad({0, 0, 0.7f}, {2, 0, 0}, {0, 2, 0}, glass);
    plate.normals.assign(4, vec3(front));
    test::show(scene, test::joined(plate, test::quad({0, 0, 0.5f}, {2, 0, 0}, {0, -2, 0}, glass)));
    test::show(scene, test::quad({0, 0, 0}, {6, 0, 0}, {0, 6, 0},
                                 test::addMaterial(scene, test::lambertian(float(kGround)))));
    test::shine(scene, test::lamp(glsl::light_directional, float(kSun)), vec3(0), vec3(light));
    const dvec3 middle = 0.2 * within / -within.z + 0.5 * leaves / -leaves.z;
    Question q = question(scene::lookAt({float(middle.x), -2, 0.42f}, {float(middle.x), 0, 0}, 0.6f), 192);
    const auto expected = [&](double transmitted) {
      return [=](const dvec3& p, const dvec3&) {
        const bool whole = std::abs(p.z) < 1e-3 && std::abs(p.x - middle.x) < 0.5 && std::abs(p.y) < 0.5;
        return whole ? kGround / M_PI * kSun * transmitted * -leaves.z : nothing;
      };
    };
    expectPicture(scene, q, expected(once), {.average = 0.02, .pixels = 300});
    expectReference(scene, q, expected(once), {.average = 0.2, .pixels = 300});
    if (angle != 0) continue;
    q.interfaces = reference::kAllInterfaces;
    expectReference(scene, q, expected(once / (1 - std::pow(in * passes, 2))),
                    {.average = 0.3, .pixels = 300});
  }
}

/// Two mirrors that meet at a right angle show a lamp three times: beside each, and behind their edge, over
/// both. A floor between them is lit by all three; the picture, and the reference within the same limit, have
/// the two of one reflection.
TEST_F(CausticTruth, AMirrorCornerIsLitByThreeImages) {
  constexpr double intensity = 5;
  const dvec3 lamp(0.7, 0.5, 0.6);
  scene::Scene scene;
  const int silver = test::addMaterial(scene, test::silver());
  test::show(scene, test::quad({0, 1, 1}, {0, 2, 0}, {0, 0, 2}, silver));  // x = 0, facing +x
  test::show(scene, test::quad({1, 0, 1}, {0, 0, 2}, {2, 0, 0}, silver));  // y = 0, facing +y
  test::show(scene, test::quad({1, 1, 0}, {2, 0, 0}, {0, 2, 0},
                               test::addMaterial(scene, test::lambertian(float(kGround)))));
  test::shine(scene, test::lamp(glsl::light_point, float(intensity)), vec3(lamp));
  const auto expected = [&](bool both) {
    return [=](const dvec3& p, const dvec3&) {
      if (std::abs(p.z) > 1e-3 || std::min(p.x, p.y) < 0.1 || std::max(p.x, p.y) > 1.4) return nothing;
      double sum = 0;
      for (const auto& [x, y] : {std::pair(-1, 1), std::pair(1, -1), std::pair(-1, -1)}) {
        if (x + y == -2 && !both) continue;
        const dvec3 towards = dvec3(x, y, 1) * lamp - p;
        sum += intensity * towards.z / std::pow(glm::length(towards), 3);
      }
      return kGround / M_PI * sum;
    };
  };
  Question q = question(scene::lookAt({1.6f, 1.7f, 1.9f}, {0.7f, 0.7f, 0}, 0.7f), 256);
  expectPicture(scene, q, expected(false), {.average = 0.03});
  expectReference(scene, q, expected(false), {.average = 0.3});
  q.interfaces = reference::kAllInterfaces;
  expectReference(scene, q, expected(true), {.average = 0.3});
}

}  // namespace
}  // namespace limn
