// Requests for references: what is refused, what each term allows, a scene that holds nothing.
#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "core/reference/reference.h"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;

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
  const auto tooLarge = [](Request& r) {
    r.width = 32768;
    r.height = 2400;
  };
  EXPECT_NE(message(tooLarge).find("size 32768x2400 with aa 1 has 1101004800 values; at most 1073741824"),
            std::string::npos)
      << "before any ray is traced";
  EXPECT_NE(message([](Request& r) { r.spp = 0; }).find("spp 0"), std::string::npos);
  for (const double noise : {-1.0, 1.5})
    EXPECT_NE(message([&](Request& r) { r.noise = noise; }).find("is not in 0 .. 1"), std::string::npos);
  EXPECT_EQ(message([](Request& r) { r.noise = 1; }), "") << "as suites and --noise accept";
  EXPECT_NE(message([](Request& r) { r.aa = 99; }).find("aa 99"), std::string::npos);
  EXPECT_NE(message([](Request& r) { r.light = 3; }).find("light 3"), std::string::npos);
  EXPECT_NE(message([](Request& r) { r.term = Term::visibility; }).find("visibility needs one light"),
            std::string::npos);
  EXPECT_NE(
      message([](Request& r) { r.term = Term::relief; }).find("relief needs one light; -1 is not in 0 .. 1"),
      std::string::npos);
  EXPECT_NE(message([](Request& r) { r.reliefPaths = ReliefPaths::others; })
                .find("relief paths 'others' with the term direct; only final, indirect, subsurface and "
                      "specular have"),
            std::string::npos);
  EXPECT_NE(message([](Request& r) {
              r.subsurface = SubsurfaceModel::walk;
            }).find("subsurface 'walk' with the term direct; only final, subsurface and specular hold"),
            std::string::npos);
  EXPECT_NE(message([](Request& r) { r.term = Term::environment; }).find("no picture shows"),
            std::string::npos);
}

TEST(ReferenceRequest, TermsHaveTheirBouncesAndInterfaces) {
  struct Expected {
    Term term;
    bool bounces, none, some, all;
    int defaultBounces, defaultInterfaces;
  };
  constexpr Expected terms[] = {
      {Term::final, true, true, true, true, 0, 0},        {Term::visibility, false, true, false, false, 0, 0},
      {Term::relief, false, true, false, false, 0, 0},    {Term::direct, false, true, false, false, 0, 0},
      {Term::indirect, true, true, false, false, 1, 0},   {Term::caustic, false, true, false, true, 0, 0},
      {Term::subsurface, true, true, false, false, 0, 0}, {Term::media, false, true, false, true, 0, 0},
      {Term::specular, true, false, true, true, 0, 2}};
  for (const Expected& e : terms) {
    EXPECT_EQ(hasBounces(e.term), e.bounces) << name(e.term);
    EXPECT_EQ(acceptsInterfaces(e.term, 0), e.none) << name(e.term);
    for (const int some : {1, 2, kMaxInterfaces})
      EXPECT_EQ(acceptsInterfaces(e.term, some), e.some) << name(e.term);
    EXPECT_EQ(acceptsInterfaces(e.term, kAllInterfaces), e.all) << name(e.term);
    for (const int never : {-2, kMaxInterfaces + 1})
      EXPECT_FALSE(acceptsInterfaces(e.term, never)) << name(e.term);
    EXPECT_EQ(defaultBounces(e.term), e.defaultBounces) << name(e.term);
    EXPECT_EQ(defaultInterfaces(e.term), e.defaultInterfaces) << name(e.term);
  }
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

}  // namespace
}  // namespace limn::reference
