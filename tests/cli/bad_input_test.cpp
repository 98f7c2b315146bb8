// Files that are broken and places that cannot be written: one line, the exit status, and nothing left
// behind.
#include <sys/stat.h>

#include <limits>

#include "tests/cli/limn_program.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/png.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

class BadScene : public testing::Test {
 protected:
  BadScene() {
    fs::create_directory(scenes_);
    fs::create_directory(pictures_);
  }

  void write(const std::string& name, const std::vector<std::byte>& bytes) const {
    std::ofstream(scenes_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

  /// Both renderers refuse the file, naming it and `parts`.
  void expectScene(const std::string& name, std::vector<std::string> parts) const {
    SCOPED_TRACE(name);
    parts.push_back(name);
    for (const char* command : {"render", "reference"}) {
      expectRefused(limn({command, scenes_ / name, "--size", "8x8", "--out", pictures_ / "a.exr"}), 1, parts);
      EXPECT_TRUE(listing(pictures_).empty()) << command;
    }
  }

  void expectScene(const std::string& name, const GltfBuilder& builder,
                   const std::vector<std::string>& parts) const {
    write(name, builder.glb());
    expectScene(name, parts);
  }

  const TemporaryFolder folder_;
  const fs::path scenes_ = folder_ / "scenes", pictures_ = folder_ / "pictures";
};

GltfBuilder triangle() {
  GltfBuilder builder;
  builder.triangle();
  return builder;
}

GltfBuilder trianglePositions(float value) {
  GltfBuilder builder = triangle();
  builder.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      builder.vec3({{0, 0, 0}, {1, value, 0}, {0, 1, 0}});
  return builder;
}

TEST_F(BadScene, MissingOrCutOff) {
  expectScene("none.glb", {"does not exist"});
  const std::string whole = contents(kCornellBox);
  const std::string half = whole.substr(0, whole.size() / 2);
  write("cut.glb", GltfBuilder::toBytes(half));
  expectScene("cut.glb", {});
  write("empty.glb", {});
  expectScene("empty.glb", {"not a glTF 2.0 file"});
}

TEST_F(BadScene, Accessors) {
  GltfBuilder builder = triangle();
  builder.root["accessors"][0]["byteOffset"] = 4;
  expectScene("accessor.glb", builder, {"accessor 0", "do not fit"});
  builder = triangle();
  builder.root["accessors"][0]["count"] = 1'000'000'000;
  expectScene("billion.glb", builder, {"1000000000"});
  builder = triangle();
  builder.root["meshes"][0]["primitives"][0]["indices"] = builder.indices({0, 1, 3});
  expectScene("index.glb", builder, {"index 3", "there are 3"});
}

TEST_F(BadScene, PositionsThatAreNoNumbers) {
  expectScene("nan.glb", trianglePositions(std::numeric_limits<float>::quiet_NaN()), {"POSITION", "finite"});
  expectScene("infinite.glb", trianglePositions(std::numeric_limits<float>::infinity()),
              {"POSITION", "finite"});
}

TEST_F(BadScene, NodesInACircle) {
  GltfBuilder builder;
  builder.node({{"name", "a"}, {"children", {1}}});
  builder.node({{"name", "b"}, {"children", {0}}});
  expectScene("cycle.glb", builder, {"cycle", "node 0 'a'"});
}

TEST_F(BadScene, GridThatIsNone) {
  write("cloud.vdb", GltfBuilder::toBytes("no volume"));
  GltfBuilder builder = triangle();
  builder.append("scenes",
                 {{"nodes", {0}}, {"extras", {{"limn_medium", {{"sigma_s", 1}, {"grid", "cloud.vdb"}}}}}});
  expectScene("grid.glb", builder, {"cloud.vdb", "not an OpenVDB file"});
}

TEST_F(BadScene, TextureOutsideTheSceneFolder) {
  write("../secret.png", png(1, 1, {1, 2, 3, 4}));
  GltfBuilder builder;
  builder.append("images", {{"uri", "../secret.png"}});
  builder.append("textures", {{"source", 0}});
  builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  expectScene("escape.glb", builder, {"../secret.png", "outside the scene's folder"});
}

class BadOutput : public testing::Test {
 protected:
  /// `limn render` and `limn reference` of a small picture.
  static Outcome write(const std::string& command, const std::string& out, rlim_t fileSizeLimit = 0) {
    return limn({command, kCornellBox, "--size", "64x64", "--out", out}, {}, fileSizeLimit);
  }
  const TemporaryFolder folder_;
};

TEST_F(BadOutput, PlacesThatCannotBeWritten) {
  fs::create_directory(folder_ / "folder.exr");
  std::ofstream(folder_ / "file") << "no folder";
  for (const char* command : {"render", "reference"}) {
    expectRefused(write(command, folder_ / "none/a.exr"), 1, {"none/a.exr", "cannot be written"});
    expectRefused(write(command, folder_ / "file/a.exr"), 1, {"file/a.exr", "cannot be written"});
    expectRefused(write(command, folder_ / "folder.exr"), 1, {"folder.exr", "cannot be written"});
    expectRefused(write(command, folder_ / "a.bmp"), 2, {"a.bmp", ".png"});
  }
  EXPECT_EQ(listing(folder_.path()), (std::vector<std::string>{"file", "folder.exr"}));
}

TEST_F(BadOutput, DevicesAndPipesStayWhatTheyAre) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expectRefused(limn({"render", kCornellBox, "--size", "8x8", "--out", folder_ / "a.exr", "--stats", pipe}),
                1, {"pipe", "cannot be written"});
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(listing(folder_.path()).size(), 1u);
}

/// What is read would be lost, or one of two results.
TEST_F(BadOutput, NoFileIsWrittenTwiceOrReadAsWell) {
  const fs::path picture = folder_ / "a.png", map = folder_ / "map.exr", grid = folder_ / "cloud.vdb",
                 rows = folder_ / "results.jsonl", claims = folder_ / "a.claims";
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& name) {
    expectRefused(limn(arguments), 2, {name, "another argument names the same file"});
  };
  ASSERT_EQ(write("render", map).status, 0);
  const std::string before = contents(map);
  refused({"render", kCornellBox, "--out", picture, "--stats", folder_ / "./a.png"}, "a.png");
  EXPECT_FALSE(fs::exists(picture));
  refused({"render", kCornellBox, "--environment", map, "--out", map}, "map.exr");
  refused({"reference", kCornellBox, "--environment", map, "--out", map}, "map.exr");
  refused({"reference", kCornellBox, "--grid", map, "--out", map}, "map.exr");
  refused({"environment", map, "--overlay", map}, "map.exr");
  ASSERT_EQ(write("render", picture).status, 0);
  refused({"compare", picture, map, "--diff", picture}, "a.png");
  refused({"render", kCornellBox, "--grid", grid, "--out", picture, "--stats", grid}, "cloud.vdb");
  refused({"explain-cost", kCornellBox, "--grid", grid, "--json", grid}, "cloud.vdb");
  for (const fs::path& file : {rows, claims})
    refused({"reproduction", folder_.path(), "--claims", claims, "--out", file}, file.filename());
  EXPECT_EQ(contents(map), before);
}

