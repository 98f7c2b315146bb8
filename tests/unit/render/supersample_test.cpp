#include "core/render/supersample.h"

#include <gtest/gtest.h>

#include "core/scene/camera.h"

namespace limn::render {
namespace {

/// The rays of shifted cameras are those of a finer grid, as the reference's --aa has it.
TEST(ShiftedCamera, HasTheRaysOfAFinerGrid) {
  const scene::CameraPose camera = scene::lookAt({1, 2, 7}, {0.5f, 0.2f, -1}, 0.7f);
  const scene::Bounds bounds{glm::vec3(-2), glm::vec3(2)};
  const glm::ivec2 size(12, 8);
  for (const int aa : {1, 2, 3}) {
    glsl::FrameBlock fine{};
    scene::setCamera(fine, camera, bounds, size.x * aa, size.y * aa);
    for (int column = 0; column < aa; ++column)
      for (int row = 0; row < aa; ++row) {  // from below
        glsl::FrameBlock coarse{};
        const glm::dvec2 offset((column + 0.5) / aa - 0.5, (row + 0.5) / aa - 0.5);
        scene::setCamera(coarse, shifted(camera, offset, size), bounds, size.x, size.y);
        EXPECT_LT(glm::length(coarse.camera_position - fine.camera_position), 1e-6f);
        for (int y = 0; y < size.y; ++y)
          for (int x = 0; x < size.x; ++x) {
            const auto ray = [](const glsl::FrameBlock& f, int px, int py) {
              return glm::vec3(f.view_ray_origin + static_cast<float>(px) * f.view_ray_dx +
                               static_cast<float>(py) * f.view_ray_dy);
            };
            const glm::vec3 wanted = ray(fine, x * aa + column, y * aa + row), found = ray(coarse, x, y);
            EXPECT_LT(glm::length(wanted - found), 1e-6f) << aa << ' ' << x << ' ' << y;
            // And the ray's points are drawn at that pixel's centre.
            const glm::vec4 clip =
                coarse.world_to_clip * glm::vec4(glm::vec3(coarse.camera_position) + 5.0f * wanted, 1);
            EXPECT_NEAR((clip.x / clip.w + 1) / 2 * size.x, x + 0.5f, 1e-3f);
            EXPECT_NEAR((clip.y / clip.w + 1) / 2 * size.y, y + 0.5f, 1e-3f);
          }
      }
  }
}

TEST(ShiftedCamera, KeepsDistancesAlongTheAxis) {
  const scene::CameraPose camera = scene::lookAt({1, 2, 7}, {0.5f, 0.2f, -1}, 0.7f);
  const scene::CameraPose moved = shifted(camera, {0.4, -0.3}, {12, 8});
  for (int column = 0; column < 4; ++column)
    EXPECT_EQ(moved.worldToView[column][2], camera.worldToView[column][2]);
  EXPECT_EQ(shifted(camera, glm::dvec2(0), {12, 8}).worldToView, camera.worldToView);
}

}  // namespace
}  // namespace limn::render
