// Light over mirrors and glass onto matte surfaces, where it has closed forms.
#include "tests/truth/truth_test.h"

namespace limn {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double albedo = 0.6, sun = 2;  // W/m^2 across its light

/// The normal +z turned about y, towards +x by `angle`.
dvec3 tilted(double angle) {
  return {std::sin(angle), 0, std::cos(angle)};
}

class CausticTruth : public TruthTest {
 protected:
  static Question question(const scene::CameraPose& camera, int spp) {
    return {.camera = camera,
            .output = Output::caustic,
            .techniques = {technique("surface_caustics")},
            .spp = spp};
  }

  /// In the plane x = 1.2, facing what lies at the origin, above z = 0; the sun that shines along (1, 0, -1)
  /// passes it and lights it, too.
  static void addWall(scene::Scene& scene, const dvec3& normal) {
    scene::Primitive wall = test::quad({1.2f, 0, 2}, {0, 4, 0}, {0, 0, -4},
                                       test::addMaterial(scene, test::lambertian(float(albedo))));
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
  struct Case {
    double mirror, receiver;  ///< radians
  };
  for (const Case& c : {Case{0, 0}, Case{0.15, 0}, Case{-0.15, 0}, Case{0, 0.4}, Case{0.15, -0.4}}) {
    SCOPED_TRACE("mirror " + std::to_string(c.mirror) + ", receiver " + std::to_string(c.receiver));
    const dvec3 light = glm::normalize(dvec3(1, 0, -1)), normal = tilted(c.mirror);
    const dvec3 leaves = test::mirrored(light, normal), facing = tilted(c.receiver - 0.5 * M_PI);
    scene::Scene scene;
    scene::Primitive mirror =
        test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, test::addMaterial(scene, test::silver()));
    mirror.normals.assign(4, vec3(normal));
    test::show(scene, mirror);
    addWall(scene, facing);
    test::shine(scene, test::lamp(glsl::light_directional, float(sun)), vec3(0), vec3(light));
    const auto expected = [&](const dvec3& p, const dvec3&) {
      return fullyLit(p, leaves) ? albedo / M_PI * sun * -glm::dot(facing, leaves) : nothing;
    };
    const Question q = question(towardsWall(leaves), 128);
    expectPicture(scene, q, expected, {.average = 0.02, .pixels = 300});
    expectReference(scene, q, expected, {.average = 0.2, .pixels = 300});
  }
}

}  // namespace
}  // namespace limn
