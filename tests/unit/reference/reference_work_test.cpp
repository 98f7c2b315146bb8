// How the reference does its work: noise estimate, determinism, resuming, stopping.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stop_token>
#include <thread>

#include "core/base/error.h"
#include "core/reference/reference.h"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;

TEST(ReferenceWork, NoiseEstimateIsTheError) {
  World world = floorWorld();
  world.addRectangle({-1, 0.2f, 0}, {0, 0, 1.5f}, {0, 1.2f, 0}, 5);
  for (const int spp : {16, 128}) {
    const Result result = render(world.request(32, Term::direct, spp));
    const Result better = render(world.request(32, Term::direct, 16 * spp));
    double squares = 0, sum = 0;
    const int coverage = result.image.channel("coverage");
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        if (result.image.at(x, y, coverage) == 0.f) continue;
        const double value = static_cast<double>(better.image.at(x, y, 0));
        squares += std::pow(static_cast<double>(result.image.at(x, y, 0)) - value, 2);
        sum += value;
      }
    const double actual = std::sqrt(squares * 1024) / sum;  // all pixels of this view are covered
    EXPECT_GT(result.noiseRms, actual / 1.4) << spp;
    EXPECT_LT(result.noiseRms, actual * 1.4) << spp;
  }
}

TEST(ReferenceWork, NoiseTargetIsMet) {
  const World world = busyWorld();
  Request request = world.request(16, Term::direct, 4096);
  request.noise = 0.02;
  const Result result = render(request);
  EXPECT_LE(result.noiseRms, 0.02);
  EXPECT_LT(result.spp, 4096);
  EXPECT_GE(result.spp, 16);
}

TEST(ReferenceWork, NoiseIsThatOfThePicturesPixels) {
  World world = floorWorld();
  world.addRectangle({-1, 0.2f, 0}, {0, 0, 1.5f}, {0, 1.2f, 0}, 5);
  for (const int aa : {1, 3}) {
    Request request = world.request(16, Term::direct, 32);
    request.aa = aa;
    const Result result = render(request);
    double variance = 0, sum = 0;
    const int channel = result.image.channel("variance");
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        variance += static_cast<double>(result.image.at(x, y, channel)) / 256;
        sum += static_cast<double>(result.image.at(x, y, 0)) / 256;
      }
    EXPECT_NEAR(result.noiseRms, std::sqrt(variance) / sum, 1e-4 * result.noiseRms) << aa;
    EXPECT_EQ(result.image.metadata().at("noise_rms"), fmt::format("{}", result.noiseRms));
  }
}

/// The light comes through a slit that sees 1/2500 of it: the first samples find none.
TEST(ReferenceWork, BlackIsNotTakenForFinished) {
  World world = floorWorld();
  world.addRectangle({0, 1, 0}, {1, 0, 0}, {0, 0, -1}, 5);
  const int material = world.addMaterial(glm::vec3(0.5f), true);
  constexpr float kSlit = 0.0002f;
  for (const float side : {-1.f, 1.f})
    world.addQuad({side * (1 + 0.5f * kSlit), 0.5f, 0}, {2, 0, 0}, {0, 0, -4}, material);
  world.camera = scene::lookAt({0, 0.4f, 0.01f}, {0, 0, 0}, 0.1f);
  Request request = world.request(2, Term::visibility, 16);
  request.light = 0;
  const auto mean = [](const Image& image) {
    return (image.at(0, 0, 0) + image.at(1, 0, 0) + image.at(0, 1, 0) + image.at(1, 1, 0)) / 4;
  };
  ASSERT_EQ(mean(render(request).image), 0.f);
  request.spp = 1 << 20;
  request.noise = 0.3;
  const Result found = render(request);
  EXPECT_GT(found.spp, 16);
  EXPECT_LE(found.noiseRms, 0.3);
  EXPECT_NEAR(mean(found.image), 2 * kSlit, kSlit) << "a few samples of four pixels found the light";

  World dark = floorWorld();
  Request nothing = dark.request(2, Term::direct, 1 << 14);
  nothing.noise = 0.5;
  EXPECT_EQ(render(nothing).spp, 4096);
  nothing.term = Term::caustic;  // of no specular object
  EXPECT_EQ(render(nothing).spp, 16);
}

TEST(ReferenceWork, SameBitsForASeedWhateverTheThreads) {
  const World world = busyWorld();
  Request request = world.request(24, Term::final, 16);
  request.threads = 1;
  const Image one = render(request).image;
  request.threads = 2;
  EXPECT_TRUE(sameBits(one, render(request).image));
  request.seed = 1;
  EXPECT_FALSE(sameBits(one, render(request).image));
}

