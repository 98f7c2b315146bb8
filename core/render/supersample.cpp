#include "core/render/supersample.h"

#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace limn::render {

scene::CameraPose shifted(const scene::CameraPose& camera, const glm::dvec2& offset, glm::ivec2 size) {
  const double pixel = 2 * std::tan(0.5 * static_cast<double>(camera.yfov)) / size.y;
  glm::dmat4 shear(1);
  shear[2][0] = offset.x * pixel;
  shear[2][1] = offset.y * pixel;
  scene::CameraPose moved = camera;
  moved.worldToView = glm::mat4(shear * glm::dmat4(camera.worldToView));
  return moved;
}

Image supersample(Renderer& renderer, const scene::CameraPose& camera, glm::ivec2 size, int aa,
                  const std::function<void()>& renderFrame) {
  const auto renderFrames = [&] {
    for (int frames = renderer.framesOfPicture(); frames > 0; --frames) renderFrame();
  };
  if (aa == 1) {
    renderer.setCamera(camera);
    renderFrames();
    return renderer.read();
  }
  Image picture;
  std::vector<double> sums;
  for (int row = 0; row < aa; ++row) {
    for (int column = 0; column < aa; ++column) {
      const glm::dvec2 offset((column + 0.5) / aa - 0.5, 0.5 - (row + 0.5) / aa);
      renderer.setCamera(shifted(camera, offset, size));
      renderFrames();
      Image sample = renderer.read();
      const auto channels = static_cast<size_t>(sample.channelCount());
      sums.resize(3 * sample.pixelCount());
      for (size_t i = 0; i < sums.size(); ++i) sums[i] += sample.data()[i / 3 * channels + i % 3];
      if (row == (aa - 1) / 2 && column == aa / 2) picture = std::move(sample);
    }
  }
  renderer.setCamera(camera);
  const auto channels = static_cast<size_t>(picture.channelCount());
  for (size_t i = 0; i < sums.size(); ++i)
    picture.data()[i / 3 * channels + i % 3] = static_cast<float>(sums[i] / (aa * aa));
  return picture;
}

Image supersample(Renderer& renderer, const scene::CameraPose& camera, glm::ivec2 size, int aa) {
  return supersample(renderer, camera, size, aa, [&] { renderer.render(); });
}

}  // namespace limn::render
