// How the reference does its work: noise estimate, determinism, resuming, cache, geometry variants, bad
// requests.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stop_token>
#include <thread>

#include "core/base/error.h"
#include "core/reference/environment.h"
#include "core/reference/reference.h"
#include "core/reference/sampler.h"
#include "core/reference/texture.h"
#include "reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;

/// Two lights, a box-like blocker, an environment: a bit of everything.
World busyWorld() {
  World world = floorWorld();
  world.addRectangle({0.2f, 1.5f, -0.1f}, {1, 0, 0}, {0, 0, -0.6f}, 7);
  world.addLight(glsl::light_point, {-1, 1, 0.5f}, {0, -1, 0}, glm::vec3(1, 0.5f, 0.2f));
  world.addInstance(
      world.addMesh(World::sphere(24, world.addMaterial({0.8f, 0.2f, 0.1f}))),
      glm::translate(glm::mat4(1), glm::vec3(0.3f, 0.4f, 0)) * glm::scale(glm::mat4(1), glm::vec3(0.4f)));
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, glm::vec3(0.3f));
  world.camera = scene::lookAt({0, 2, 3}, {0, 0.2f, 0}, 0.8f);
  return world;
}

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
  EXPECT_GT(first, 48);  // did not start anew
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

TEST(ReferenceWork, CacheReturnsWhatWasRendered) {
  const Folder folder;
  Cache cache(folder.path() / "cache");
  World world = busyWorld();
  int passes = 0;
  const auto ask = [&] {
    Request request = world.request(16, Term::direct, 16);
    request.progress = [&](const Progress&) { return ++passes, true; };
    return cache.render(request);
  };
  const Result first = ask();
  EXPECT_GT(passes, 0);
  passes = 0;
  const Result second = ask();
  EXPECT_EQ(passes, 0);
  EXPECT_TRUE(sameBits(first.image, second.image));
  EXPECT_EQ(first.noiseRms, second.noiseRms);
  EXPECT_EQ(first.spp, second.spp);
  EXPECT_GT(first.seconds, 0);
  EXPECT_EQ(first.seconds, second.seconds);
  const auto file = cache.pathOf(contentHash(world.request(16, Term::direct, 16)));
  ASSERT_TRUE(std::filesystem::exists(file));
  std::ofstream(file) << "broken";
  ask();
  EXPECT_GT(passes, 0);
  EXPECT_TRUE(cache.get(contentHash(world.request(16, Term::direct, 16))).has_value());
}

TEST(ReferenceWork, ACacheThatCannotBeWrittenKeepsReferencesInMemoryAndSaysSoOnce) {
  const Folder folder;
  const auto blocked = folder.path() / "file";
  std::ofstream(blocked) << "no folder";
  std::vector<std::string> warnings;
  Cache cache(blocked / "cache", [&](const std::string& warning) { warnings.push_back(warning); });
  const World world = busyWorld();
  int passes = 0;
  const auto ask = [&](int spp) {
    Request request = world.request(16, Term::direct, spp);
    request.progress = [&](const Progress&) { return ++passes, true; };
    return cache.render(request);
  };
  const Result first = ask(16);
  EXPECT_GT(passes, 0);
  passes = 0;
  EXPECT_TRUE(sameBits(first.image, ask(16).image));
  EXPECT_EQ(passes, 0) << "not rendered again";
  ask(8);
  EXPECT_GT(passes, 0);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("kept in memory"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find(blocked.string()), std::string::npos) << warnings[0];
}

TEST(ReferenceWork, ContentHashSeesEverythingThatMatters) {
  World world = busyWorld();
  const auto hash = [&](auto change) {
    World changed = world;
    change(changed);
    return contentHash(changed.request(16, Term::direct, 16));
  };
  const std::string plain = hash([](World&) {});
  EXPECT_EQ(plain.size(), 32u);
  EXPECT_EQ(plain, hash([](World&) {}));
  EXPECT_NE(plain, hash([](World& w) { w.scene.meshes[0].primitives[0].positions[0].x += 1e-6f; }));
  EXPECT_NE(plain, hash([](World& w) { w.scene.materials[0].roughness = 0.5f; }));
  EXPECT_NE(plain, hash([](World& w) { w.scene.environment.texels[3].r = 7; }));
  EXPECT_NE(plain, hash([](World& w) { w.pose.lights[0].emission.r += 1; }));
  EXPECT_NE(plain, hash([](World& w) { w.pose.instances[1].objectToWorld[3].x += 1; }));
  EXPECT_NE(plain, hash([](World& w) { w.camera.yfov += 0.1f; }));
  Request request = world.request(16, Term::direct, 16);
  request.seed = 1;
  EXPECT_NE(plain, contentHash(request));
  EXPECT_NE(plain, contentHash(world.request(16, Term::final, 16)));
  EXPECT_NE(plain, contentHash(world.request(16, Term::direct, 18)));
  EXPECT_NE(plain, contentHash(world.request(17, Term::direct, 16)));
}

