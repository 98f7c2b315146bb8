#include "assets/scenes/rose_window.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace limn::assets {

Image roseWindow() {
  constexpr int petals = 8;
  constexpr float turn = 2 * glm::pi<float>();
  constexpr int size = 512;
  return makeImage(size, size, [](glm::vec2 uv) {
    const glm::vec2 p = 2.f * uv - 1.f;
    const float radius = glm::length(p), sector = (std::atan2(p.y, p.x) / turn + 0.5f) * petals;
    const float across = std::abs(sector - std::floor(sector) - 0.5f) / petals * turn * radius;
    const float half = turn * radius / (2 * petals);
    const int petal = static_cast<int>(sector) % petals;
    constexpr float rings[] = {0.16f, 0.5f, 0.86f};
    float lead = half - across;  // to the nearest bar, where the unit is half the window's side
    if (radius < rings[0]) lead = 1;
    for (const float ring : rings) lead = std::min(lead, std::abs(radius - ring));
    if (radius > rings[2]) return glm::vec4(0, 0, 0, 1);
    // A texel on the edge of the lead is glass as far as the glass covers it: steps would be seen on the
    // floor.
    const float glass = glm::clamp((lead - 0.02f) * (0.5f * size) + 0.5f, 0.f, 1.f);
    if (radius < rings[0]) return glm::vec4(glass * glm::vec3(1, 0.85f, 0.4f), 1);
    constexpr glm::vec3 inner[] = {{1, 0.15f, 0.08f}, {1, 0.6f, 0.05f}},
                        outer[] = {{0.08f, 0.2f, 1}, {0.1f, 0.8f, 0.25f}};
    return glm::vec4(glass * (radius < rings[1] ? inner[petal % 2] : outer[petal % 2]), 1);
  });
}

}  // namespace limn::assets
