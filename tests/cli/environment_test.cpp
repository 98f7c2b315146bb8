// limn environment: the lights that stand for an environment.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

class EnvironmentCommand : public testing::Test {
 protected:
  /// A small .hdr file: grey, with one bright pixel.
  std::string map() {
    const std::filesystem::path file = folder_ / "sky.hdr";
    std::ofstream out(file, std::ios::binary);
    out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n";
    for (int i = 0; i < 16 * 32; ++i) out << "\x80\x80\x80" << (i == 100 ? '\x90' : '\x81');
    return file.string();
  }
  TemporaryFolder folder_;
};

TEST_F(EnvironmentCommand, ListsLightsThatHoldTheEnergyOfTheMap) {
  const Outcome outcome = limn({"environment", map(), "--lights", "0.02", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto parsed = nlohmann::json::parse(outcome.out);
  ASSERT_GE(parsed["lights"].size(), 7u);
  double share = 0, irradiance = 0;
  for (const auto& light : parsed["lights"]) {
    share += light["share"].get<double>();
    irradiance += light["irradiance"][1].get<double>();
  }
  EXPECT_NEAR(share, 1, 1e-6);
  EXPECT_GT(irradiance, 4 * 3.14159);
  EXPECT_EQ(parsed["lights"][0]["name"], "env#0");
}

TEST_F(EnvironmentCommand, WritesTheOverlayAndRefusesWhatMakesNoSense) {
  const std::filesystem::path overlay = folder_ / "lights.png";
  ASSERT_EQ(limn({"environment", map(), "--overlay", overlay.string(), "--width", "64"}).status, 0);
  EXPECT_GT(std::filesystem::file_size(overlay), 100u);
  for (const char* ofOverlays : {"--width", "--exposure"})
    expectRefused(limn({"environment", map(), ofOverlays, "16"}), 2, {ofOverlays, "--overlay"});
  expectRefused(limn({"environment", map(), "--lights", "2"}), 2, {"--lights", "2"});
  expectRefused(limn({"environment", map(), "--shape", "discs"}), 2, {"discs", "squares", "rectangles"});
  expectRefused(limn({"environment", map(), "--overlay", "lights.jpg"}), 2, {"lights.jpg", ".png"});
  expectRefused(limn({"environment", map(), "--lights", "0.5", "--resolution", "256"}), 2, {"0.5", "1024"});
  expectRefused(limn({"render", kCornellBox, "--environment-lights", "0.02", "--out", "a.png"}), 2,
                {"--environment-lights", "--environment"});
  expectRefused(limn({"environment", (folder_ / "none.hdr").string()}), 1, {"none.hdr"});
  expectRefused(limn({"environment", "ski"}), 1, {"'ski'", ".exr"});
  EXPECT_EQ(limn({"environment", "sky", "--lights", "0.02"}).status, 0) << "limn's own, by its name";
}

TEST_F(EnvironmentCommand, LightsOfTheEnvironmentShadowAndAreReferredToByName) {
  const std::string environment = map();
  const std::vector<std::string> scene{kCornellBox, "--environment", environment, "--environment-lights",
                                       "0.05",      "--size",        "32x24",     "--light",
                                       "env#1",     "--out"};
  const auto with = [&](std::vector<std::string> command, const char* out, std::vector<std::string> more) {
    command.insert(command.end(), scene.begin(), scene.end());
    command.push_back((folder_ / out).string());
    command.insert(command.end(), more.begin(), more.end());
    return limn(command);
  };
  const Outcome rendered = with({"render"}, "v.exr", {"--technique", "pcss", "--output-term", "visibility"});
  EXPECT_EQ(rendered.status, 0) << rendered.err;
  const Outcome traced = with({"reference"}, "r.exr", {"--term", "visibility", "--spp", "16"});
  EXPECT_EQ(traced.status, 0) << traced.err;
}

}  // namespace
}  // namespace limn::test
