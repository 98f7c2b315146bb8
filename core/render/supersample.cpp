#include "core/render/supersample.h"

#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

namespace limn::render {
namespace {

/// Calls visit(i, value) for those channels of all pixels, where i counts the calls.
template <class Visit>
void forEachValue(Image& image, const std::vector<int>& channels, Visit visit) {
  size_t i = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const std::span<float> pixel = image.pixel(x, y);
      for (const int channel : channels) visit(i++, pixel[static_cast<size_t>(channel)]);
    }
}

}  // namespace

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
  std::vector<int> averaged{0, 1, 2};
  std::vector<double> sums;  // of these channels, pixel after pixel
  for (int row = 0; row < aa; ++row) {
    for (int column = 0; column < aa; ++column) {
      const glm::dvec2 offset((column + 0.5) / aa - 0.5, 0.5 - (row + 0.5) / aa);
      renderer.setCamera(shifted(camera, offset, size));
      renderFrames();
      Image sample = renderer.read();
      if (sums.empty()) {
        if (const std::optional<int> alpha = sample.findChannel("A")) averaged.push_back(*alpha);
        sums.resize(averaged.size() * sample.pixelCount());
      }
      forEachValue(sample, averaged, [&](size_t i, float& value) { sums[i] += value; });
      if (row == (aa - 1) / 2 && column == aa / 2) picture = std::move(sample);
    }
  }
  renderer.setCamera(camera);
  forEachValue(picture, averaged,
               [&](size_t i, float& value) { value = static_cast<float>(sums[i] / (aa * aa)); });
  return picture;
}

Image supersample(Renderer& renderer, const scene::CameraPose& camera, glm::ivec2 size, int aa) {
  return supersample(renderer, camera, size, aa, [&] { renderer.render(); });
}

}  // namespace limn::render
