// What the window shows is what PNG files hold.
#include "core/image/tone_mapping.h"

#include <algorithm>
#include <cstdlib>

#include "tests/gpu/render_test.h"

namespace limn {
namespace {

class ToneMappingTest : public RenderTest {
 protected:
  /// The largest difference of a code between the window's picture and the file's.
  static int largestDifference(render::Renderer& renderer, render::Settings s, const ToneMapping& tone) {
    s.display = tone;
    const glm::ivec2 size = s.size;
    const Image8 file = toneMapped(picture(renderer, std::move(s)), tone);
    std::vector<uint8_t> window(file.data.size());
    renderer.display().read(0, GL_RGBA, GL_UNSIGNED_BYTE, window.data(), window.size());
    int largest = 0;
    const auto row = static_cast<size_t>(4 * size.x);
    for (size_t y = 0; y < static_cast<size_t>(size.y); ++y)
      for (size_t i = 0; i < row; ++i)
        largest = std::max(largest, std::abs(window[(static_cast<size_t>(size.y) - 1 - y) * row + i] -
                                             file.data[y * row + i]));
    return largest;
  }
};

TEST_F(ToneMappingTest, WindowsShowWhatFilesHold) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  for (const ToneCurve curve : {ToneCurve::none, ToneCurve::neutral, ToneCurve::agx})
    for (const float ev : {-2.0f, 0.0f, 5.0f})
      EXPECT_LE(largestDifference(renderer, settings(40, 30, Term::final), {ev, curve}), 1)
          << kToneCurves[static_cast<size_t>(curve)] << ' ' << ev;
  EXPECT_LE(largestDifference(renderer, settings(40, 30, Term::visibility, {quick("pcss")}, 0),
                              {-1, ToneCurve::agx}),
            1);
}

}  // namespace
}  // namespace limn
