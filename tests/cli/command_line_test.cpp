// The command line as a person meets it: what is wrong is said in one line, and the exit status tells whose
// fault it is.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "tests/cli/limn_program.h"
#include "tests/support/gltf_builder.h"

namespace limn::test {
namespace {

using testing::HasSubstr;

/// Names under the heading of the help, one a line, whose descriptions go on further to the right.
std::vector<std::string> commandsOfHelp() {
  const std::string help = limn({"--help"}).out, heading = "Subcommands:\n";
  std::istringstream lines(help.substr(std::min(help.size(), help.find(heading))));
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("  ") && line.size() > 2 && line[2] != ' ')
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
  return names;
}

TEST(CommandLine, WrongUsageIsOneLine) {
  expectRefused(limn({}), 2, {"subcommand", "; see limn --help"});
  expectRefused(limn({"rendr"}), 2, {"'rendr'", "did you mean render", "bench"});
  expectRefused(limn({"render"}), 2, {"scene", "; see limn render --help"});
  expectRefused(limn({"brdf", "fit", "--texels", "1"}), 2, {"--texels", "; see limn brdf fit --help"});
  expectRefused(limn({"render", kCornellBox, "--out", "a.png", "--fov", "200"}), 2, {"--fov", "200", "179"});
  expectRefused(limn({"render", kCornellBox, "--out", "a.png", "--colour"}), 2, {"--colour"});
}

TEST(CommandLine, NoSeedStandsForAnother) {
  for (const char* seed : {"-1", "18446744073709551616", "1.5", "seven"})
    expectRefused(limn({"reference", kCornellBox, "--out", "a.exr", "--seed", seed}), 2, {"--seed", seed});
}

/// C reads 010 as 8, and so does CLI11.
TEST(CommandLine, WholeNumbersAreDecimal) {
  const TemporaryFolder folder;
  const auto with = [&](const char* spp) {
    return limn({"reference", kCornellBox, "--term", "direct", "--size", "16x12", "--spp", spp, "--out",
                 folder / "r.exr"});
  };
  for (const char* ten : {"010", "+10", "1e1"}) {
    const Outcome outcome = with(ten);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(": 10 samples per pixel"));
  }
  for (const char* none : {"0x10", "10.5", "10a", "0", "99999999999999999999"})
    expectRefused(with(none), 2, {"--spp", none, "1 to 16777216"});
}

/// CLI11 takes what stands behind the value of such an option for a further value.
TEST(CommandLine, RepeatableOptionsTakeOneValueEach) {
  const TemporaryFolder folder;
  const std::string picture = folder / "r.png", out = folder / "out";
  for (const auto& [option, value] :
       {std::pair("--set", "pcf.kernel=3"), {"--set-light", "key.intensity=1"}}) {
    const Outcome outcome =
        limn({"render", "--technique", "pcf", option, value, "balls", "--size", "16x12", "--out", picture});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  }
  expectRefused(limn({"bench", "--filter", "no such case", "quick", "--out", out}), 2,
                {"quick", "fits the filter"});
  expectRefused(
      limn({"tune", "--techniques", "pcf", "--set", "pcss.bias=1", "balls", "--max-ms", "1", "--out", out}),
      2, {"'pcss.bias=1'"});
}

/// No comparison holds with NaN, so that a range that asks whether a value lies outside lets it in.
TEST(CommandLine, NoRealOptionTakesNan) {
  std::vector<std::vector<std::string>> commands{{"brdf", "simulate"}};
  for (const std::string& command : commandsOfHelp()) commands.push_back({command});
  const std::regex real("^  (--[^ ,]+)[^ ]* FLOAT");
  std::set<std::string> options;
  for (std::vector<std::string> arguments : commands) {
    arguments.emplace_back("--help");
    std::istringstream help(limn(arguments).out);
    for (std::string line; std::getline(help, line);) {
      std::smatch match;
      if (!std::regex_search(line, match, real)) continue;
      const std::string option = match[1];
      std::vector<std::string> given = arguments;
      given.back() = option;
      given.emplace_back("nan");
      SCOPED_TRACE(fmt::format("{}", fmt::join(given, " ")));
      expectRefused(limn(given), 2, {option, "nan"});
      options.insert(option);
    }
  }
  EXPECT_THAT(options, testing::IsSupersetOf({"--fov", "--light-size", "--environment-lights", "--noise",
                                              "--longest-edge", "--fps", "--at-most", "--max-ms",
                                              "--max-masked", "--max-masked-share", "--stall-timeout",
                                              "--exposure", "--slope", "--scale"}));
}