TEST(ReferenceGeometry, ScaleDoesNotMatter) {
  const World world = busyWorld();
  const Image image = render(world.request(24, Term::direct, 64)).image;
  for (const float factor : {1e-4f, 1e4f}) {
    World scaled = world;
    scaled.rescale(factor);
    const Image other = render(scaled.request(24, Term::direct, 64)).image;
    double squares = 0, sum = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        squares +=
            std::pow(static_cast<double>(image.at(x, y, 0)) - static_cast<double>(other.at(x, y, 0)), 2);
        sum += static_cast<double>(image.at(x, y, 0));
      }
    EXPECT_LT(std::sqrt(squares * 24 * 24) / sum, 1e-3) << factor;
  }
}

TEST(ReferenceGeometry, FarFromTheOriginPlanesDoNotShadowThemselves) {
  World world = floorWorld();
  world.addRectangle({0.5f, 1.5f, 0}, {1, 0, 0}, {0, 0, -1}, 4);
  const glm::vec3 away(1000, -2000, 500);
  world.pose.instances[0].objectToWorld = glm::translate(glm::mat4(1), away);
  world.pose.lights[0].position += glm::vec4(away, 0);
  world.pose.bounds.low += away;
  world.pose.bounds.high += away;
  world.camera = scene::lookAt(away + glm::vec3(0, 1, 2.5f), away, 0.8f);
  Request request = world.request(32, Term::visibility, 16);
  request.light = 0;
  const Image image = render(request).image;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) EXPECT_EQ(image.at(x, y, image.channel("V")), 1.f) << x << " " << y;
}

TEST(ReferenceGeometry, InstancesEqualCopies) {
  // The same spheres: one mesh drawn three times (mirrored once), or three meshes.
  const glm::mat4 places[3] = {
      glm::translate(glm::mat4(1), glm::vec3(-0.8f, 0.5f, 0)) * glm::scale(glm::mat4(1), glm::vec3(0.3f)),
      glm::translate(glm::mat4(1), glm::vec3(0.1f, 0.3f, 0.2f)) *
          glm::scale(glm::mat4(1), glm::vec3(0.2f, 0.3f, 0.2f)),
      glm::translate(glm::mat4(1), glm::vec3(0.8f, 0.4f, -0.2f)) *
          glm::scale(glm::mat4(1), glm::vec3(-0.3f, 0.3f, 0.3f))};
  World shared = floorWorld();
  shared.addRectangle({0.2f, 1.5f, -0.1f}, {1, 0, 0}, {0, 0, -0.6f}, 7);
  shared.camera = scene::lookAt({0, 2, 3}, {0, 0.2f, 0}, 0.8f);
  World copied = shared;
  const int mesh = shared.addMesh(World::sphere(32, shared.addMaterial(glm::vec3(0.6f))));
  const int material = copied.addMaterial(glm::vec3(0.6f));
  for (const glm::mat4& place : places) {
    shared.addInstance(mesh, place);
    copied.addInstance(copied.addMesh(World::sphere(32, material)), place);
  }
  const Image a = render(shared.request(48, Term::direct, 64)).image;
  const Image b = render(copied.request(48, Term::direct, 64)).image;
  double difference = 0, sum = 0;
  int ids = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      difference += std::abs(static_cast<double>(a.at(x, y, 0)) - static_cast<double>(b.at(x, y, 0)));
      sum += static_cast<double>(a.at(x, y, 0));
      ids += a.at(x, y, a.channel("id")) != b.at(x, y, b.channel("id"));
    }
  EXPECT_LT(difference / sum, 1e-3);
  EXPECT_LE(ids, 2);
  EXPECT_GT(sum, 0);
}

