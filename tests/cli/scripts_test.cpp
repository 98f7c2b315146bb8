// Scripts around limn, with programs in its place that only say what they were asked.
#include <unistd.h>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

void writeProgram(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << "#!/bin/sh\n" << text;
  fs::permissions(file, fs::perms::owner_all);
}

/// A source tree with nothing but one of the scripts, and a folder beside it from which the script is called.
class Scripts : public testing::Test {
 protected:
  Scripts() {
    writeProgram(root_ / "scripts/build", "");
    writeProgram(root_ / "scripts/gallery", "");
    writeProgram(root_ / "build/bin/limn", "echo \"$@\" >> " + (folder_ / "said").string() + R"(
case $1 in
list) echo '{"techniques": []}' ;;
info) echo '{"devices": [{"backend": "egl", "device": -1, "renderer": "none", "software": true}]}' ;;
esac
)");
    for (const char* program : {"ctest", "git"}) writeProgram(folder_ / "programs" / program, "");
    fs::create_directory(caller_);
  }

  Outcome call(const std::string& script, const std::string& arguments) const {
    fs::copy_file(fs::path(kSourceDir) / "scripts" / script, root_ / "scripts" / script,
                  fs::copy_options::overwrite_existing);
    return run(
        {"/bin/bash", "-c", "cd " + caller_.string() + " && ../limn/scripts/" + script + " " + arguments},
        {{"PATH", (folder_ / "programs").string() + ":/usr/bin:/bin"}});
  }
  /// What limn was asked, a line each time.
  std::string said() const { return contents(folder_ / "said"); }

  const TemporaryFolder folder_;
  const fs::path root_ = folder_ / "limn", caller_ = folder_ / "caller";
};

TEST_F(Scripts, DemoWritesWhereItIsCalled) {
  const Outcome outcome = call("demo", "mine");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(fs::is_directory(caller_ / "mine"));
  EXPECT_THAT(said(), testing::HasSubstr("--out " + (fs::canonical(caller_) / "mine/bench").string() + "\n"));
}

/// Who asks what a script does gets no build and no folder called --help.
TEST_F(Scripts, SayWhatTheyDo) {
  for (const char* script : {"demo", "test"}) {
    const Outcome outcome = call(script, "--help");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, testing::StartsWith("Installs"));
  }
  EXPECT_EQ(call("demo", "--pictures").status, 2);
  EXPECT_TRUE(fs::is_empty(caller_));
  EXPECT_EQ(said(), "");
}

TEST_F(Scripts, TheGallerySaysThePicturesCommands) {
  const std::string name = "cornell_box.hard_shadow_map.png";
  const Outcome rendered = limn({"render", "cornell_box", "--technique", "hard_shadow_map", "--size", "16x12",
                                 "--out", caller_ / name});
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  std::ofstream(caller_ / "other.program.png") << "no picture of limn's";
  std::ofstream(caller_ / "50%25 #1.program.png") << "nor this";
  const Outcome outcome =
      run({"/usr/bin/env", "python3", "-B", std::string(kSourceDir) + "/scripts/gallery", caller_});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string page = contents(caller_ / "gallery.html");
  EXPECT_THAT(page, testing::HasSubstr("<figcaption>cornell_box<code>limn render cornell_box --technique "
                                       "hard_shadow_map --size 16x12 --out "));
  EXPECT_THAT(page, testing::HasSubstr("<figcaption>other</figcaption>"));
  EXPECT_THAT(page, testing::HasSubstr("<img src=\"50%2525%20%231.program.png\" "));
}

TEST_F(Scripts, GpuRunTakesSuitesOfTheFolderWhereItIsCalled) {
  std::ofstream(caller_ / "my.toml") << "name = 'my'\n";
  const Outcome outcome = call("gpu-run", "--software my.toml bound");
  EXPECT_THAT(said(), testing::HasSubstr("bench " + (fs::canonical(caller_) / "my.toml").string() + " "))
      << outcome.err;
  EXPECT_THAT(said(), testing::HasSubstr("bench bound "));
}

