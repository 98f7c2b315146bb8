#include "core/image/flicker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "glsl/numeric/srgb.glsl"

namespace limn {
namespace {

constexpr float kSame = 1e-3f;

void checkSizes(const Image& a, const Image& b) {
  if (a.width() != b.width() || a.height() != b.height())
    throw Error(fmt::format("two frames of a sequence differ in size: {}x{} and {}x{}", a.width(), a.height(),
                            b.width(), b.height()));
}

float luminanceAt(const Image& image, const std::array<int, 3>& rgb, int x, int y) {
  return glsl::luminance(glm::vec3(image.at(x, y, rgb[0]), image.at(x, y, rgb[1]), image.at(x, y, rgb[2])));
}

}  // namespace

std::vector<bool> stillPixels(const Image& before, const Image& after) {
  checkSizes(before, after);
  struct Channels {
    int z, coverage, id, n[3];
    explicit Channels(const Image& i)
        : z(i.channel("Z")),
          coverage(i.channel("coverage")),
          id(i.channel("id")),
          n{i.channel("N.X"), i.channel("N.Y"), i.channel("N.Z")} {}
  };
  const Channels a(before), b(after);
  std::vector<bool> still;
  still.reserve(before.pixelCount());
  for (int y = 0; y < before.height(); ++y)
    for (int x = 0; x < before.width(); ++x) {
      const float depth = before.at(x, y, a.z);
      bool same = before.at(x, y, a.coverage) > 0 && after.at(x, y, b.coverage) > 0 &&
                  before.at(x, y, a.id) == after.at(x, y, b.id) &&
                  std::abs(after.at(x, y, b.z) - depth) <= kSame * depth;
      for (int k = 0; k < 3; ++k)
        same = same && std::abs(after.at(x, y, b.n[k]) - before.at(x, y, a.n[k])) <= kSame;
      still.push_back(same);
    }
  return still;
}

void Change::add(const Image& before, const Image& after, const std::vector<bool>& still) {
  checkSizes(before, after);
  if (still.size() != before.pixelCount()) throw Error("the mask of still pixels is of another size");
  const auto a = before.rgbChannels(), b = after.rgbChannels();
  size_t pixel = 0;
  for (int y = 0; y < before.height(); ++y)
    for (int x = 0; x < before.width(); ++x) {
      if (!still[pixel++]) continue;
      const auto change =
          static_cast<double>(std::abs(luminanceAt(after, b, x, y) - luminanceAt(before, a, x, y)));
      if (!std::isfinite(change))
        throw Error(
            fmt::format("a sequence changes by no finite number in pixel {},{} from the upper left: a frame "
                        "is not finite",
                        x, y));
      sum += change;
      count += 1;
    }
}

double withoutNoise(double change, double noise) {
  return std::sqrt(std::max(change * change - noise * noise, 0.0));
}

}  // namespace limn
