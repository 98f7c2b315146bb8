// A bench that loses nothing: whatever goes wrong costs one row and one line.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class BenchFaults : public testing::Test {
 protected:
  BenchFaults() { fs::copy_file(kCornellBox, folder_ / "box.glb"); }

  /// A suite of 16 x 16 pixels of which a case takes milliseconds.
  void suite(const std::string& techniques, const std::string& more = "",
             const std::string& scene = "lights = ['#0']") {
    std::ofstream(folder_ / "suite.toml")
        << "name = 'faults'\nsizes = '16x16'\nframes = 1\nwarmup = 0\nterm = 'visibility'\n"
           "reference = {spp = 2}\n"
        << more << "\n[[scenes]]\nscene = '" << (folder_ / "box.glb").string()
        << "'\nmax_masked_share = 0.5\n"
        << scene << "\n"
        << techniques;
  }
  static std::string technique(const std::string& name, const std::string& parameters = "") {
    return "[[techniques]]\ntechnique = '" + name + "'\nparameters = {" + parameters + "}\n";
  }
  static std::string shadows(const std::string& sizes = "16") {
    return technique("hard_shadow_map", "shadow_map_size = " + sizes);
  }

  std::vector<std::string> command(const std::string& out = "out") const {
    return {kLimnBinary, "bench", folder_ / "suite.toml", "--out", folder_ / out};
  }
  Outcome bench(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = command();
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, environment_);
  }

  /// Rows by key, without what differs from run to run: times and what of them comes with the reference.
  static std::map<std::string, nlohmann::json> rows(const fs::path& out) {
    std::map<std::string, nlohmann::json> found;
    std::istringstream text(contents(out / "results.jsonl"));
    for (std::string line; std::getline(text, line);) {
      nlohmann::json row = nlohmann::json::parse(line);
      row.erase("stats");
      row["reference"].erase("seconds");
      found[row["key"]] = row;
    }
    return found;
  }

  void append(const std::string& line) const {
    std::ofstream(folder_ / "out/results.jsonl", std::ios::app) << line;
  }

  const TemporaryFolder folder_;
  std::map<std::string, std::string> environment_ = {
      {"LIMN_TECHNIQUE_PATH", std::string(kBinaryDir) + "/tests/misbehaver"}};
};