TEST(CommandLine, LightSizesNeedLightsThatHaveOne) {
  TemporaryFolder folder;
  const std::string out = (folder / "v.exr").string();
  const std::vector<std::string> view{"--size", "32x24", "--light-size", "0.3", "--out", out};
  const auto with = [&](std::vector<std::string> command) {
    command.insert(command.end(), view.begin(), view.end());
    return limn(command);
  };
  expectRefused(with({"render", kCornellBox}), 2, {"--light-size 0.3", "limn_area"});
  EXPECT_EQ(with({"render", "lights"}).status, 0);
  EXPECT_EQ(with({"reference", "lights", "--term", "visibility", "--light", "key", "--spp", "4"}).status, 0);
}

TEST(CommandLine, AMediumIsGivenByOneNumberOrThree) {
  TemporaryFolder folder;
  const std::string out = (folder / "m.exr").string();
  const auto with = [&](std::vector<std::string> command, std::vector<std::string> medium) {
    command.insert(command.end(), medium.begin(), medium.end());
    command.insert(command.end(), {"--size", "32x24", "--out", out});
    return limn(command);
  };
  const std::vector<std::string> render{"render", kCornellBox, "--technique", "airlight"};
  EXPECT_EQ(with(render, {"--sigma-s", "0.1", "--sigma-a", "0.1,0.2,0.3", "--g", "-0.5"}).status, 0);
  EXPECT_EQ(with({"reference", kCornellBox, "--spp", "2", "--term", "media"}, {"--sigma-s", "0.1"}).status,
            0);
  EXPECT_EQ(with({"reference", "gem", "--spp", "2", "--term", "caustic"}, {}).status, 0);
  expectRefused(with(render, {"--sigma-s", "-1"}), 2, {"--sigma-s", "negative"});
  expectRefused(with(render, {"--sigma-a", "1,2"}), 2, {"--sigma-a", "red,green,blue"});
  EXPECT_EQ(with(render, {"--g", "1"}).status, 2);
}

TEST(CommandLine, BouncesBelongToIndirectAndFinalLight) {
  TemporaryFolder folder;
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all{"reference", kCornellBox, "--size", "16x12",
                                 "--spp",     "2",         "--out",  (folder / "r.exr").string()};
    all.insert(all.end(), more.begin(), more.end());
    return limn(all);
  };
  expectRefused(with({"--term", "direct", "--bounces", "2"}), 2,
                {"bounces 2", "direct", "final, indirect, subsurface and specular"});
  expectRefused(with({"--term", "indirect", "--bounces", "0"}), 2, {"bounces 0", "1 .. 1024"});
  expectRefused(with({"--term", "indirect", "--bounces", "-1"}), 2, {"--bounces", "-1", "1024"});
  expectRefused(with({"--term", "indirekt"}), 2,
                {"unknown term 'indirekt' (did you mean", "known are final, visibility"});
  EXPECT_EQ(with({"--term", "indirect"}).status, 0);
  EXPECT_EQ(with({"--term", "indirect", "--bounces", "3"}).status, 0);
  EXPECT_EQ(with({"--term", "final", "--bounces", "1", "--light", "key"}).status, 0);
}

/// More than the 256 samples that are taken where no noise is asked for.
TEST(CommandLine, ReferencesGoOnUntilTheyHaveTheNoiseThatIsAskedFor) {
  TemporaryFolder folder;
  const Outcome outcome = limn({"reference", kCornellBox, "--term", "direct", "--size", "16x12", "--noise",
                                "0.0002", "--out", (folder / "r.exr").string()});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const size_t colon = outcome.out.find(": "), noise = outcome.out.find("noise ");
  ASSERT_NE(noise, std::string::npos) << outcome.out;
  EXPECT_GT(std::stoi(outcome.out.substr(colon + 2)), 256);
  EXPECT_LE(std::stod(outcome.out.substr(noise + 6)), 0.0002);
}

TEST(CommandLine, OptionsThatWouldDoNothingAreRefused) {
  TemporaryFolder folder;
  const auto refused = [&](const char* command, const std::vector<std::string>& options) {
    std::vector<std::string> all{command, kCornellBox, "--out", (folder / "r.exr").string()};
    all.insert(all.end(), options.begin(), options.end());
    expectRefused(limn(all), 2, {options.at(0)});
  };
  refused("render", {"--fps", "5"});
  refused("render", {"--time", "1", "--frames", "0:1"});
  refused("reference", {"--longest-edge", "0.1"});
  for (const char* ofPictures : {"--noise", "--aa", "--exposure"})
    refused("reference", {ofPictures, "1", "--at-vertices"});
  refused("reference", {"--size", "32x24", "--at-vertices"});
}