/// Results lie in a folder of the suite's name, which is bench for those of all techniques.
TEST_F(Scripts, GpuRunRefusesTwoSuitesOfOneName) {
  for (const char* folder : {"a", "b"}) {
    fs::create_directory(caller_ / folder);
    std::ofstream(caller_ / folder / "bench.toml") << "name = 'my'\n";
  }
  const Outcome outcome = call("gpu-run", "--software a/bench.toml bound b/bench.toml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, testing::HasSubstr("two suites are called bench: "));
  EXPECT_FALSE(fs::exists(root_ / "docs"));
}

TEST_F(Scripts, GpuRunLeavesNoTableOfAnEarlierRun) {
  call("gpu-run", "--software bound");
  std::vector<fs::path> packed;
  for (const auto& entry : fs::directory_iterator(root_ / "docs/results")) packed.push_back(entry.path());
  ASSERT_EQ(packed.size(), 1u);
  std::ofstream(packed[0] / "bound/gone.csv") << "scene,camera,light\n";
  call("gpu-run", "--software bound");
  EXPECT_FALSE(fs::exists(packed[0] / "bound/gone.csv"));
}

/// As limn's own tables: what failed when it was tried again hides no good row of the same program.
TEST_F(Scripts, TablesOfDocumentsShowTheRowsThatCount) {
  const std::string asked =
      R"({"key": "k", "scene": "s", "camera": "", "term": "direct", "technique": "t", "title": "", )"
      R"("light_size": 0, "time": 0, "environment": {"map": ""}, "changes": {}, "size": [1, 1], "fps": 0, )"
      R"("time_size": [0, 0], "parameters": {}, "max_masked_share": 0.005, )"
      R"("provenance": {"scene": "s", "techniques": [], "program": )";
  const std::string good = asked + R"("1"}, "stats": {}, "error": {"rmse": 0.5, "structured": 0, "bias": 0, )"
                                   R"("noise_floor": 0, "masked_share": 0}})";
  const auto failed = [&](const std::string& program) {
    return asked + "\"" + program + R"("}, "failure": "lost", "renderer": "r"})";
  };
  const auto page = [&](const std::string& first, const std::string& second) {
    fs::create_directories(root_ / "docs/results/run");
    std::ofstream(root_ / "docs/results/tables.toml")
        << "[[tables]]\npage = 'docs/page.md'\nname = 'n'\nresults = ['run']\ncell = '{rmse:.1f}'\n"
           "failed = 'refused'\ncolumns = [{label = 'RMSE'}]\nrows = [{label = 't', technique = 't'}]\n";
    std::ofstream(root_ / "docs/results/run/results.jsonl") << first << '\n' << second << '\n';
    std::ofstream(root_ / "docs/page.md") << "<!-- table n -->\n";
    const Outcome outcome = call("result-tables", "");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return contents(root_ / "docs/page.md");
  };
  const std::string head = "<!-- table n -->\n| | RMSE |\n| --- | --: |\n";
  EXPECT_EQ(page(good, failed("1")), head + "| t | 0.5 |\n");
  EXPECT_EQ(page(failed("1"), good), head + "| t | 0.5 |\n");
  EXPECT_EQ(page(good, failed("2")), head + "| t | refused |\n") << "an old answer would hide it";
}

/// A build with tests compiles nothing again that one without them has compiled.
TEST_F(Scripts, TestsAreAddedToABuildAsItIs) {
  writeProgram(
      folder_ / "programs/cmake",
      "echo \"$@\" >> " + (folder_ / "said").string() +
          "\n[ \"$1\" = --build ] || { mkdir -p build; touch build/build.ninja build/CMakeCache.txt; }\n");
  std::ofstream(root_ / "scripts/packages.txt") << "# none\n";
  for (const char* arguments : {"", "--tests"}) {
    const Outcome outcome = call("build", arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  EXPECT_THAT(said(), testing::AllOf(testing::HasSubstr("-DLIMN_UNITY=ON -DLIMN_BUILD_TESTS=OFF "),
                                     testing::HasSubstr("-DLIMN_UNITY_TESTS=ON -DLIMN_BUILD_TESTS=ON "),
                                     testing::Not(testing::HasSubstr("-DLIMN_UNITY=OFF"))));
}

TEST_F(Scripts, TidyLooksAtSourcesThatAreCompiledTogether) {
  for (const char* program : {"cmake", "run-clang-tidy"}) writeProgram(folder_ / "programs" / program, "");
  const fs::path united = root_ / "build/Unity/all.cxx";
  const std::string one = root_ / "core/one.cpp", other = root_ / "core/other.cpp";
  fs::create_directory(united.parent_path());
  std::ofstream(united) << "#include \"" << one << "\"\n#include \"" << other << "\"\n";
  std::ofstream(root_ / "build/compile_commands.json")
      << R"([{"directory": "/", "command": "c++ -DA=1 -include /b/cmake_pch.hxx -o Unity/all.o -c )"
      << united.string() << R"(", "file": ")" << united.string() << R"("}])";
  const Outcome outcome = call("tidy", "core");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string commands = contents(root_ / "build/tidy/compile_commands.json");
  for (const std::string& source : {one, other})
    EXPECT_THAT(commands, testing::AllOf(testing::HasSubstr("c++ -DA=1 -o Unity/all.o -c " + source),
                                         testing::HasSubstr("\"file\": \"" + source)));
}

TEST_F(Scripts, TryPackageLeavesAFolderThatIsNoSystem) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can make a system";
  std::ofstream(caller_ / "limn.deb") << "no package";
  fs::create_directory(caller_ / "mine");
  std::ofstream(caller_ / "mine/file") << "kept";
  const Outcome outcome = call("try-package", "limn.deb mine");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, testing::HasSubstr("mine is no Debian system"));
  EXPECT_EQ(contents(caller_ / "mine/file"), "kept");
}

TEST_F(Scripts, ManualPagesAreWrittenForProgramsInFoldersOfAnyName) {
  const fs::path program = folder_ / "it's a folder/limn";
  writeProgram(program, R"(
case "$*" in
--version) echo "limn 1.2" ;;
--help) printf 'A renderer\n\nUsage: limn [OPTIONS]\n\nSubcommands:\n  render    Render things\n  view      See things\n' ;;
*) printf 'Render things\n\nUsage: limn render [OPTIONS]\n' ;;
esac
)");
  const Outcome outcome = run({"/usr/bin/env", "python3", "-B", std::string(kSourceDir) + "/apps/manual.py",
                               "help2man", folder_ / "pages", program});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(listing(folder_ / "pages"), (std::vector<std::string>{"limn-render.1", "limn.1"}));
  const std::string page = contents(folder_ / "pages/limn-render.1");
  EXPECT_THAT(page, testing::HasSubstr("\n.TH LIMN-RENDER \"1\" "));
  EXPECT_THAT(page, testing::HasSubstr("\nlimn-render \\- render things\n")) << "a name that whatis reads";
  EXPECT_THAT(page, testing::Not(testing::HasSubstr("folder")));
}

}  // namespace
}  // namespace limn::test