TEST(ReferenceWork, ResumedEqualsUninterrupted) {
  const Folder folder;
  const World world = busyWorld();
  Request request = world.request(24, Term::direct, 100);
  const Result whole = render(request);
  request.checkpoint = folder.path() / "work.partial";
  request.progress = [](const Progress& p) { return p.spp < 48; };
  EXPECT_THROW(render(request), Error);
  ASSERT_TRUE(std::filesystem::exists(request.checkpoint));
  int first = 0;
  request.progress = [&](const Progress& p) {
    if (first == 0) first = p.spp;
    return true;
  };
  const Result resumed = render(request);
  EXPECT_GT(first, 48);  // went on from the checkpoint
  EXPECT_TRUE(sameBits(whole.image, resumed.image));
  EXPECT_EQ(whole.noiseRms, resumed.noiseRms);
  EXPECT_FALSE(std::filesystem::exists(request.checkpoint));
}

/// Lights that stand for the environment are no part of a picture of all light: its work is taken up where
/// they came or went meanwhile, and noise is tested at the same counts of samples.
TEST(ReferenceWork, ResumedWithoutTheEnvironmentsLightsItMeetsItsNoise) {
  const Folder folder;
  const World world = busyWorld();
  World decomposed = world;
  for (int i = 0; i < 8000; ++i) {
    glsl::Light& light = decomposed.addLight(glsl::light_directional, {0, 1, 0}, {0, -1, 0}, glm::vec3(1));
    light.flags = glsl::light_flag_environment;
    light.axis_u = {1, 0, 0};
    light.axis_v = {0, 0, -1};
    light.length_u = light.length_v = 0.1f;
    light.solid_angle = 0.01f;
  }
  const double noise = render(world.request(16, Term::direct, 32)).noiseRms / 4;
  const auto asked = [noise](const World& of) {
    Request request = of.request(16, Term::direct, 1 << 14);
    request.noise = noise;
    return request;
  };
  const Result whole = render(asked(world));
  ASSERT_GT(whole.spp, 32) << "else nothing is left to resume";
  ASSERT_LT(whole.spp, 1 << 14);

  Request first = asked(decomposed);
  first.checkpoint = folder.path() / "work.partial";
  first.progress = [](const Progress& p) { return p.spp < 22; };
  EXPECT_THROW(render(first), Error);
  ASSERT_TRUE(std::filesystem::exists(first.checkpoint));
  Request second = asked(world);
  second.checkpoint = first.checkpoint;
  const Result resumed = render(second);
  EXPECT_EQ(resumed.spp, whole.spp);
  EXPECT_TRUE(sameBits(resumed.image, whole.image));
}

/// In less time than one pass over the picture takes on the same machine under the same load.
TEST(ReferenceWork, StopsWithinAPass) {
  using Clock = std::chrono::steady_clock;
  const World world = busyWorld();
  Request request = world.request(1024, Term::indirect, 1 << 16);
  request.bounces = 64;
  request.threads = 1;
  int passes = 0;
  request.progress = [&](const Progress&) { return ++passes, false; };
  Clock::time_point start = Clock::now();
  EXPECT_THROW(render(request), Error);
  const Clock::duration whole = Clock::now() - start;
  EXPECT_EQ(passes, 1);

  std::stop_source stop;
  request.stop = stop.get_token();
  start = Clock::now();
  std::jthread stopper([&] {
    std::this_thread::sleep_for(whole / 4);
    stop.request_stop();
  });
  EXPECT_THROW(render(request), Error);
  EXPECT_LT(Clock::now() - start, whole * 3 / 4);
  EXPECT_EQ(passes, 1);
}

TEST(ReferenceWork, ABrokenOrForeignCheckpointIsIgnored) {
  const Folder folder;
  const World world = busyWorld();
  Request request = world.request(16, Term::direct, 32);
  const Image whole = render(request).image;
  request.checkpoint = folder.path() / "work.partial";
  request.progress = [](const Progress&) { return false; };
  request.seed = 9;
  EXPECT_THROW(render(request), Error);
  request.seed = 0;
  request.progress = nullptr;
  EXPECT_TRUE(sameBits(whole, render(request).image));
  std::ofstream(request.checkpoint) << "nonsense";
  EXPECT_TRUE(sameBits(whole, render(request).image));
}

/// A bit of the number of samples, and one of the sums: with either the picture would be another.
TEST(ReferenceWork, ACheckpointWithAFlippedBitIsIgnored) {
  const Folder folder;
  const World world = busyWorld();
  Request request = world.request(16, Term::direct, 32);
  const Image whole = render(request).image;
  request.checkpoint = folder.path() / "work.partial";
  for (const std::streamoff at : {48, 200}) {
    request.progress = [](const Progress&) { return false; };
    EXPECT_THROW(render(request), Error);
    std::fstream file(request.checkpoint, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(at);
    const int byte = file.get();
    file.seekp(at);
    file.put(static_cast<char>(byte ^ 1));
    file.close();
    ASSERT_TRUE(file);
    request.progress = nullptr;
    EXPECT_TRUE(sameBits(whole, render(request).image)) << at;
  }
}

}  // namespace
}  // namespace limn::reference
