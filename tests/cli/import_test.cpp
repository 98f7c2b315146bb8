// Models of other formats through assimp; what needs it is skipped where it is not installed.
#include "tests/cli/limn_program.h"
#include "tests/support/png.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kObject = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n";

constexpr const char* kCollada =
    R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_lights><light id="L"><technique_common><point><color>1 1 1</color></point></technique_common></light>
</library_lights><library_geometries><geometry id="G"><mesh><source id="P"><float_array id="A" count="9">
0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#A" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="V"><input semantic="POSITION" source="#P"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#V" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="S"><node id="n"><instance_geometry url="#G"/></node>
<node id="l"><instance_light url="#L"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#S"/></scene></COLLADA>)";

class ImportTest : public testing::Test {
 protected:
  fs::path model(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name) << content;
    return folder_ / name;
  }

  const TemporaryFolder folder_;
};

class AssimpTest : public ImportTest {
 protected:
  void SetUp() override {
    if (run({"/bin/sh", "-c", "command -v assimp"}).status != 0) GTEST_SKIP() << "assimp is not installed";
  }
};

TEST_F(AssimpTest, WritesASceneThatRenders) {
  const Outcome outcome = limn({"import", model("a.obj", kObject)});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("a.glb: 4 triangles"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("1 x 2 x 3 m; nothing that is counted was lost"));
  const Outcome rendered = limn({"render", folder_ / "a.glb", "--size", "16x12", "--out", folder_ / "a.png"});
  EXPECT_EQ(rendered.status, 0) << rendered.err;
  EXPECT_EQ(listing(folder_.path()), (std::vector<std::string>{"a.glb", "a.obj", "a.png"}));
  expectRefused(limn({"import", folder_ / "a.obj"}), 2, {"a.glb is there already", "--out"});
}

TEST_F(AssimpTest, SaysWhatWasLost) {
  const Outcome outcome = limn({"import", model("a.dae", kCollada), "--out", folder_ / "b.glb"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("b.glb: 1 triangles"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("lost: 1 of 1 lights"));
}

TEST_F(AssimpTest, CountsTexturesThatWereLost) {
  const std::vector<std::byte> pixel = png(1, 1, {1, 2, 3, 255});
  model("pixel.png", {reinterpret_cast<const char*>(pixel.data()), pixel.size()});
  // glTF has no place for a map of heights.
  model("a.mtl", "newmtl m\nmap_Kd pixel.png\nmap_Bump pixel.tga\nnewmtl n\nmap_Kd missing.png\n");
  const Outcome outcome = limn({"import", model("a.obj",
                                                "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nvt 0 0\n"
                                                "usemtl m\nf 1/1 2/1 3/1\nusemtl n\nf 1/1 3/1 4/1\n")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("lost: 2 of 3 textures\n"));
}

TEST_F(AssimpTest, CountsSecondSetsOfVertexAttributes) {
  std::string collada = kCollada;
  const auto insert = [&](const std::string& before, const std::string& what) {
    collada.insert(collada.find(before), what);
  };
  insert("<vertices", R"(<source id="T"><float_array id="B" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#B" count="3" stride="3"><param name="R" type="float"/>
<param name="G" type="float"/><param name="B" type="float"/></accessor></technique_common></source>)");
  for (const std::string set : {"0", "1"})
    for (const std::string kind : {"TEXCOORD", "COLOR"})
      insert("<p>", "<input semantic=\"" + kind + "\" source=\"#T\" offset=\"0\" set=\"" + set + "\"/>");
  const Outcome outcome = limn({"import", model("a.dae", collada)});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("lost: 1 of 1 lights, 1 of 2 sets of texture coordinates and "
                                              "1 of 2 sets of vertex colours\n"));
}

TEST_F(AssimpTest, NothingIsLeftOfWhatCannotBeRead) {
  expectRefused(limn({"import", model("a.obj", "nonsense")}), 1, {"a.obj"});
  expectRefused(limn({"import", model("a.fbx", "nonsense")}), 1, {"a.fbx"});
  EXPECT_EQ(listing(folder_.path()), (std::vector<std::string>{"a.fbx", "a.obj"}));
}

/// In the place of assimp a program that writes half a file and then waits for ever.
class SlowImportTest : public ImportTest {
 protected:
  SlowImportTest() {
    const fs::path converter = programs_ / "assimp";
    std::ofstream(converter) << "#!/bin/sh\n[ \"$1\" = info ] && exit\necho half > \"$3\"\necho $$ > "
                             << begun_.string() << "\nexec sleep 300\n";
    fs::permissions(converter, fs::perms::owner_all);
  }

  /// Ends an import by a signal when half a file is there.
  Outcome endedBy(int signal) {
    fs::remove(begun_);
    Process process({kLimnBinary, "import", file_}, {{"PATH", programs_.path().string() + ":/usr/bin:/bin"}});
    EXPECT_TRUE(process.waitUntil([&] { return contents(begun_).ends_with('\n'); })) << process.err();
    process.signal(signal);
    Outcome outcome = process.wait();
    converting_ = std::stoi(contents(begun_));
    return outcome;
  }

  const TemporaryFolder programs_;
  const fs::path begun_ = programs_ / "begun", file_ = model("a.obj", kObject);
  pid_t converting_ = 0;
};

/// Neither the program that converts nor what it has half-written is left.
TEST_F(SlowImportTest, NothingIsLeftAfterAnInterruption) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Outcome outcome = endedBy(signal);
    EXPECT_EQ(outcome.status, 128 + signal);
    EXPECT_EQ(outcome.err, "limn: interrupted; no scene was written\n");
    EXPECT_EQ(kill(converting_, 0), -1) << "assimp goes on";
    EXPECT_EQ(listing(folder_.path()), std::vector<std::string>{"a.obj"});
  }
}

