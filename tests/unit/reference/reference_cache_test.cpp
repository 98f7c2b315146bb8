// What the cache of references keeps, and what tells two references apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/reference/reference.h"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;

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

/// Times of one machine must not stand beside those of another, as where a folder of results went to one.
TEST(ReferenceWork, OfAPictureOfAnotherMachineTheCacheKnowsNoTime) {
  const Folder folder;
  const World world = busyWorld();
  const Request request = world.request(16, Term::direct, 4);
  const auto at = [&](const std::string& machine) { return Cache(folder.path(), {}, machine); };
  const Result first = at("a").render(request);
  EXPECT_GT(first.seconds, 0);
  EXPECT_EQ(at("a").render(request).seconds, first.seconds);
  EXPECT_EQ(at("").render(request).seconds, first.seconds) << "not compared";
  const Result elsewhere = at("b").render(request);
  EXPECT_TRUE(sameBits(elsewhere.image, first.image)) << "not rendered again";
  EXPECT_EQ(elsewhere.seconds, std::nullopt);
}

TEST(ReferenceWork, TheTimeIsThatOfAllCores) {
  const World world = busyWorld();
  Request request = world.request(16, Term::direct, 4);
  EXPECT_GT(render(request).seconds, 0);
  request.threads = 1;
  EXPECT_EQ(render(request).seconds, std::nullopt);
}

/// The program writes it down as it is, whether it was found or rendered.
TEST(ReferenceWork, APictureOfTheCacheSaysWhatAFreshOneDoes) {
  const Folder folder;
  const World world = busyWorld();
  const Request request = world.request(16, Term::direct, 4);
  Cache cache(folder.path(), {}, "a");
  const Result fresh = cache.render(request), found = cache.render(request);
  EXPECT_EQ(found.image.metadata(), fresh.image.metadata());
  EXPECT_EQ(found.seconds, fresh.seconds);
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
  EXPECT_NE(plain, hash([](World& w) { w.pose.lights[0].emission.x += 1; }));
  EXPECT_NE(plain, hash([](World& w) { w.pose.instances[1].objectToWorld[3].x += 1; }));
  EXPECT_NE(plain, hash([](World& w) { w.pose.instances[1].mirroredSkin = true; }));
  EXPECT_NE(plain, hash([](World& w) { w.camera.yfov += 0.1f; }));
  Request request = world.request(16, Term::direct, 16);
  request.seed = 1;
  EXPECT_NE(plain, contentHash(request));
  request.seed = 0;
  EXPECT_EQ(plain, contentHash(request));
  request.unshadowed = true;
  EXPECT_NE(plain, contentHash(request));
  Request indirect = world.request(16, Term::indirect, 16);
  indirect.bounces = 1;
  std::vector<std::string> hashes{contentHash(indirect)};
  for (const ReliefPaths paths : {ReliefPaths::both, ReliefPaths::relief, ReliefPaths::others}) {
    indirect.reliefPaths = paths;
    hashes.push_back(contentHash(indirect));
  }
  EXPECT_EQ(hashes[0], hashes[1]) << "the default";
  EXPECT_NE(hashes[1], hashes[2]);
  EXPECT_NE(hashes[1], hashes[3]);
  EXPECT_NE(hashes[2], hashes[3]);
  const auto following = [&](SubsurfaceModel model) {
    Request final = world.request(16, Term::final, 16);
    final.subsurface = model;
    return contentHash(final);
  };
  EXPECT_EQ(following(SubsurfaceModel::bssrdf), contentHash(world.request(16, Term::final, 16)));
  EXPECT_NE(following(SubsurfaceModel::bssrdf), following(SubsurfaceModel::walk));
  EXPECT_NE(following(SubsurfaceModel::bssrdf), following(SubsurfaceModel::local));
  EXPECT_NE(following(SubsurfaceModel::walk), following(SubsurfaceModel::local));
  EXPECT_NE(plain, contentHash(world.request(16, Term::final, 16)));
  EXPECT_NE(plain, contentHash(world.request(16, Term::direct, 18)));
  EXPECT_NE(plain, contentHash(world.request(17, Term::direct, 16)));
}

TEST(ReferenceWork, HeightMapsAreHashedWhereThereAreAny) {
  World world;
  world.addQuad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, world.addMaterial(glm::vec3(0.5f)));
  world.addLight(glsl::light_directional, {0, 0, 0}, {0, -1, 0}, glm::vec3(1));
  const auto hash = [&] { return contentHash(world.request(16, Term::direct, 16)); };
  // As before there were height maps: references that were rendered then are still found.
  EXPECT_EQ(hash(), "a1c7000ef140084a562394713b246778");
  std::vector<std::string> hashes{hash()};
  const auto add = [&](const relief::HeightField& field) {
    world.scene.heights = {field};
    hashes.push_back(hash());
  };
  world.scene.materials[0].height = 0;
  const std::vector<float> values{0, 1, 2, 3};
  add({{2, 2}, values, glm::dvec2(1)});
  add({{4, 1}, values, glm::dvec2(1)});
  add({{2, 2}, {0, 1, 2, 4}, glm::dvec2(1)});
  add({{2, 2}, values, glm::dvec2(1), 2});
  add({{2, 2}, values, glm::dvec2(1), 1, 0.5});
  add({{2, 2}, values, glm::dvec2(1, 2)});
  add({{2, 2}, values, glm::dvec2(1), 1, 0, relief::Wrap::clamped});
  world.scene.heights.push_back(world.scene.heights[0]);
  world.scene.materials[0].height = 1;
  hashes.push_back(hash());
  std::ranges::sort(hashes);
  EXPECT_EQ(std::ranges::adjacent_find(hashes), hashes.end());
}

/// The names are those of earlier results: of indices up to 3, narrow spots too dim, copies without inverse.
TEST(ReferenceWork, EarlierResultsThatWereWrongAreNotFound) {
  World world;
  world.addQuad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, world.addMaterial(glm::vec3(0.5f)));
  world.addLight(glsl::light_directional, {0, 0, 0}, {0, -1, 0}, glm::vec3(1));
  const auto hash = [&](auto change) {
    World changed = world;
    change(changed);
    return contentHash(changed.request(16, Term::direct, 16));
  };
  EXPECT_EQ(hash([](World&) {}), "a1c7000ef140084a562394713b246778") << "others are found";
  EXPECT_NE(hash([](World& w) { w.scene.materials[0].ior = 1000; }), "7499c6c791bad011b929bdd9f275a04e");
  EXPECT_NE(hash([](World& w) {
              glsl::Light& light = w.pose.lights[0];
              light.type = glsl::light_spot;
              light.flags = glsl::light_flag_cone;
              light.cos_outer = 0.99996f;
            }),
            "28146d1b03afaa22839a0402c816c417");
  EXPECT_NE(hash([](World& w) { w.pose.instances[0].objectToWorld[1][1] = 0; }),
            "dd2a3c4627fdda4e92d9eccefdfef19f");
}

}  // namespace
}  // namespace limn::reference
