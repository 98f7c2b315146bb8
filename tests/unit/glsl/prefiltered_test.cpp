// Maps of prefiltered environments and the lookups in them (glsl/light/prefiltered.glsl), against closed
// forms and integration.
#include "glsl/light/prefiltered.glsl"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <vector>

#include "tests/unit/glsl/random.h"

namespace limn::glsl {
namespace {

/// A layout of maps.
struct Layout {
  int layers, width;  ///< width: in sizes
  std::function<vec3(vec3, int)> place;
  std::function<vec3(vec2, int, int)> direction;
  std::function<float(vec2, int)> density;
};

const std::array kLayouts{
    Layout{2, 1, dual_paraboloid_place, dual_paraboloid_direction, dual_paraboloid_density},
    Layout{1, 2, polar_map_place,
           [](vec2 texel, int, int size) { return polar_map_direction(texel, ivec2(2 * size, size)); },
           [](vec2 texel, int size) { return polar_map_density(texel, ivec2(2 * size, size)); }}};

TEST(Prefiltered, PlacesAndDirectionsAreInverse) {
  Random random(5);
  for (const Layout& layout : kLayouts)
    for (const int size : {8, 33, 256})
      for (int i = 0; i < 1000; ++i) {
        const vec3 d = random.direction(), place = layout.place(d, size);
        const vec2 texel =
            vec2(place.x * static_cast<float>(layout.width), place.y) * static_cast<float>(size);
        const vec3 back = layout.direction(texel, static_cast<int>(place.z), size);
        EXPECT_LT(length(back - d), 2e-5f) << size;
        EXPECT_LT(place.z, static_cast<float>(layout.layers));
      }
}

/// Both sides of a map of 400 x 200 texels are halved and rounded down: its fifth level has 25 columns.
TEST(Prefiltered, ALevelWithAnOddColumnGoesAllAround) {
  constexpr ivec2 size(25, 12);
  for (int y = 1; y + 1 < size.y; ++y)  // between the poles
    for (int x = 0; x < size.x; ++x) {
      const vec2 texel = vec2(x, y) + vec2(0.5f);
      const vec3 place = polar_map_place(polar_map_direction(texel, size), size.y);
      EXPECT_NEAR(place.x * static_cast<float>(size.x), texel.x, 1e-4f);
      EXPECT_NEAR(place.y * static_cast<float>(size.y), texel.y, 1e-4f);
    }
}

// Between the centres of the outermost texels, so that no lookup leaves the layer, poles and rims included.
TEST(Prefiltered, LookupsStayWithinALayer) {
  Random random(5);
  for (const int size : {8, 64}) {
    const float least = 1 / static_cast<float>(size);
    for (int i = 0; i < 1000; ++i) {
      vec3 d = random.direction();
      if (i % 2 == 0) d = normalize(vec3(d.x, d.y, 1e-7f * d.z));
      const vec3 place = dual_paraboloid_place(d, size);
      EXPECT_GE(std::min(place.x, place.y), least - 1e-6f);
      EXPECT_LE(std::max(place.x, place.y), 1 - least + 1e-6f);
    }
    for (const vec3 pole : {vec3(0, 1, 0), vec3(0, -1, 0)}) {
      const vec3 place = polar_map_place(pole, size);
      EXPECT_NEAR(std::min(place.y, 1 - place.y), 0.5f * least, 1e-6f);
    }
  }
}

/// Bilinear between texel centres; columns of a single layer are repeated.
float lookUp(const Layout& layout, const std::vector<float>& texels, int size, vec3 place) {
  const int width = layout.width * size;
  const float x = place.x * static_cast<float>(width) - 0.5f, y = place.y * static_cast<float>(size) - 0.5f;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto at = [&](int i, int j) {
    return texels[static_cast<size_t>(
        (static_cast<int>(place.z) * size + std::clamp(j, 0, size - 1)) * width + (i + width) % width)];
  };
  const float s = x - static_cast<float>(x0), t = y - static_cast<float>(y0);
  return mix(mix(at(x0, y0), at(x0 + 1, y0), s), mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), s), t);
}

std::vector<float> mapOf(const Layout& layout, int size, const std::function<float(vec3)>& radiance) {
  std::vector<float> texels;
  for (int layer = 0; layer < layout.layers; ++layer)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < layout.width * size; ++x)
        texels.push_back(radiance(layout.direction(vec2(x, y) + vec2(0.5f), layer, size)));
  return texels;
}

float hilly(vec3 d) {
  return 1 + d.x * d.y + 0.5f * std::sin(5 * d.z) * std::cos(4 * d.x);
}

TEST(Prefiltered, NeitherRimNorSeamNorPoleShows) {
  Random random(5);
  constexpr int size = 64;
  std::vector<double> errors;  // of directions without preference
  for (const Layout& layout : kLayouts) {
    const std::vector<float> texels = mapOf(layout, size, hilly);
    double squares = 0, worst = 0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
      vec3 d = random.direction();
      if (i % 4 == 0) d = normalize(vec3(d.x, d.y, 1e-3f * d.z));          // the rim
      if (i % 4 == 1) d = normalize(vec3(1e-3f * d.x, d.y, 1));            // the seam
      if (i % 4 == 2) d = normalize(vec3(0.05f * d.x, d.y, 0.05f * d.z));  // the poles
      const double error = std::abs(lookUp(layout, texels, size, layout.place(d, size)) - hilly(d));
      if (i % 4 == 3) squares += error * error;
      worst = std::max(worst, error);
    }
    errors.push_back(std::sqrt(squares / (count / 4)));
    // Linear interpolation over h radians leaves h^2/8 of the second derivative in each direction; both maps
    // have h = 4 / 62 at most, the largest second derivative of hilly is 0.5 (25 + 16) + 2 = 23.
    EXPECT_LT(worst, 23 * std::pow(4. / 62, 2) / 8);
  }
  RecordProperty("paraboloid", std::to_string(errors[0]));
  RecordProperty("equirectangular", std::to_string(errors[1]));
  // Texels of paraboloids are four times as large in the middle as at the rim: 1.25 over 60000 directions.
  EXPECT_NEAR(errors[0] / errors[1], 1.25, 0.08);
}

TEST(Prefiltered, DensityIsTheSolidAngleOfATexel) {
  Random random(5);
  constexpr int size = 64;
  for (const Layout& layout : kLayouts)
    for (int i = 0; i < 1000; ++i) {
      const vec2 texel = vec2(random(1, static_cast<float>(layout.width * size - 1)), random(1, size - 1));
      constexpr float step = 0.25f;
      const auto at = [&](float x, float y) { return layout.direction(texel + vec2(x, y), 0, size); };
      const vec3 across = (at(step, 0) - at(-step, 0)) / (2 * step),
                 down = (at(0, step) - at(0, -step)) / (2 * step);
      const float measured = length(cross(across, down));
      EXPECT_NEAR(layout.density(texel, size), measured, 2e-3f * measured);
      const vec3 direction = layout.direction(texel, 0, size);
      if (layout.layers == 2 && direction.z >= 0) {
        EXPECT_NEAR(dual_paraboloid_density_towards(direction, size), measured, 2e-3f * measured);
      }
    }
}

}  // namespace
}  // namespace limn::glsl
