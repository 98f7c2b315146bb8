// How the reference does its work: noise estimate, determinism, resuming, stopping.
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

/// Within a pass over the picture, which here would take minutes.
TEST(ReferenceWork, StopsWithinAPass) {
  using Clock = std::chrono::steady_clock;
  const World world = busyWorld();
  Request request = world.request(2048, Term::indirect, 1 << 16);
  request.bounces = 64;
  std::stop_source stop;
  request.stop = stop.get_token();
  int passes = 0;
  request.progress = [&](const Progress&) { return ++passes, true; };
  Clock::time_point asked;
  std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    asked = Clock::now();
    stop.request_stop();
  });
  EXPECT_THROW(render(request), Error);
  const Clock::time_point ended = Clock::now();
  stopper.join();
  EXPECT_EQ(passes, 0);
  EXPECT_LT(std::chrono::duration<double>(ended - asked).count(), 1.0);
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

}  // namespace
}  // namespace limn::reference