/// What a killed import left goes with the next one.
TEST_F(SlowImportTest, TheNextImportRemovesWhatAKilledOneLeft) {
  endedBy(SIGKILL);
  kill(converting_, SIGKILL);
  EXPECT_EQ(listing(folder_.path()).size(), 2u) << "half a file";
  endedBy(SIGINT);
  EXPECT_EQ(listing(folder_.path()), std::vector<std::string>{"a.obj"});
}

/// In the place of assimp a program that makes of an animation one that moves nothing, as assimp does of
/// those of morph targets.
TEST_F(ImportTest, AnimationsThatMoveNothingAreLost) {
  GltfBuilder b;
  b.triangle();
  b.append("animations",
           {{"samplers", GltfBuilder::json::array()}, {"channels", GltfBuilder::json::array()}});
  const std::vector<std::byte> glb = b.glb();
  const fs::path made = model("made", {reinterpret_cast<const char*>(glb.data()), glb.size()});
  const TemporaryFolder programs;
  const fs::path converter = programs / "assimp";
  std::ofstream(converter)
      << "#!/bin/sh\n[ \"$1\" = info ] && printf 'Model:\\nAnimations: 1\\n' && exit\ncp " << made.string()
      << " \"$3\"\n";
  fs::permissions(converter, fs::perms::owner_all);
  const Outcome outcome = run({kLimnBinary, "import", model("a.obj", kObject)},
                              {{"PATH", programs.path().string() + ":/usr/bin:/bin"}});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("0 animations"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("lost: 1 of 1 animations\n"));
}

TEST_F(ImportTest, RefusesInOneLine) {
  expectRefused(limn({"import", folder_ / "no.obj"}), 2, {"no.obj", "no such file"});
  const fs::path file = model("a.obj", kObject);
  expectRefused(limn({"import", file, "--out", folder_ / "a.png"}), 2, {"a.png", ".glb"});
  expectRefused(run({kLimnBinary, "import", file}, {{"PATH", folder_.path()}}), 1,
                {"assimp", "apt-get install assimp-utils"});
  EXPECT_EQ(listing(folder_.path()), std::vector<std::string>{"a.obj"});
  const fs::path own = model("b.glb", kObject);
  expectRefused(limn({"import", own, "--out", own}), 2, {"b.glb", "another argument names the same file"});
}

}  // namespace
}  // namespace limn::test
