// Every picture holds the command that gives it.
#include <OpenImageIO/imageio.h>

#include <nlohmann/json.hpp>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

/// A text that limn put into a picture, as another program finds it.
std::string text(const fs::path& picture, const std::string& key) {
  const auto input = OIIO::ImageInput::open(picture.string());
  return input ? std::string(input->spec().get_string_attribute("limn/" + key)) : "not a picture";
}

/// Runs a line in a shell and in a folder, with `limn` as the program under test.
Outcome shell(const fs::path& folder, const std::string& line) {
  return run({"/bin/bash", "-c", "cd \"$1\" && limn() { \"$0\" \"$@\"; }; shift; eval \"$1\"", kLimnBinary,
              folder.string(), line});
}

/// That the command in the picture gives the picture again, to the byte.
void expectGivenAgain(const fs::path& folder, const std::string& name) {
  const std::string command = text(folder / name, "command"), picture = contents(folder / name);
  EXPECT_THAT(command, testing::StartsWith("limn "));
  fs::remove(folder / name);
  const Outcome again = shell(folder, command);
  ASSERT_EQ(again.status, 0) << command << again.err;
  EXPECT_TRUE(contents(folder / name) == picture) << command;
}

/// That the line makes a picture whose command gives it again.
void expectReproduced(const fs::path& folder, const std::string& line, const std::string& name) {
  const Outcome made = shell(folder, line);
  ASSERT_EQ(made.status, 0) << line << made.err;
  expectGivenAgain(folder, name);
}

TEST(Provenance, TheCommandInsideAPictureGivesItAgain) {
  const TemporaryFolder folder;
  const std::string scene = "cornell_box --size 33x25 ";
  for (const std::string name : {"a.png", "a.exr"})
    expectReproduced(folder.path(),
                     "limn render " + scene + "--technique pcss --set pcss.filter_samples=8 -o " + name,
                     name);
  expectReproduced(folder.path(), "limn render " + scene + "-q -o 'it'\\''s; $(x) `y` \"z\".png'",
                   "it's; $(x) `y` \"z\".png");
  expectReproduced(folder.path(), "limn render " + scene + "-o $'l\\ni\\303\\244.png'", "l\ni\xc3\xa4.png");
  for (const std::string name : {"r.png", "r.exr"})
    expectReproduced(folder.path(), "limn reference " + scene + "--spp 4 --seed 7 -o " + name, name);
  expectReproduced(folder.path(), "limn reference " + scene + "--spp 4 --cache kept -o k.exr", "k.exr");
  expectReproduced(folder.path(), "limn compare a.exr r.exr --diff d.png", "d.png");
  expectReproduced(folder.path(), "limn environment sky --width 64 --overlay o.png", "o.png");
  expectReproduced(folder.path(), "limn brdf info metal:0.3 --picture b.png", "b.png");
  expectReproduced(folder.path(), "limn render " + scene + "--frames 1:2 -o f.png", "f.0002.png");
}

/// Suites that find it there know whether its time may stand beside theirs.
TEST(Provenance, AReferenceInACacheNamesTheMachineThatTookTheTime) {
  const TemporaryFolder folder;
  const auto kept = [&](const std::string& cache, const std::string& more) {
    const std::string line =
        "limn reference cornell_box --size 16x12 --spp 2 -o a.exr --cache " + cache + more;
    EXPECT_EQ(shell(folder.path(), line).status, 0);
    for (const auto& entry : fs::directory_iterator(folder / cache))
      if (entry.path().extension() == ".exr") return entry.path();
    return fs::path();
  };
  const fs::path all = kept("all", ""), one = kept("one", " --threads 1");
  EXPECT_THAT(text(all, "machine"), testing::HasSubstr(" threads, "));
  EXPECT_NE(text(all, "seconds"), "");
  EXPECT_EQ(text(one, "seconds"), "") << "it is not what all cores take";
  EXPECT_EQ(text(one, "spp"), "2");
}

TEST(Provenance, APictureNamesTheVersionAndNoPathThatNobodyTyped) {
  const TemporaryFolder folder;
  const std::string line = "limn render cornell_box --size 16x12 --out a.png";
  ASSERT_EQ(shell(folder.path(), line).status, 0);
  EXPECT_EQ(text(folder / "a.png", "command"), line);
  EXPECT_EQ(text(folder / "a.png", "version") + "\n", limn({"--version"}).out);
}

TEST(Provenance, TheCommandInsideABenchsPictureGivesItAgain) {
  const TemporaryFolder folder;
  std::ofstream(folder / "suite.toml")
      << "name = 'signed'\nsizes = '33x25'\nframes = 1\nwarmup = 0\nterm = 'visibility'\npictures = true\n"
         "reference = {spp = 2}\n"
         "[[scenes]]\nscene = 'cornell_box'\nmax_masked_share = 0.5\nlights = ['#0']\n"
         "[[techniques]]\ntechnique = 'hard_shadow_map'\nparameters = {shadow_map_size = 64}\n";
  const Outcome outcome = limn({"bench", folder / "suite.toml", "--out", folder / "out"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto row = nlohmann::json::parse(contents(folder / "out/results.jsonl"));
  const fs::path picture = folder / "out" / row["picture"].get<std::string>();
  EXPECT_EQ(text(picture, "version") + "\n", limn({"--version"}).out);
  expectGivenAgain(picture.parent_path(), picture.filename());
}

}  // namespace
}  // namespace limn::test