TEST(CommandLine, FlickerComparesAnimationsWithTheTruth) {
  const auto flicker = [](const std::string& scene, std::vector<std::string> more) {
    std::vector<std::string> all{"flicker", scene,   "--technique", "reflective_shadow_map",
                                 "--size",  "32x24", "--spp",       "64"};
    all.insert(all.end(), more.begin(), more.end());
    return limn(all);
  };
  expectRefused(flicker("cornell_horse", {"--frames", "3:3"}), 2, {"--frames", "a < b"});
  expectRefused(flicker("cornell_horse", {"--output-term", "caustic"}), 2, {"caustic"});
  expectRefused(flicker("cornell_horse", {"--time", "1"}), 2, {"--time"});
  expectRefused(flicker("cornell_horse", {"--output-term", "direct", "--bounces", "1"}), 2,
                {"--bounces", "direct"});
  const Outcome still = flicker("cornell_box", {"--frames", "0:1"});
  EXPECT_EQ(still.status, 1);
  EXPECT_THAT(still.err, HasSubstr("does not change beyond its noise"));
  const Outcome moving = flicker("cornell_horse", {"--frames", "0:2", "--fps", "5", "--json"});
  ASSERT_EQ(moving.status, 0) << moving.err;
  const auto parsed = nlohmann::json::parse(moving.out);
  EXPECT_EQ(parsed["frames"], 3);
  EXPECT_GT(parsed["ratio"].get<double>(), 0);
  for (const std::string most : {"0.001", "0"}) {
    const Outcome strict = flicker("cornell_horse", {"--frames", "0:1", "--fps", "5", "--at-most", most});
    EXPECT_EQ(strict.status, 1);
    EXPECT_THAT(strict.err, HasSubstr("at most " + most + " is asked for"));
  }
}

