// The search for settings from outside.
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

class TuneCommand : public testing::Test {
 protected:
  std::vector<std::string> command(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {
        "tune",    "cornell_box", "--size", "64x48",         "--steps",
        "1",       "--spp",       "4",      "--frames",      "2",
        "--turns", "2",           "--out",  folder_ / "out", "--max-masked-share",
        "0.2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  Outcome tune(std::vector<std::string> more) const { return limn(command(std::move(more))); }
  /// Changes every line of the results in place.
  template <class Change>
  void changeRows(Change change) const {
    const fs::path file = folder_ / "out/results.jsonl";
    std::string rows;
    std::istringstream lines(contents(file));
    for (std::string line; std::getline(lines, line);) {
      auto row = nlohmann::ordered_json::parse(line);
      change(row);
      rows += row.dump() + "\n";
    }
    std::ofstream(file) << rows;
  }

  const TemporaryFolder folder_;
};

TEST_F(TuneCommand, AnswersWithACommandItsErrorAndItsTime) {
  const std::vector<std::string> question = {"--light",     "#0",    "--techniques", "hard_shadow_map,pcf",
                                             "--max-error", "rmse=1"};
  const Outcome first = tune(question);
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_THAT(first.out, testing::MatchesRegex(
                             "limn render cornell_box --technique [^\n]*--light '#0'[^\n]*--out tuned.png\n"
                             "    RMSE [^\n]*, [0-9.]+ ms a frame \\([0-9.]+ to [0-9.]+\\)\n"
                             "runner-up: limn render cornell_box --technique [^\n]*\n    RMSE [^\n]*\n"));
  EXPECT_TRUE(fs::exists(folder_ / "out/index.html"));
  // The suite asks for rows that are there.
  const Outcome bench = limn({"bench", folder_ / "out/tuned.toml", "--out", folder_ / "out"});
  EXPECT_EQ(bench.status, 0) << bench.err;
  EXPECT_THAT(bench.out, testing::HasSubstr("0 rows measured, 2 were there already, 0 failed"));
  // The same question is answered from the same rows.
  const std::string rows = contents(folder_ / "out/results.jsonl");
  EXPECT_EQ(tune(question).out, first.out);
  std::vector<std::string> asJson = question;
  asJson.push_back("--json");
  const auto parsed = nlohmann::json::parse(tune(asJson).out);
  const std::string command = parsed["answer"]["command"];
  EXPECT_EQ(first.out.substr(0, first.out.find('\n')), command);
  EXPECT_LE(parsed["answer"]["ms_interval"][0], parsed["answer"]["ms"]);
  EXPECT_LE(parsed["answer"]["error"], parsed["max_error"]);
  EXPECT_TRUE(parsed["runner_up"]["parameters"].is_object());
  EXPECT_EQ(contents(folder_ / "out/results.jsonl"), rows);
  // What was interrupted in the middle of a row goes on behind the one before.
  fs::resize_file(folder_ / "out/results.jsonl", rows.size() / 2);
  const std::string whole = rows.substr(0, rows.rfind('\n', rows.size() / 2) + 1);
  EXPECT_EQ(tune(question).status, 0);
  EXPECT_EQ(contents(folder_ / "out/results.jsonl").substr(0, whole.size()), whole);
}

TEST_F(TuneCommand, TheCommandNamesTheBackEndThatWasMeasured) {
  const Outcome outcome =
      tune({"--techniques", "hard_shadow_map", "--set", "hard_shadow_map.shadow_map_size=64", "--max-error",
            "rmse=1", "--backend", "osmesa"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr(" --backend osmesa --out tuned.png\n"));
}

/// The reference of a whole picture has no bounces unless some are asked for.
TEST_F(TuneCommand, TechniquesAreAskedForWhatTheReferenceHas) {
  const auto answer = [&](std::vector<std::string> more) {
    more.insert(more.end(),
                {"--term", "final", "--techniques", "implicit_visibility", "--set",
                 "implicit_visibility.bins=8", "--set", "implicit_visibility.longest_edge=1", "--set",
                 "implicit_visibility.glossy_bins=0", "--max-error", "rmse=10", "--json"});
    const Outcome outcome = tune(more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const auto parsed = nlohmann::json::parse(outcome.out, nullptr, false);
    return parsed.is_object() ? parsed["answer"]["technique"].get<std::string>() : std::string();
  };
  EXPECT_EQ(answer({}), "implicit_visibility:visibility+environment");
  EXPECT_EQ(answer({"--bounces", "1"}), "implicit_visibility");
}

/// As everywhere that --set is given.
TEST_F(TuneCommand, TheLastValueOfAParameterCounts) {
  const Outcome outcome =
      tune({"--techniques", "hard_shadow_map", "--set", "hard_shadow_map.shadow_map_size=32", "--set",
            "hard_shadow_map.shadow_map_size=64", "--max-error", "rmse=1", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["answer"]["parameters"]["hard_shadow_map.shadow_map_size"],
            "64");
}

/// Times of small pictures are brought to the full size by one setting that is tried in both.
TEST_F(TuneCommand, LargePicturesAreTriedInSmallOnes) {
  const Outcome outcome = limn({"tune", "cornell_box", "--size", "256x192", "--steps", "1", "--spp", "1",
                                "--frames", "1", "--turns", "1", "--techniques", "hard_shadow_map",
                                "--max-error", "rmse=1", "--out", folder_ / "out", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::map<std::string, int> tried;  // rows with the warm-up of tries, by size
  std::vector<std::string> sizes;
  std::ifstream rows(folder_ / "out/results.jsonl");
  for (std::string line; std::getline(rows, line);) {
    const auto row = nlohmann::json::parse(line);
    sizes.push_back(row["size"].dump());
    if (row["warmup"] == 1) ++tried[sizes.back()];
  }
  EXPECT_EQ(sizes.front(), "[256,192]") << "with whose table the page begins";
  EXPECT_GT(tried["[128,96]"], 1);
  EXPECT_EQ(tried["[256,192]"], 1);
  EXPECT_GT(nlohmann::json::parse(outcome.out)["answer"]["ms"], 0);
}

/// The file keeps the good row of elsewhere, whose times say nothing of this machine.
TEST_F(TuneCommand, WhatFailsHereIsNoAnswerThoughAnotherMachineMeasuredIt) {
  const std::map<std::string, std::string> environment = {
      {"LIMN_TECHNIQUE_PATH", std::string(kBinaryDir) + "/tests/misbehaver"},
      {"LIMN_TEST_TRIGGER", folder_ / "trigger"}};
  const auto question = command({"--light", "#0", "--techniques", "misbehaver", "--set",
                                 "misbehaver.way=once_there", "--max-error", "rmse=10"});
  const Outcome first = limn(question, environment);
  ASSERT_EQ(first.status, 0) << first.err;
  changeRows([](nlohmann::ordered_json& row) { row["stats"]["machine"] = "another machine"; });
  std::ofstream(folder_ / "trigger") << "now";
  const Outcome second = limn(question, environment);
  EXPECT_EQ(second.status, 1) << second.out;
  EXPECT_THAT(second.err, testing::AllOf(testing::HasSubstr("crashed: Aborted"),
                                         testing::HasSubstr("no setting could be measured"),
                                         testing::HasSubstr("it failed here, though not elsewhere")));
}

/// As under a black reference: predictions from infinite errors would order settings at random.
TEST_F(TuneCommand, InfiniteErrorsTellNoSettingsApart) {
  const std::vector<std::string> question = {
      "--techniques", "hard_shadow_map", "--set",  "hard_shadow_map.shadow_map_size=64", "--max-ms",
      "1e6",          "--metric",        "rel_mse"};
  const Outcome first = tune(question);
  ASSERT_EQ(first.status, 0) << first.err;
  changeRows([](nlohmann::ordered_json& row) { row["error"]["rel_mse"] = nullptr; });
  const Outcome second = tune(question);
  EXPECT_EQ(second.status, 1) << second.out;
  EXPECT_THAT(second.err, testing::AllOf(testing::HasSubstr("the relative MSE of "),
                                         testing::HasSubstr(" is infinite, as under a black reference"),
                                         testing::HasSubstr("use rmse\n")));
}

TEST_F(TuneCommand, SaysWhatComesNearestToALimitThatNothingKeeps) {
  const Outcome outcome = tune({"--techniques", "hard_shadow_map", "--set",
                                "hard_shadow_map.shadow_map_size=64", "--max-ms", "0.001", "-q"});
  EXPECT_EQ(outcome.status, 1);
  const Outcome loud = tune({"--techniques", "hard_shadow_map", "--set", "hard_shadow_map.shadow_map_size=64",
                             "--max-ms", "0.001"});
  EXPECT_THAT(loud.err,
              testing::AllOf(testing::HasSubstr("no setting takes at most 0.001 ms"),
                             testing::HasSubstr("shadow_map_size=64"), testing::HasSubstr("direct")));
  EXPECT_THAT(loud.err, testing::Not(testing::HasSubstr("noise"))) << "a limit of time";
  std::ofstream(folder_ / "out/tuned.toml") << "# of a search that found something\n";
  // No reference of 4 samples tells such an error from its own.
  const Outcome exact = tune({"--techniques", "hard_shadow_map", "--set",
                              "hard_shadow_map.shadow_map_size=64", "--max-error", "rmse=1e-9"});
  EXPECT_EQ(exact.status, 1);
  EXPECT_THAT(exact.err, testing::AllOf(testing::HasSubstr("no setting has a RMSE of at most 1e-09"),
                                        testing::HasSubstr("below the noise of the reference")));
  EXPECT_FALSE(fs::exists(folder_ / "out/tuned.toml"));
}

TEST_F(TuneCommand, QuestionsThatCannotBeAskedAreRefusedAtOnce) {
  expectRefused(tune({}), 2, {"--max-ms", "--max-error"});
  expectRefused(tune({"--max-ms", "10", "--max-error", "rmse=0.1"}), 2, {"excludes"});
  expectRefused(tune({"--max-error", "rmse=0.1", "--metric", "flip"}), 2, {"--metric", "excludes"});
  expectRefused(tune({"--max-error", "rsme=0.1"}), 2, {"rsme", "did you mean rmse"});
  expectRefused(tune({"--max-error", "rmse"}), 2, {"METRIC=X"});
  expectRefused(tune({"--max-ms", "10", "--metric", "pixels"}), 2, {"pixels", "known are"});
  expectRefused(tune({"--max-ms", "10", "--techniques", "pcs"}), 2, {"pcs", "pcss"});
  expectRefused(tune({"--max-ms", "10", "--techniques", "pcf", "--term", "indirect"}), 2, {"indirect"});
  expectRefused(tune({"--max-ms", "10", "--term", "visibility"}), 2, {"--light"});
  expectRefused(tune({"--max-ms", "10", "--bounces", "2"}), 2, {"--bounces", "direct"});
  expectRefused(tune({"--max-ms", "10", "--techniques", "pcf", "--set", "pcss.bias=1"}), 2, {"pcss.bias"});
  expectRefused(tune({"--max-ms", "10", "--techniques", "pcf", "--set", "pcf.kernel=1000"}), 2, {"kernel"});
  expectRefused(
      tune({"--max-ms", "10", "--techniques", "pcf", "--set", "pcf.kernel=1000", "--set", "pcf.kernel=3"}), 2,
      {"kernel"});
  expectRefused(tune({"--max-ms", "10", "--techniques", "pcf", "--set", "pcf.kernel"}), 2,
                {"--set 'pcf.kernel'", "TECHNIQUE.PARAMETER=VALUE"});
  expectRefused(tune({"--max-ms", "10", "--techniques", "pcf,pcss,pcf"}), 2, {"pcf is named twice"});
  expectRefused(limn({"tune", "cornell_box", "--term", "indirect", "--techniques", "clustered_visibility",
                      "--steps", "12", "--exhaustive", "--max-ms", "10", "--out", folder_ / "out"}),
                2, {"--exhaustive: the grid has ", "at most 100000", "--set"});
  EXPECT_FALSE(fs::exists(folder_ / "out/results.jsonl"));
}

}  // namespace
}  // namespace limn::test
