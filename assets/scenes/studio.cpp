// A photographer's studio as an environment map: what lights scenes that bring no light of their own.
#include <cmath>

#include "assets/scenes/scenes.h"
#include "glsl/numeric/equirectangular.glsl"

namespace limn::assets {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kFloor = 0.05f, kWalls = 0.15f;  ///< radiance below and above the horizon
constexpr float kCove = 0.15f;                   ///< sine of the elevation up to which one becomes the other

/// A uniform rectangle that stands upright across the direction to its centre: a soft box or a strip light.
struct Panel {
  vec3 centre;  ///< unit
  vec2 half;    ///< half of its sides at distance 1
  float radiance;

  bool seenIn(vec3 d) const {
    const vec3 right = glm::normalize(glm::cross(centre, vec3(0, 1, 0))), up = glm::cross(right, centre);
    const float forward = glm::dot(d, centre);
    return forward > 0 && std::abs(glm::dot(d, right)) < half.x * forward &&
           std::abs(glm::dot(d, up)) < half.y * forward;
  }
};

const Panel kPanels[] = {
    {glm::normalize(vec3(-1, 0.6f, 0.15f)), {0.5f, 0.36f}, 0.85f},  // a large soft box above left
    {glm::normalize(vec3(1, 0.55f, -0.2f)), {0.12f, 0.35f}, 2},     // a strip on the right
};

vec3 studioRadiance(vec2 uv) {
  const vec3 d = glsl::equirectangular_direction(uv);
  for (const Panel& panel : kPanels)
    if (panel.seenIn(d)) return vec3(panel.radiance);
  return vec3(glm::mix(kFloor, kWalls, glm::clamp(0.5f + 0.5f * d.y / kCove, 0.0f, 1.0f)));
}

}  // namespace

Image makeStudio() {
  constexpr int kAcross = 16;  // samples of a pixel: edges lie where they should to 1/32 of one
  constexpr vec2 size(256, 128);
  return makeImage(256, 128, [&](vec2 uv) {
    vec3 sum(0);
    for (int i = 0; i < kAcross * kAcross; ++i) {
      const vec2 offset = (vec2(i % kAcross, i / kAcross) + 0.5f) / float(kAcross) - 0.5f;
      sum += studioRadiance(uv + offset / size);
    }
    return glm::vec4(sum / float(kAcross * kAcross), 1);
  });
}

}  // namespace limn::assets