TEST_F(BenchFaults, EveryWayToFailCostsOneRow) {
  suite(shadows() +
            technique("misbehaver", "way = ['foreign', 'number', 'memory', 'hang', 'crash', 'none']") +
            shadows("32"),
        "stall_timeout = 20");
  const Outcome outcome = bench({"--stall-timeout", "4"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("3 rows measured, 0 were there already, 5 failed")) << outcome.err;
  const std::string thrown =
      ": technique misbehaver (" + std::string(kBinaryDir) + "/tests/misbehaver/misbehaver.so): ";
  for (const std::string& line :
       {"way=foreign" + thrown + "no error of limn's own\n",
        "way=number" + thrown + "it threw something that is no std::exception\n",
        "way=memory" + thrown + "out of memory\n", std::string("way=hang: no progress for 4 s\n"),
        std::string("way=crash: crashed: Aborted, in technique misbehaver\n")})
    EXPECT_THAT(outcome.err, HasSubstr(line));
  EXPECT_EQ(rows(folder_ / "out").size(), 8u);
  EXPECT_THAT(contents(folder_ / "out/tables.md"), HasSubstr("failed: no progress for 4 s"));
}

TEST_F(BenchFaults, WhatFailsIsSaidToTheQuietAsWell) {
  suite(shadows() + technique("misbehaver", "way = ['number', 'crash']"));
  const Outcome outcome = bench({"-q"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("it threw something that is no std::exception\n"));
  EXPECT_THAT(outcome.err, HasSubstr("way=crash: crashed: Aborted, in technique misbehaver\n"));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 2) << outcome.err;
}

TEST_F(BenchFaults, ACrashInALaterTurnLeavesTheRow) {
  suite(technique("misbehaver", "way = 'once_there'") + shadows(), "turns = 2");
  environment_["LIMN_TEST_TRIGGER"] = folder_ / "out/results.jsonl";
  const Outcome first = bench();
  EXPECT_EQ(first.status, 1) << "the suite is not whole: " << first.err;
  EXPECT_THAT(first.err, HasSubstr("way=once_there: crashed: Aborted"));
  EXPECT_THAT(first.out, HasSubstr("2 rows measured, 0 were there already, 0 failed"));
  EXPECT_THAT(first.out, HasSubstr("1 rows lack turns, since a further turn of theirs failed"));
  EXPECT_THAT(contents(folder_ / "out/tables.md"), Not(HasSubstr("failed")));
  // As an earlier version left it: the failure behind the good row.
  nlohmann::json row;
  std::istringstream text(contents(folder_ / "out/results.jsonl"));
  for (std::string line; std::getline(text, line);)
    if (line.find("once_there") != std::string::npos) row = nlohmann::json::parse(line);
  ASSERT_TRUE(row.contains("error"));
  row.erase("error");
  row.erase("stats");
  row["failure"] = "crashed: Aborted";
  row["renderer"] = "whichever";
  append(row.dump() + "\n");
  // Without the trigger the turn that is missing is made up for.
  environment_.erase("LIMN_TEST_TRIGGER");
  const Outcome second = bench();
  EXPECT_EQ(second.status, 0) << second.err;
  EXPECT_THAT(second.out, HasSubstr("0 rows measured, 2 were there already, 0 failed"));
  EXPECT_THAT(second.out, Not(HasSubstr("lack turns")));
  EXPECT_THAT(contents(folder_ / "out/tables.md"), Not(HasSubstr("failed")));
  text = std::istringstream(contents(folder_ / "out/results.jsonl"));
  int turns = 0;
  for (std::string line; std::getline(text, line);)
    if (line.find("once_there") != std::string::npos && line.find("failure") == std::string::npos)
      turns = nlohmann::json::parse(line)["stats"]["turns"];
  EXPECT_EQ(turns, 2);
}

TEST_F(BenchFaults, WhatIsMissingIsSaidBeforeAnythingIsMeasured) {
  suite(
      shadows() + technique("no_such_technique") + technique("misbehaver", "speed = 3"), "",
      "lights = ['#0', 'no such light']\ncameras = ['no such camera']\n"
      "[[scenes]]\nscene = 'no_such_scene'\n[[scenes]]\nscene = 'cornell_box'\nenvironment = 'no such map'");
  const Outcome outcome = bench();
  EXPECT_EQ(outcome.status, 2);
  for (const char* thing :
       {"no_such_technique", "speed", "no such light", "no such camera", "no_such_scene", "no such map"})
    EXPECT_THAT(outcome.err, HasSubstr(thing));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 6) << outcome.err;
  EXPECT_EQ(bench({"-q"}).err, outcome.err) << "errors, all of them";
  EXPECT_FALSE(fs::exists(folder_ / "out/results.jsonl"));
}

