// Tone curves, exposure and samples of a pixel on the command line.
#include <nlohmann/json.hpp>

#include "glsl/numeric/tone_curve.glsl"
#include "tests/cli/channels.h"
#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

using testing::HasSubstr;

class FinishedPictures : public testing::Test {
 protected:
  Outcome render(std::vector<std::string> options, const std::string& out) {
    options.insert(options.begin(), {"render", kCornellBox, "--size", "24x16"});
    options.insert(options.end(), {"--out", (folder_ / out).string()});
    return limn(options);
  }
  TemporaryFolder folder_;
};

/// The .png is what the .exr's linear values become, with the exposure that the program says.
TEST_F(FinishedPictures, PngsHoldTheCurveOfLinearValues) {
  ASSERT_EQ(render({"--tonemap", "agx"}, "linear.exr").status, 0);
  const Channels linear(folder_ / "linear.exr");
  const std::pair<const char*, std::uint32_t> curves[] = {
      {"none", glsl::tone_curve_none}, {"neutral", glsl::tone_curve_neutral}, {"agx", glsl::tone_curve_agx}};
  for (const auto& [name, curve] : curves) {
    const Outcome outcome = render({"--tonemap", name, "--exposure", "auto"}, "shown.png");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const size_t said = outcome.err.find("exposure ");
    ASSERT_NE(said, std::string::npos) << outcome.err;
    const float ev = std::stof(outcome.err.substr(said + 9));
    const Channels shown(folder_ / "shown.png");
    ASSERT_EQ(shown.size(), linear.size());
    for (size_t i = 0; i < shown.size(); ++i) {
      const glm::vec3 codes =
          glsl::tone_map(glm::vec3(linear.at(i, "R"), linear.at(i, "G"), linear.at(i, "B")), ev, curve);
      EXPECT_NEAR(shown.at(i, "R"), codes.x, 1.5 / 255) << name << ' ' << i;
      EXPECT_NEAR(shown.at(i, "B"), codes.z, 1.5 / 255) << name << ' ' << i;
    }
  }
}

TEST_F(FinishedPictures, RefuseWhatTheyDoNotKnow) {
  expectRefused(render({"--tonemap", "agv"}, "a.png"), 2, {"unknown tone curve 'agv' (did you mean agx?)"});
  expectRefused(render({"--exposure", "bright"}, "a.png"), 2, {"--exposure", "-60 to 60, or auto"});
  expectRefused(render({"--exposure", "61"}, "a.png"), 2, {"--exposure"});
  expectRefused(render({"--aa", "17"}, "a.png"), 2, {"--aa"});
  expectRefused(limn({"explain-cost", kCornellBox, "--aa", "2"}), 2, {"--aa 2: explain-cost"});
  expectRefused(limn({"passes", kCornellBox, "--aa", "2", "--out", "passes"}), 2, {"--aa 2: passes"});
}

TEST_F(FinishedPictures, StatsCountTheFramesOfAPicture) {
  const std::string stats = (folder_ / "stats.json").string();
  const Outcome outcome = render({"--aa", "3", "--repeat", "1", "--stats", stats}, "a.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("a picture takes 9 frames"));
  EXPECT_EQ(nlohmann::json::parse(contents(stats)).at("frames_per_picture"), 9);
}

/// What is not averaged is that of the same sample.
TEST_F(FinishedPictures, ReferencesHaveTheSameSamples) {
  const std::vector<std::string> dark{"--environment-scale", "0", "--default-lights", "off", "--aa", "4"};
  ASSERT_EQ(render(dark, "picture.exr").status, 0);
  std::vector<std::string> command{"reference", kCornellBox, "--size", "24x16",
                                   "--term",    "final",     "--spp",  "1"};
  command.insert(command.end(), dark.begin(), dark.end());
  command.insert(command.end(), {"--out", (folder_ / "truth.exr").string()});
  ASSERT_EQ(limn(command).status, 0);
  const Channels picture(folder_ / "picture.exr"), truth(folder_ / "truth.exr");
  ASSERT_EQ(picture.size(), truth.size());
  int differing = 0;  // where an edge goes through the sample
  for (size_t i = 0; i < truth.size(); ++i) differing += picture.at(i, "id") != truth.at(i, "id");
  EXPECT_LE(differing, 6) << "of " << truth.size();
}

}  // namespace
}  // namespace limn::test