/// Final pictures have none: without a technique that answers indirect light they show no bounce.
TEST(CommandLine, FlickerComparesWithTheBouncesOfTheTermOrTheTechnique) {
  const auto change = [](const std::string& techniques, std::vector<std::string> more) {
    std::vector<std::string> all{"flicker",  "cornell_horse", "--technique", techniques, "--term",
                                 "final",    "--size",        "32x24",       "--spp",    "64",
                                 "--frames", "0:1",           "--fps",       "5",        "--json"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = limn(all);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const auto parsed = nlohmann::json::parse(outcome.out, nullptr, false);
    return parsed.is_object() ? parsed["reference_change"].get<double>() : -1;
  };
  const double direct = change("hard_shadow_map", {}),
               bounced = change("hard_shadow_map", {"--bounces", "1"});
  EXPECT_EQ(direct, change("hard_shadow_map", {"--bounces", "0"}));
  EXPECT_NE(direct, bounced);
  EXPECT_EQ(change("hard_shadow_map,reflective_shadow_map", {}), bounced);
}

/// As in `limn render --frames`: what --set-light leaves of a light follows its animation.
TEST(CommandLine, FlickerMovesLightsAsTheirAnimationsDo) {
  GltfBuilder builder;
  builder.triangle();
  const int lamp = builder.light({{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}, {"intensity", 2}},
                                 {{"name", "lamp"}});
  const int times = builder.floats({0, 2}), places = builder.vec3({{0, 0, 1}, {0.6f, 0.6f, 1}});
  builder.append("animations",
                 {{"samplers", {{{"input", times}, {"output", places}}}},
                  {"channels", {{{"sampler", 0}, {"target", {{"node", lamp}, {"path", "translation"}}}}}}});
  const TemporaryFolder folder;
  const std::string scene = folder / "moving_lamp.glb";
  const std::vector<std::byte> bytes = builder.glb();
  std::ofstream(scene, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const Outcome outcome = limn({"flicker",       scene,
                                "--technique",   "hard_shadow_map",
                                "--output-term", "direct",
                                "--size",        "32x24",
                                "--eye",         "0.3,0.3,2",
                                "--target",      "0.3,0.3,0",
                                "--set-light",   "lamp.rotation=0,0,0",
                                "--frames",      "0:2",
                                "--fps",         "1",
                                "--spp",         "16",
                                "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_GT(nlohmann::json::parse(outcome.out)["ratio"], 0);
}

TEST(CommandLine, HelpOfEveryCommandIsComplete) {
  const std::vector<std::string> commands = commandsOfHelp();
  EXPECT_THAT(commands, testing::IsSupersetOf({"render", "tune", "view", "completion"}));
  for (const std::string& command : commands) {
    const Outcome outcome = limn({command, "--help"});
    EXPECT_EQ(outcome.status, 0) << command;
    EXPECT_THAT(outcome.out, HasSubstr("--help")) << command;
    if (command != "view" && command != "completion") {
      EXPECT_THAT(outcome.out, HasSubstr("-q,--quiet")) << command;
    }
  }
}

TEST(CommandLine, ExplainCostComparesWithAndWithout) {
  TemporaryFolder folder;
  const std::filesystem::path table = folder / "cost.md", figures = folder / "cost.json";
  const Outcome outcome =
      limn({"explain-cost", kCornellBox, "--technique", "vssm", "--set", "vssm.shadow_map_size=128", "--size",
            "32x24", "--repeat", "3", "--output-term", "direct", "--spp", "4", "--out", table.string(),
            "--json", figures.string()});
  EXPECT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("| vssm.early_out |"));
  EXPECT_TRUE(std::filesystem::exists(table));
  std::ifstream file(figures);
  const auto report = nlohmann::json::parse(file);
  for (const auto& saving : report.at("savings"))
    if (saving.at("applies")) {
      EXPECT_EQ(saving.at("forced").at("frame_ms").size(), 3u) << saving.at("name");
    }
  EXPECT_EQ(limn({"explain-cost", kCornellBox, "--technique", "reflective_shadow_map", "--size", "32x24",
                  "--repeat", "3", "--output-term", "indirect", "--spp", "4"})
                .status,
            0);
  expectRefused(limn({"explain-cost", kCornellBox, "--out", "/nowhere/cost.md"}), 1, {"/nowhere"});
  expectRefused(limn({"explain-cost", kCornellBox, "--output-term", "indirect"}), 2, {"indirect"});
}

/// A picture with indirect light has a reference with as many bounces.
TEST(CommandLine, ExplainCostComparesWithTheBouncesOfTheTechniques) {
  TemporaryFolder folder;
  const std::string picture = folder / "picture.exr", truth = folder / "truth.exr";
  const std::vector<std::string> techniques{"--technique", "hard_shadow_map,reflective_shadow_map"};
  const auto run = [](std::vector<std::string> all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = limn(all);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome;
  };
  run({"explain-cost", kCornellBox, "--size", "32x24", "--spp", "4", "--repeat", "1", "--json",
       folder / "cost.json"},
      techniques);
  run({"render", kCornellBox, "--size", "32x24", "--out", picture}, techniques);
  run({"reference", kCornellBox, "--size", "32x24", "--term", "final", "--bounces", "1", "--spp", "4",
       "--out", truth},
      {});
  const auto compared =
      nlohmann::json::parse(run({"compare", picture, truth, "--json", "--max-masked", "100"}, {}).out);
  std::ifstream file(folder / "cost.json");
  const auto report = nlohmann::json::parse(file);
  for (const auto& saving : report.at("savings"))
    if (saving.at("applies")) {
      EXPECT_DOUBLE_EQ(saving.at("without").at("rmse").get<double>(), compared.at("rmse").get<double>())
          << saving.at("name");
    }
}

TEST(CommandLine, ListNamesEveryTechniqueWithItsParameters) {
  const Outcome outcome = limn({"list", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto parsed = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(parsed["refused"].empty()) << parsed["refused"].dump();
  EXPECT_FALSE(parsed["techniques"].empty());
  for (const auto& technique : parsed["techniques"]) {
    EXPECT_FALSE(technique["terms"].empty()) << technique["name"];
    for (const auto& parameter : technique["parameters"])
      EXPECT_FALSE(parameter["doc"].get<std::string>().empty());
  }
}

/// What a list says of each name.
std::map<std::string, std::string> listed(const std::string& what) {
  const Outcome outcome = limn({"list", what, "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::map<std::string, std::string> about;
  const auto parsed = nlohmann::json::parse(outcome.out);
  for (const auto& entry : parsed[what]) about[entry["name"]] = entry["about"];
  return about;
}

TEST(CommandLine, ListSaysWhatSuitesAndEnvironmentsAreFor) {
  for (const char* what : {"suites", "environments"})
    for (const auto& [name, about] : listed(what)) EXPECT_FALSE(about.empty()) << name;
  EXPECT_THAT(limn({"list", "suites"}).out, HasSubstr("\nquick: a first try of a few minutes"));
}

TEST(CommandLine, ListSaysOfScenesWhatTheTableSays) {
  std::map<std::string, std::string> table;
  std::istringstream lines(contents(std::string(kSourceDir) + "/assets/README.md"));
  const std::regex row(R"(\| (\w+) \| [^|]*\| ([^|]+) \| [^|]* \| [^|]* \|)");
  for (std::string line; std::getline(lines, line);) {
    std::erase(line, '`');
    if (std::smatch cells; std::regex_match(line, cells, row)) table[cells[1]] = cells[2];
  }
  table.erase("scene");  // the heading
  EXPECT_EQ(listed("scenes"), table);
}

TEST(CommandLine, InfoTellsARendererOrWhyThereIsNone) {
  const Outcome outcome = limn({"info", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto parsed = nlohmann::json::parse(outcome.out);
  for (const auto& device : parsed["devices"])
    EXPECT_TRUE(device.contains("renderer") || device.contains("problem"));
}

TEST(CommandLine, InfoOfASceneNamesWhatOptionsTake) {
  const TemporaryFolder folder;
  const Outcome outcome = limn({"info", "gem", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto scene = nlohmann::json::parse(outcome.out);
  EXPECT_GT(scene["triangles"], 0);
  EXPECT_EQ(scene["size_m"].size(), 3u);
  std::vector<std::string> options = {"render", "gem", "--size", "16x12", "-q", "--out", folder / "gem.exr"};
  for (const auto& [option, name] : {std::pair("--camera", scene["cameras"].at(0)["name"]),
                                     std::pair("--light", scene["lights"].at(0)["name"]),
                                     std::pair("--animation", scene["animations"].at(0)["name"])})
    options.insert(options.end(), {option, name});
  const Outcome rendered = limn(options);
  EXPECT_EQ(rendered.status, 0) << rendered.err;
  EXPECT_THAT(limn({"info", "balls"}).out, testing::MatchesRegex("[^\n]*balls.glb: [0-9]+ triangles[^\n]*\n"
                                                                 "cameras: main \\(at [^\n]*\n"
                                                                 "lights: key \\(rectangle, [^\n]*\n"
                                                                 "animations: none\n"
                                                                 "environment: none\nmedium: none\n"));
  // What a camera's numbers say renders the same picture.
  const auto& camera = scene["cameras"].at(0);
  const auto list = [](const nlohmann::json& v) {
    return fmt::format("{},{},{}", v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
  };
  nlohmann::json target = camera["eye_m"];
  for (size_t i = 0; i < 3; ++i) target[i] = target[i].get<double>() + camera["direction"][i].get<double>();
  const std::string file = folder / "eye.exr";
  EXPECT_EQ(limn({"render", "gem", "--size", "16x12", "-q", "--eye", list(camera["eye_m"]), "--target",
                  list(target), "--fov", fmt::format("{}", camera["vertical_fov_degrees"].get<double>()),
                  "--out", file})
                .status,
            0);
  EXPECT_EQ(limn({"render", "gem", "--size", "16x12", "-q", "--out", folder / "named.exr"}).status, 0);
  const auto compared = nlohmann::json::parse(limn({"compare", file, folder / "named.exr", "--json"}).out);
  EXPECT_LT(compared["rmse"], 1e-3);
  expectRefused(limn({"info", "robt"}), 1, {"robot"});
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const TemporaryFolder folder;
  expectRefused(limn({"compare", (folder / "a.exr").string(), (folder / "b.exr").string()}), 1, {"a.exr"});
  expectRefused(limn({"compare", kCornellBox, kCornellBox}), 1, {"cornell_box.glb"});
  expectRefused(limn({"compare", kCornellBox, kCornellBox, "--diff", folder / "map.exr"}), 2,
                {"--diff", "map.exr", ".png"});
  for (const char* ev : {"200", "-60.5", "nan"})
    expectRefused(
        limn({"compare", (folder / "a.exr").string(), (folder / "b.exr").string(), "--exposure", ev}), 2,
        {"--exposure", "-60 to 60"});
}

}  // namespace
}  // namespace limn::test
