// What the reference looks up in a scene: the environment, textures, and the rays of the camera.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/reference/private/sampler.h"
#include "core/scene/environment_light.h"
#include "core/scene/texture_lookup.h"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;

TEST(ReferenceEnvironment, DensityIntegratesToOneAndFollowsTheRadiance) {
  scene::Environment map;
  map.width = 7;
  map.height = 5;
  for (int i = 0; i < 35; ++i) map.texels.emplace_back(static_cast<float>((i * 37) % 11));
  map.rotation = 0.4f;
  const scene::EnvironmentLight light(map);
  double integral = 0, energy = 0;
  const int n = 512;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const double theta = M_PI * (j + 0.5) / n, phi = M_PI * (i + 0.5) / n;
      const glm::vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
      const double solidAngle = std::sin(theta) * (M_PI / n) * (M_PI / n);
      integral += static_cast<double>(light.pdf(d)) * solidAngle;
      energy += static_cast<double>(light.radiance(d).r) * solidAngle;
    }
  EXPECT_NEAR(integral, 1, 1e-3);
  double estimate = 0;
  const int count = 4096;
  Sampler sampler(1, 2, 0);
  for (int i = 0; i < count; ++i) {
    sampler.startSample(static_cast<uint32_t>(i));
    const glm::vec3 d = light.sample(sampler.pair(0));
    EXPECT_NEAR(glm::length(d), 1, 1e-4);
    const scene::EnvironmentLight::Sight seen = light.at(d);
    EXPECT_EQ(seen.radiance, light.radiance(d));
    EXPECT_EQ(seen.pdf, light.pdf(d));
    estimate += static_cast<double>(seen.radiance.r / seen.pdf) / count;
  }
  EXPECT_NEAR(estimate / energy, 1, 2e-3);
}

/// By its direction numbers (Sobol 1967): each is the one before it and half of that, digit by digit.
TEST(ReferenceSampler, TheSecondDimensionIsSobols) {
  for (uint32_t sample = 0; sample < 4096; ++sample) {
    const uint32_t index = sample < 1024 ? sample : static_cast<uint32_t>(mixBits(sample));
    uint32_t expected = 0, direction = 1u << 31;
    for (int bit = 0; bit < 32; ++bit, direction ^= direction >> 1)
      if ((index >> bit & 1u) != 0) expected ^= direction;
    ASSERT_EQ(reverseBits(sobolSecondReversed(index)), expected) << index;
  }
}

/// Of 64 successive samples one lies in each of 64 equal boxes, whatever their shape.
TEST(ReferenceSampler, PairsAreStratified) {
  for (const uint32_t first : {0u, 64u, 6400u})
    for (uint32_t number = 0; number < 8; ++number)
      for (int columns = 1, rows = 64; columns <= 64; columns *= 2, rows /= 2) {
        uint64_t met = 0;
        Sampler sampler(5, 17, number % 2);
        for (uint32_t i = first; i < first + 64; ++i) {
          sampler.startSample(i);
          const glm::vec2 point = sampler.pair(number);
          const int column = static_cast<int>(point.x * static_cast<float>(columns)),
                    row = static_cast<int>(point.y * static_cast<float>(rows));
          ASSERT_TRUE(column >= 0 && column < columns && row >= 0 && row < rows) << point.x << " " << point.y;
          met |= uint64_t{1} << (row * columns + column);
        }
        EXPECT_EQ(met, ~uint64_t{0}) << first << " " << number << " " << columns;
      }
}

TEST(ReferenceSampler, LightPathsBeyond32BitsDoNotRepeat) {
  constexpr uint64_t kBlock = uint64_t{1} << 32;
  const auto numbers = [](uint64_t path) { return pathSampler(3, 1, path).pair(0); };
  EXPECT_EQ(numbers(kBlock + 7), numbers(kBlock + 7));
  for (uint64_t path = 0; path < 64; ++path) {
    EXPECT_NE(numbers(path), numbers(path + kBlock)) << path;
    EXPECT_NE(numbers(path + kBlock), numbers(path + 2 * kBlock)) << path;
  }
}

TEST(ReferenceTexture, WrapsFiltersAndBlendsLevels) {
  scene::Scene scene;
  auto& image = scene.images.emplace_back();
  image.levels.resize(2);
  image.levels[0] = {2, 1, {0, 0, 0, 255, 255, 255, 255, 255}};
  image.levels[1] = {1, 1, {51, 51, 51, 255}};
  scene::TextureRef texture{0, scene::Wrap::repeat, scene::Wrap::repeat};
  const auto at = [&](float u, float lod) { return sampleTexture(scene, texture, {u, 0.5f}, lod).r; };
  EXPECT_FLOAT_EQ(at(0.25f, 0), 0);
  EXPECT_FLOAT_EQ(at(0.75f, 0), 1);
  EXPECT_FLOAT_EQ(at(0.5f, -3), 0.5f);
  EXPECT_FLOAT_EQ(at(0, 0), 0.5f);      // between the last texel and the first
  EXPECT_FLOAT_EQ(at(-0.25f, 0), 1);    // one period to the left
  EXPECT_FLOAT_EQ(at(0.75f, 1), 0.2f);  // the smaller level
  EXPECT_FLOAT_EQ(at(0.75f, 0.5f), 0.6f);
  EXPECT_FLOAT_EQ(at(0.75f, 40), 0.2f);
  texture.wrapS = scene::Wrap::clamp;
  EXPECT_FLOAT_EQ(at(0, 0), 0);
  EXPECT_FLOAT_EQ(at(5, 0), 1);
  texture.wrapS = scene::Wrap::mirror;
  EXPECT_FLOAT_EQ(at(1.25f, 0), 1);
  EXPECT_FLOAT_EQ(at(1.75f, 0), 0);
}

TEST(Camera, RaysMeetTheirPixels) {
  glsl::FrameBlock frame{};
  scene::Bounds bounds;
  bounds.add({-1, -1, -1});
  bounds.add({1, 1, 1});
  const scene::CameraPose camera = scene::lookAt({1, 2, 5}, {0, 0.5f, 0}, 0.7f);
  scene::setCamera(frame, camera, bounds, 64, 48);
  for (const glm::vec2 pixel :
       {glm::vec2(0, 0), glm::vec2(63, 0), glm::vec2(10, 40), glm::vec2(31.5f, 23.5f)}) {
    const glm::vec3 direction = glm::vec3(frame.view_ray_origin) + pixel.x * glm::vec3(frame.view_ray_dx) +
                                pixel.y * glm::vec3(frame.view_ray_dy);
    const float depth = 5;
    const glm::vec4 world(glm::vec3(frame.camera_position) + depth * direction, 1);
    EXPECT_NEAR(-(frame.world_to_view * world).z, depth, 1e-5f);
    const glm::vec4 clip = frame.world_to_clip * world;
    EXPECT_NEAR((clip.x / clip.w * 0.5f + 0.5f) * 64, pixel.x + 0.5f, 1e-3f);
    EXPECT_NEAR((clip.y / clip.w * 0.5f + 0.5f) * 48, pixel.y + 0.5f, 1e-3f);
    EXPECT_LT(std::abs(clip.z), clip.w);
  }
  const scene::DepthRange range = scene::fitDepthRange(camera, bounds);
  EXPECT_GT(range.near, 3);
  EXPECT_LT(range.far, 8);
  EXPECT_THROW(scene::lookAt({1, 1, 1}, {1, 1, 1}, 0.7f), UsageError);
  EXPECT_THROW(scene::setCamera(frame, camera, bounds, 0, 4), UsageError);
}

}  // namespace
}  // namespace limn::reference
