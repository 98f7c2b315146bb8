#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/image.h"
#include "core/scene_io/load.h"

namespace limn::scene {

bool isEnvironmentFile(const std::filesystem::path& file) {
  const std::string extension = lowerCase(file.extension().string());
  return extension == ".exr" || extension == ".hdr";
}

Environment loadEnvironment(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  if (!isEnvironmentFile(file))
    throw Error(fmt::format("{}: an environment is an equirectangular .exr or .hdr file", file.string()));
  const Image image = readImage(file);
  const std::array<int, 3> rgb = image.rgbChannels(file.string());
  Environment out;
  out.width = image.width();
  out.height = image.height();
  out.texels.resize(image.pixelCount());
  std::size_t clampedPixels = 0;
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      glm::vec3& texel = out.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                                    static_cast<std::size_t>(x)];
      for (int c = 0; c < 3; ++c) {
        texel[c] = image.at(x, y, rgb[static_cast<std::size_t>(c)]);
        if (!std::isfinite(texel[c]))
          throw Error(fmt::format("{}: pixel ({}, {}) is not a finite number", file.string(), x, y));
      }
      const glm::vec3 accepted = glm::clamp(texel, 0.f, kMostEnvironmentRadiance);
      clampedPixels += accepted != texel;
      texel = accepted;
    }
  }
  if (clampedPixels > 0)
    warnings.push_back(fmt::format("{}: {} of {} pixels are below 0 or above {:.0e} and are clamped to that",
                                   file.string(), clampedPixels, out.texels.size(),
                                   kMostEnvironmentRadiance));
  return out;
}

}  // namespace limn::scene