TEST_F(BenchFaults, WhatHasChangedIsMeasuredAgain) {
  const fs::path modules = folder_ / "modules";
  fs::create_directory(modules);
  fs::copy_file(std::string(kBinaryDir) + "/tests/misbehaver/misbehaver.so", modules / "misbehaver.so");
  environment_["LIMN_TECHNIQUE_PATH"] = modules;
  suite(shadows() + technique("misbehaver"));
  ASSERT_THAT(bench().out, HasSubstr("2 rows measured, 0 were"));
  EXPECT_THAT(bench().out, HasSubstr("0 rows measured, 2 were"));
  std::ofstream(modules / "misbehaver.so", std::ios::app) << "later";  // as if it had been built anew
  const Outcome module = bench();
  EXPECT_THAT(module.out, HasSubstr("1 rows measured, 1 were"));
  EXPECT_THAT(module.err, HasSubstr("1 rows are measured again: technique misbehaver has changed (1)\n"));
  fs::remove(folder_ / "box.glb");
  fs::copy_file(fs::path(kCornellBox).parent_path().parent_path() / "balls/balls.glb", folder_ / "box.glb");
  const Outcome scene = bench();
  EXPECT_THAT(scene.out, HasSubstr("2 rows measured, 0 were")) << scene.err;
  EXPECT_THAT(scene.err, HasSubstr("2 rows are measured again: the scene has changed (2)\n"));
  EXPECT_EQ(rows(folder_ / "out").size(), 2u) << "the keys are those of what was asked";

  const std::string text = contents(folder_ / "out/results.jsonl");
  const nlohmann::json last = nlohmann::json::parse(text.substr(text.rfind('\n', text.size() - 2) + 1));
  EXPECT_EQ(last["provenance"]["techniques"][0]["file"], "misbehaver.so");
  // Rows of versions that recorded the module's path hold as long as its content does.
  const auto withPath =
      std::regex_replace(text, std::regex("\"misbehaver.so\""), "\"/elsewhere/misbehaver.so\"");
  std::ofstream(folder_ / "out/results.jsonl") << withPath;
  EXPECT_THAT(bench().out, HasSubstr("0 rows measured, 2 were"));
  // Rows of versions that recorded nothing are shown as they are, and measured anew.
  std::ofstream old(folder_ / "out/results.jsonl");
  for (const auto& [key, row] : [&] {
         std::map<std::string, nlohmann::json> whole;
         std::istringstream lines(text);
         for (std::string line; std::getline(lines, line);) {
           const auto parsed = nlohmann::json::parse(line);
           whole[parsed["key"]] = parsed;
         }
         return whole;
       }()) {
    nlohmann::json copy = row;
    copy.erase("provenance");
    old << copy.dump() << "\n";
  }
  old.close();
  EXPECT_EQ(limn({"report", folder_ / "out"}).status, 0);
  EXPECT_THAT(bench().err, HasSubstr("an earlier version did not record what it used (2)"));
}

TEST_F(BenchFaults, ACrashOfANewerModuleIsNotHiddenByTheRowOfTheOlder) {
  const fs::path modules = folder_ / "modules", trigger = folder_ / "trigger";
  fs::create_directory(modules);
  fs::copy_file(std::string(kBinaryDir) + "/tests/misbehaver/misbehaver.so", modules / "misbehaver.so");
  environment_["LIMN_TECHNIQUE_PATH"] = modules;
  environment_["LIMN_TEST_TRIGGER"] = trigger;
  suite(technique("misbehaver", "way = 'once_there'") + shadows());
  ASSERT_EQ(bench().status, 0);
  fs::copy(folder_ / "out", folder_ / "before", fs::copy_options::recursive);
  std::ofstream(modules / "misbehaver.so", std::ios::app) << "later";  // as if it had been built anew
  std::ofstream(trigger) << "crash";
  const Outcome outcome = bench({"--against", folder_ / "before"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("0 rows measured, 1 were there already, 1 failed"));
  EXPECT_THAT(outcome.out, HasSubstr("2 rows compared: 0 slower, 0 worse, 1 failed"));
  EXPECT_THAT(contents(folder_ / "out/tables.md"), HasSubstr("failed: crashed: Aborted"));
}

TEST_F(BenchFaults, KilledAtAnyMomentItGoesOnWhereItWas) {
  suite(shadows("[16, 17, 18, 19, 20, 21]"), "turns = 2\npictures = true");
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  ASSERT_EQ(run(command("whole"), environment_).status, 0);
  const std::chrono::duration<double> whole = Clock::now() - start;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0, 1);  // of the time it takes here, slow or fast
  for (int kills = 0; kills < 6;) {
    Process process(command(), environment_);
    std::this_thread::sleep_for(whole * part(random));
    process.signal(SIGKILL);
    if (process.wait().status == -1)
      ++kills;
    else
      fs::remove_all(folder_ / "out");  // it was done: from the beginning
  }
  const Outcome outcome = bench();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(rows(folder_ / "out"), rows(folder_ / "whole"));
  for (const auto& file : fs::recursive_directory_iterator(folder_ / "out"))
    EXPECT_THAT(file.path().string(), Not(testing::EndsWith(".part")));
  EXPECT_THAT(listing(folder_ / "out/pictures"), listing(folder_ / "whole/pictures"));
}