TEST(ReferenceGeometry, SkinnedAndMorphedPrimitivesAreTracedDeformed) {
  World world = floorWorld();
  auto& primitive = world.scene.meshes[0].primitives[0];
  primitive.joints.assign(4, glm::u16vec4(0));
  primitive.weights.assign(4, glm::vec4(1, 0, 0, 0));
  primitive.morphTargets.emplace_back().positions.assign(4, glm::vec3(0, 0.5f, 0));
  scene::Deformation state;
  state.mesh = 0;
  state.joints = {glm::translate(glm::mat4(1), glm::vec3(0, 0.25f, 0))};
  state.morphWeights = {0.5f};
  world.pose.deformed.push_back(state);
  world.pose.instances[0].deformed = 0;
  world.addLight(glsl::light_point, {0, 1, 0}, {0, -1, 0}, glm::vec3(1));
  const Image image = render(world.request(9, Term::direct, 2)).image;
  EXPECT_NEAR(positionOf(world, image, 4, 4).y, 0.5, 1e-5);
  EXPECT_NEAR(image.at(4, 4, 0), 0.5f * glsl::inverse_pi / 0.25f, 1e-3f);  // 0.5 m below the light
}

TEST(ReferenceGeometry, FeaturesAreThoseOfTheSurface) {
  const World world = busyWorld();
  const Image image = render(world.request(33, Term::direct, 2)).image;
  const auto value = [&](const char* channel, int x, int y) {
    return image.at(x, y, image.channel(channel));
  };
  EXPECT_EQ(value("coverage", 16, 30), 1.f);
  EXPECT_EQ(value("id", 16, 30), 0.f);
  EXPECT_EQ(value("N.Y", 16, 30), 1.f);
  EXPECT_EQ(value("albedo.R", 16, 30), 0.5f);
  EXPECT_EQ(value("coverage", 0, 0), 0.f);
  EXPECT_NEAR(positionOf(world, image, 16, 30).y, 0, 1e-5);
}

TEST(ReferenceGeometry, SupersamplingAverages) {
  const World world = busyWorld();
  Request request = world.request(24, Term::direct, 16);
  const Image fine = render(request).image;
  request.width = request.height = 12;
  request.aa = 2;
  const Image coarse = render(request).image;
  ASSERT_EQ(coarse.width(), 12);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 12; ++x) {
      const float mean = 0.25f * (fine.at(2 * x, 2 * y, 0) + fine.at(2 * x + 1, 2 * y, 0) +
                                  fine.at(2 * x, 2 * y + 1, 0) + fine.at(2 * x + 1, 2 * y + 1, 0));
      EXPECT_NEAR(coarse.at(x, y, 0), mean, 1e-5f * (1 + mean));
    }
}

TEST(ReferenceEnvironment, DensityIntegratesToOneAndFollowsTheRadiance) {
  scene::Environment map;
  map.width = 7;
  map.height = 5;
  for (int i = 0; i < 35; ++i) map.texels.emplace_back(static_cast<float>((i * 37) % 11));
  map.rotation = 0.4f;
  const EnvironmentLight light(map);
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
    estimate += static_cast<double>(light.radiance(d).r / light.pdf(d)) / count;
  }
  EXPECT_NEAR(estimate / energy, 1, 2e-3);
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

TEST(ReferenceRequest, NonsenseIsRefusedByName) {
  const World world = busyWorld();
  const auto message = [&](auto change) -> std::string {
    Request request = world.request(16, Term::direct, 16);
    change(request);
    try {
      render(request);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message([](Request& r) { r.width = 0; }).find("size 0x16"), std::string::npos);
  EXPECT_NE(message([](Request& r) { r.spp = 0; }).find("spp 0"), std::string::npos);
  EXPECT_NE(message([](Request& r) { r.noise = -1; }).find("noise -1"), std::string::npos);
  EXPECT_NE(message([](Request& r) { r.aa = 99; }).find("aa 99"), std::string::npos);
  EXPECT_NE(message([](Request& r) { r.light = 3; }).find("light 3"), std::string::npos);
  EXPECT_NE(message([](Request& r) { r.term = Term::visibility; }).find("visibility needs one light"),
            std::string::npos);
  EXPECT_THROW(termFromName("indirekt"), UsageError);
  EXPECT_EQ(termFromName("visibility"), Term::visibility);
}

TEST(ReferenceRequest, EmptySceneIsBackground) {
  World world;
  world.camera = scene::lookAt({0, 0, 1}, {0, 0, 0}, 0.8f);
  const Result result = render(world.request(4, Term::final, 4));
  const size_t channels = result.image.channels().size(),
               id = static_cast<size_t>(result.image.channel("id"));
  for (size_t i = 0; i < result.image.data().size(); ++i)
    EXPECT_EQ(result.image.data()[i], i % channels == id ? -1.f : 0.f)
        << "no instance is seen, so its id is -1";
  EXPECT_EQ(result.noiseRms, 0);
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