/// A scene's pictures lie beside it, where those that are rendered of it may be wanted.
TEST_F(BadOutput, WhatASceneReadsStays) {
  GltfBuilder builder;
  builder.append("images", {{"uri", "bricks.png"}});
  builder.append("textures", {{"source", 0}});
  builder.triangle(
      builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}));
  const std::vector<std::byte> scene = builder.glb(), bricks = png(1, 1, {1, 2, 3, 4});
  const auto put = [&](const char* name, const std::vector<std::byte>& bytes) {
    std::ofstream(folder_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  };
  put("wall.glb", scene);
  put("bricks.png", bricks);
  const std::string before = contents(folder_ / "bricks.png");
  for (const char* command : {"render", "reference"})
    expectRefused(limn({command, folder_ / "wall.glb", "--size", "8x8", "--out", folder_ / "./bricks.png"}),
                  2, {"bricks.png", "another argument names the same file"});
  EXPECT_EQ(contents(folder_ / "bricks.png"), before);
}

TEST_F(BadOutput, NoFrameTakesThePlaceOfAnotherFile) {
  const fs::path map = folder_ / "sky.0002.exr", stats = folder_ / "a.0001.png";
  ASSERT_EQ(write("render", map).status, 0);
  const std::string before = contents(map);
  const auto frames = [&](const char* range, const char* out, const std::vector<std::string>& more) {
    std::vector<std::string> all{"render",   kCornellBox, "--size", "8x8",
                                 "--frames", range,       "--out",  folder_ / out};
    all.insert(all.end(), more.begin(), more.end());
    return limn(all);
  };
  expectRefused(frames("3", "sky.exr", {"--environment", map}), 2,
                {"sky.0002.exr", "another argument names the same file"});
  expectRefused(frames("1:1", "a.png", {"--stats", stats}), 2, {"a.0001.png", "the same file"});
  EXPECT_EQ(listing(folder_.path()), std::vector<std::string>{"sky.0002.exr"});
  EXPECT_EQ(contents(map), before);
  EXPECT_EQ(frames("0:1", "a.png", {"--stats", folder_ / "a.0002.png"}).status, 0) << "not one of them";
}