TEST_F(BenchFaults, TheSecondOfTwoInOneFolderSaysWhoIsThere) {
  suite(technique("misbehaver", "way = 'hang'") + shadows());
  Process first(command(), environment_);
  ASSERT_TRUE(first.waitUntil([&] { return !contents(folder_ / "out/.lock").empty(); })) << first.err();
  expectRefused(bench(), 1,
                {"folder " + (folder_ / "out").string(), "is in use by process ", " on ", " since "});
  expectRefused(limn({"stress", "--technique", "hard_shadow_map", "--filter", "one triangle", "--out",
                      folder_ / "out"}),
                1, {"is in use by process "});
  first.signal(SIGKILL);
  first.wait();
  suite(shadows());
  EXPECT_EQ(bench().status, 0) << "a killed holder leaves nothing locked";
  EXPECT_FALSE(fs::exists(folder_ / "out/.lock"));
}

TEST_F(BenchFaults, AReferenceIsRenderedByOneProcessAtATime) {
  const auto reference = [&](const std::string& where) {
    std::vector<std::string> arguments = {kLimnBinary, "reference", kCornellBox,      "--size",
                                          "64x64",     "--spp",     "1048576",        "--threads",
                                          "1",         "--out",     folder_ / "a.exr"};
    if (!where.empty()) arguments.insert(arguments.end(), {"--cache", folder_ / where});
    return arguments;
  };
  for (const std::string& cache : {std::string(), std::string("cache")}) {
    Process first(reference(cache));
    ASSERT_TRUE(first.waitUntil([&] { return first.err().find('%') != std::string::npos; })) << first.err();
    const Outcome second = run(reference(cache));
    EXPECT_EQ(second.status, 1);
    EXPECT_THAT(second.err, HasSubstr("is in use by process "));
    first.signal(SIGINT);
    EXPECT_THAT(first.wait().err, HasSubstr("stopped after"));
    EXPECT_FALSE(fs::exists(folder_ / "a.exr.lock"));
  }
}

TEST_F(BenchFaults, BrokenCachesAreRenderedAnewAndBlockedOnesWarnOnce) {
  suite(shadows("[16, 32]"));
  ASSERT_EQ(bench().status, 0);
  const auto whole = rows(folder_ / "out");
  for (const auto& entry : fs::directory_iterator(folder_ / "out/references"))
    fs::resize_file(entry.path(), fs::file_size(entry.path()) / 2);
  fs::remove(folder_ / "out/results.jsonl");
  EXPECT_EQ(bench().status, 0);
  EXPECT_EQ(rows(folder_ / "out"), whole);

  fs::remove_all(folder_ / "out/references");
  fs::remove(folder_ / "out/results.jsonl");
  std::ofstream(folder_ / "out/references") << "a file where the folder should be";
  const Outcome blocked = bench();
  EXPECT_EQ(blocked.status, 0) << blocked.err;
  EXPECT_THAT(blocked.out, HasSubstr("2 rows measured"));
  const size_t said = blocked.err.find("kept in memory");
  ASSERT_NE(said, std::string::npos) << blocked.err;
  EXPECT_EQ(blocked.err.find("kept in memory", said + 1), std::string::npos) << blocked.err;
}

TEST_F(BenchFaults, BrokenRowsAreNamedAndLeftAlone) {
  suite(shadows());
  ASSERT_EQ(bench().status, 0);
  const std::string good = contents(folder_ / "out/results.jsonl");
  for (const std::string& junk : {std::string("\x7f"
                                              "ELF\0\x01\xff\n",
                                              8),
                                  std::string("{\"key\": 3}\n"), good.substr(0, good.size() / 2) + "\n"}) {
    std::ofstream(folder_ / "out/results.jsonl") << good << junk << good;
    const Outcome outcome = bench();
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.err, HasSubstr("results.jsonl:2: not a row"));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(contents(folder_ / "out/results.jsonl"), good + junk + good);
  }
}

TEST_F(BenchFaults, OddFileNamesAreNamesLikeOthers) {
  for (const std::string& name :
       {std::string("two words"), std::string("it's \"quoted\""), std::string("a\nb"),
        std::string("\xff\xfe"), std::string("-dash"), std::string(250, 'n')}) {
    suite(shadows());
    const fs::path out = folder_ / name;
    const Outcome outcome = run({kLimnBinary, "bench", folder_ / "suite.toml", "--out=" + out.string()});
    EXPECT_EQ(outcome.status, 0) << name << ": " << outcome.err;
    EXPECT_THAT(run({kLimnBinary, "bench", folder_ / "suite.toml", "--out=" + out.string()}).out,
                HasSubstr("0 rows measured, 1 were there"));
  }
  const fs::path picture = folder_ / (std::string(240, 'p') + ".exr");
  const Outcome reference = limn({"reference", kCornellBox, "--size", "8x8", "--spp", "2", "--out", picture});
  EXPECT_EQ(reference.status, 0) << reference.err;
}

