// Pixels whose centres meet edges of the mesh exactly, as symmetric cameras in axis-aligned rooms have them
// by the thousand: a closed room has no holes, and one that is empty no shadows.
#include <gtest/gtest.h>

#include "core/scene_io/load.h"
#include "tests/support/paths.h"
#include "tests/support/reference_scene.h"

namespace limn::reference::test {
namespace {

/// The inside of the box centre +- half, one quad a side, corners at the same floats.
World room(const glm::vec3& centre, const glm::vec3& half) {
  World world;
  const int white = world.addMaterial(glm::vec3(0.5f));
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.f, 1.f}) {
      glm::vec3 normal(0), u(0), v(0);
      normal[axis] = -side;
      u[(axis + 1) % 3] = 2 * half[(axis + 1) % 3];
      v = glm::cross(normal, u);
      v *= half[(axis + 2) % 3] / half[(axis + 1) % 3];
      world.addQuad(centre - normal * half[axis], u, v, white);
    }
  }
  return world;
}

/// Pixels that see nothing, and pixels that see a surface in shadow.
struct Black {
  int missed = 0, shadowed = 0;
};

Black black(const Image& image, int channel) {
  Black found;
  const int coverage = image.channel("coverage");
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      if (image.at(x, y, coverage) == 0.f)
        ++found.missed;
      else
        found.shadowed += image.at(x, y, channel) < 1.f;
    }
  return found;
}

struct View {
  glm::vec3 eye, target;
  float yfov;
};

TEST(Edges, AClosedEmptyRoomHasNeitherHolesNorShadows) {
  const float right = 0.5f * glsl::pi;
  for (const glm::vec3 half : {glm::vec3(1), glm::vec3(1.5f, 1, 2), glm::vec3(2.78f, 2.74f, 2.796f)}) {
    for (const glm::vec3 centre : {glm::vec3(0), glm::vec3(2.78f, 2.74f, -2.8f)}) {
      World world = room(centre, half);
      world.addLight(glsl::light_point, centre + 0.25f * half, {0, -1, 0}, glm::vec3(1));
      world.addLight(glsl::light_point, centre, {0, -1, 0}, glm::vec3(1));
      for (const View& view : {View{{0, 0, 0}, {0, 0, -1}, right}, View{{0, 0, 0.75f}, {0, 0, -1}, right},
                               View{{0, 0, 0}, {1, 0, 0}, 0.8f}, View{{0, 0, 0.5f}, {0, -0.5f, 0}, right}}) {
        world.camera = scene::lookAt(centre + view.eye * half, centre + view.target * half, view.yfov);
        for (const int size : {100, 129}) {
          for (const int light : {0, 1}) {
            Request request = world.request(size, Term::visibility, 2);
            request.light = light;
            const Image image = render(request).image;
            const Black found = black(image, image.channel("V"));
            EXPECT_EQ(found.missed, 0) << half.x << " " << centre.x << " " << view.eye.z << " " << size;
            EXPECT_EQ(found.shadowed, 0) << half.x << " " << centre.x << " " << view.eye.z << " " << size;
          }
        }
      }
    }
  }
}

/// A covered picture with single pixels that see nothing.
int lonelyMisses(const Image& image) {
  const int coverage = image.channel("coverage");
  int count = 0;
  for (int y = 1; y + 1 < image.height(); ++y)
    for (int x = 1; x + 1 < image.width(); ++x)
      count += image.at(x, y, coverage) == 0.f && image.at(x - 1, y, coverage) > 0.f &&
               image.at(x + 1, y, coverage) > 0.f && image.at(x, y - 1, coverage) > 0.f &&
               image.at(x, y + 1, coverage) > 0.f;
  return count;
}

TEST(Edges, AMillionPixelsOfTheCornellBoxAreSeen) {
  World world;
  world.scene =
      scene::load(std::filesystem::path(limn::test::kBinaryDir) / "assets/cornell_box/cornell_box.glb");
  world.pose = scene::evaluate(world.scene, 0);
  world.camera = world.pose.cameras.front();
  int missed = 0, pixels = 0;
  for (const int size : {232, 512, 821}) {
    Request request = world.request(size, Term::visibility, 2);
    request.light = 0;
    const Image image = render(request).image;
    missed += lonelyMisses(image);
    pixels += size * size;
  }
  EXPECT_GE(pixels, 980000);
  EXPECT_EQ(missed, 0);
}

}  // namespace
}  // namespace limn::reference::test