/// As where a command was killed while it wrote: nobody else would look for it.
TEST_F(BadOutput, WhatAKilledCommandLeftGoesWithTheNextOne) {
  for (const char* name : {".a.exr.0123456789abcdef.part", ".mine.part"}) std::ofstream(folder_ / name) << 1;
  ASSERT_EQ(write("render", folder_ / "a.png").status, 0);
  EXPECT_EQ(listing(folder_.path()), (std::vector<std::string>{".mine.part", "a.png"}));
}

TEST_F(BadOutput, FullDisk) {
  for (const char* name : {"a.exr", "a.png"}) {
    expectRefused(write("render", folder_ / name, 100), 1, {name, "cannot be written"});
    EXPECT_TRUE(listing(folder_.path()).empty());
  }
  std::ofstream(folder_ / "a.exr") << "former";  // what was there stays
  expectRefused(write("render", folder_ / "a.exr", 100), 1, {"a.exr"});
  EXPECT_EQ(contents(folder_ / "a.exr"), "former");
  EXPECT_EQ(listing(folder_.path()).size(), 1u);
}

TEST_F(BadOutput, FullStandardOutput) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  for (const char* arguments : {"list", "completion", "--help", "render --help"}) {
    SCOPED_TRACE(arguments);
    const Outcome outcome = run({"/bin/sh", "-c", "exec " + kLimnBinary + " " + arguments + " > /dev/full"});
    expectRefused(outcome, 1, {"standard output"});
  }
}

/// Nor is another file opened in its place.
TEST_F(BadOutput, ClosedStandardOutput) {
  const Outcome list = run({"/bin/sh", "-c", "exec " + kLimnBinary + " list >&-"});
  expectRefused(list, 1, {"standard output"});
  EXPECT_EQ(list.out, "");
  const std::string picture = folder_ / "a.png";
  const Outcome all = run(
      {"/bin/sh", "-c",
       "exec " + kLimnBinary + " render " + kCornellBox + " --size 8x8 --out " + picture + " <&- >&- 2>&-"});
  EXPECT_EQ(all.status, 0);
  EXPECT_EQ(contents(picture).substr(1, 3), "PNG");
}

TEST_F(BadOutput, AFileThatMayNotGrowEndsNoProgram) {
  for (const char* name : {"limn", "limn-view", "ch7-variance-soft-shadows"}) {
    const Outcome outcome = run({std::string(kBinaryDir) + "/bin/" + name, "--help"}, {}, 100);
    EXPECT_NE(outcome.status, -1) << name << " died of a signal";
    EXPECT_EQ(outcome.out.size(), 100u) << name;
  }
}

TEST_F(BadOutput, FullDiskDuringABench) {
  std::ofstream(folder_ / "suite.toml")
      << "name = 'full'\nsizes = ['32x20']\nframes = 1\nwarmup = 0\nreference = {spp = 2}\n"
         "[[scenes]]\nscene = '"
      << kCornellBox
      << "'\n"
         "max_masked_share = 0.05\n[[techniques]]\ntechnique = 'hard_shadow_map'\n";
  const Outcome outcome = limn({"bench", folder_ / "suite.toml", "--out", folder_ / "out"}, {}, 2000);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, testing::HasSubstr("cannot be written"));
  const std::string rows = contents(folder_ / "out/results.jsonl");
  EXPECT_TRUE(rows.empty() || rows.back() == '\n') << "half a row: " << rows;
}

}  // namespace
}  // namespace limn::test