TEST_F(BenchFaults, AFolderThatCannotBeWrittenIsOneLine) {
  suite(shadows());
  std::ofstream(folder_ / "file") << "no folder";
  const Outcome below = run(command("file/out"), environment_);
  expectRefused(below, 1, {(folder_ / "file/out").string()});
  // Permissions do not bind root; a read-only mount does.
  fs::create_directory(folder_ / "out");
  const std::string path = (folder_ / "out").string();
  if (geteuid() != 0 || mount(path.c_str(), path.c_str(), nullptr, MS_BIND, nullptr) != 0)
    GTEST_SKIP() << "no read-only mount can be made here";
  const bool readOnly = mount(nullptr, path.c_str(), nullptr, MS_BIND | MS_REMOUNT | MS_RDONLY, nullptr) == 0;
  const Outcome outcome = bench();
  umount(path.c_str());
  if (!readOnly) GTEST_SKIP() << "no read-only mount can be made here";
  expectRefused(outcome, 1, {(folder_ / "out/results.jsonl").string(), "Read-only file system"});
}

TEST_F(BenchFaults, LittleIsEnoughOrSaidInOneLine) {
  suite(shadows());
  const auto limited = [&](const std::string& limit) {
    return run({"/bin/sh", "-c", "ulimit " + limit + "; exec \"$0\" \"$@\"", kLimnBinary, "bench",
                folder_ / "suite.toml", "--out", folder_ / "out"});
  };
  // Each ends in rows, or in a message, and leaves a folder that goes on.
  for (const char* limit : {"-n 8", "-n 16", "-v 200000", "-v 400000", "-v 800000"}) {
    const Outcome outcome = limited(limit);
    EXPECT_NE(outcome.status, 2) << limit << outcome.err;
    EXPECT_TRUE(outcome.status == 0 || !outcome.err.empty()) << limit;
  }
  const Outcome after = bench();
  EXPECT_EQ(after.status, 0) << after.err;
  EXPECT_EQ(rows(folder_ / "out").size(), 1u);
}

/// Whoever starts it may ignore how its children end (SIGCHLD), which a program inherits.
TEST_F(BenchFaults, AParentThatIgnoresItsChildrenChangesNothing) {
  suite(shadows());
  std::vector<std::string> arguments = command();
  arguments.insert(arguments.begin(), {"/usr/bin/env", "--ignore-signal=CHLD"});
  const Outcome outcome = run(arguments, environment_);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(rows(folder_ / "out").size(), 1u);
}

TEST_F(BenchFaults, NoHomeAndACommaForAPointChangeNothing) {
  suite(shadows());
  ASSERT_EQ(bench().status, 0);
  const auto whole = rows(folder_ / "out");
  fs::remove_all(folder_ / "out");
  const Outcome bare =
      run({"/usr/bin/env", "-i", kLimnBinary, "bench", folder_ / "suite.toml", "--out", folder_ / "out"});
  EXPECT_EQ(bare.status, 0) << bare.err;
  EXPECT_EQ(rows(folder_ / "out"), whole);
  fs::remove_all(folder_ / "out");
  const Outcome made =
      run({"/usr/bin/env", "localedef", "-i", "de_DE", "-f", "UTF-8", folder_ / "de_DE.UTF-8"});
  if (!fs::exists(folder_ / "de_DE.UTF-8/LC_NUMERIC")) GTEST_SKIP() << "no locale can be made: " << made.err;
  environment_["LOCPATH"] = folder_.path();
  environment_["LC_ALL"] = "de_DE.UTF-8";
  EXPECT_EQ(bench().status, 0);
  EXPECT_EQ(rows(folder_ / "out"), whole);
}

}  // namespace
}  // namespace limn::test
