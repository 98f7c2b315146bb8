// Files that are missing, unreadable or outside the scene's folder end in one line that names them.
#include <string>
#include <utility>
#include <vector>

#include "tests/support/address_limit.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class SceneBadFile : public SceneFiles {};

TEST_F(SceneBadFile, MissingFile) {
  EXPECT_THAT(loadError(folder_ / "nothing.glb"), HasSubstr("nothing.glb"));
}

TEST_F(SceneBadFile, FolderInsteadOfFile) {
  EXPECT_THAT(loadError(folder_), HasSubstr(folder_.string()));
}

TEST_F(SceneBadFile, MessageNamesTheFile) {
  EXPECT_THAT(loadError(write("scene/broken.gltf", GltfBuilder::toBytes("{"))),
              AllOf(HasSubstr("broken.gltf"), HasSubstr("not valid JSON")));
}

GltfBuilder namingTexture(const std::string& uri) {
  GltfBuilder b;
  b.append("images", {{"uri", uri}});
  b.append("textures", {{"source", 0}});
  b.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  return b;
}

TEST_F(SceneBadFile, TextureOutsideTheFolder) {
  write("secret.png", png(1, 1, {1, 2, 3, 4}));
  const std::string escapes[] = {"../secret.png", "%2e%2e/secret.png", "x/../../secret.png",
                                 (folder_ / "secret.png").string(),
                                 "file://" + (folder_ / "secret.png").string()};
  for (const std::string& uri : escapes) {
    const std::string message = loadError(write("scene/a.glb", namingTexture(uri).glb()));
    EXPECT_THAT(message, HasSubstr("image 0")) << uri;
    EXPECT_THAT(message,
                testing::AnyOf(HasSubstr("outside the scene's folder"), HasSubstr("not a file name")))
        << uri;
  }
}

TEST_F(SceneBadFile, TextureThroughASymbolicLink) {
  write("secret.png", png(1, 1, {1, 2, 3, 4}));
  std::filesystem::create_symlink(folder_ / "secret.png", folder_ / "scene" / "link.png");
  EXPECT_THAT(loadError(write("scene/a.glb", namingTexture("link.png").glb())),
              HasSubstr("outside the scene's folder"));
  std::filesystem::create_directory_symlink(folder_, folder_ / "scene" / "up");
  EXPECT_THAT(loadError(write("scene/b.glb", namingTexture("up/secret.png").glb())),
              HasSubstr("outside the scene's folder"));
}

TEST_F(SceneBadFile, BufferOutsideTheFolder) {
  write("secret.bin", std::vector<std::byte>(16));
  GltfBuilder b;
  b.root["buffers"] = {{{"byteLength", 16}, {"uri", "../secret.bin"}}};
  EXPECT_THAT(loadError(write("scene/a.gltf", b.text())),
              AllOf(HasSubstr("buffer 0"), HasSubstr("outside the scene's folder")));
}

#if !defined(LIMN_SANITIZED)  // whose shadow memory takes terabytes of addresses
/// A document of some kilobytes is no licence to take 32 GiB.
TEST_F(SceneBadFile, AFileThatManyBuffersNameIsReadOnce) {
  std::filesystem::resize_file(write("scene/a.bin", {}), std::uintmax_t{64} << 20);
  GltfBuilder b;
  for (int i = 0; i < 512; ++i)
    b.append("buffers", {{"byteLength", 16}, {"uri", i % 2 == 0 ? "a.bin" : "./a%2ebin"}});
  const std::filesystem::path file = write("scene/a.gltf", b.text());
  const AddressLimit limit(rlim_t{4} << 30);
  EXPECT_EQ(loadError(file), "");
}

/// tinygltf copies them.
TEST_F(SceneBadFile, ExtensionsOfAnAnimationAreNotHeldForEachOfItsSamplers) {
  GltfBuilder b;
  nlohmann::json animation = {
      {"channels", nlohmann::json::array()},
      {"extensions", {{"EXT_unknown", {{"text", std::string(std::size_t{1} << 20, 'a')}}}}}};
  for (int i = 0; i < 4096; ++i) animation["samplers"].push_back(nlohmann::json{{"input", 0}, {"output", 0}});
  b.append("animations", std::move(animation));
  const std::vector<std::byte> bytes = b.glb();
  const AddressLimit limit(rlim_t{1} << 30);
  EXPECT_EQ(loadError(bytes), "");
}
#endif

TEST_F(SceneBadFile, TextureMissing) {
  const scene::Scene loaded = scene::load(write("scene/a.glb", namingTexture("gone.png").glb()));
  EXPECT_THAT(loaded.warnings,
              testing::ElementsAre(AllOf(HasSubstr("image 0 (gone.png)"), HasSubstr("no such file"),
                                         HasSubstr("material 0 baseColorTexture goes without it"))));
}

/// A picture that cannot be read is named and left out; what it was for keeps its factors.
TEST_F(SceneBadFile, UnreadableTexturesAreNamedAndLeftOut) {
  std::vector<std::byte> damaged = png(2, 2, std::vector<std::uint8_t>(16));
  damaged[50] ^= std::byte{1};
  const std::pair<std::vector<std::byte>, const char*> pictures[] = {
      {{}, "it is empty"}, {GltfBuilder::toBytes("GIF89a........"), "not a picture"}, {damaged, "bad.png"}};
  for (const auto& [bytes, cause] : pictures) {
    write("scene/good.png", png(1, 1, {1, 2, 3, 4}));
    write("scene/bad.png", bytes);
    GltfBuilder b = namingTexture("good.png");
    b.append("images", {{"uri", "bad.png"}});
    b.append("textures", {{"source", 1}});
    b.append("materials", {{"emissiveFactor", {0.5, 0.25, 0.125}},
                           {"emissiveTexture", {{"index", 1}}},
                           {"pbrMetallicRoughness",
                            {{"baseColorTexture", {{"index", 1}}}, {"baseColorFactor", {1, 0, 0, 1}}}}});
    b.triangle(1);
    const scene::Scene loaded = scene::load(write("scene/a.glb", b.glb()));
    EXPECT_THAT(loaded.warnings,
                testing::Contains(AllOf(HasSubstr("image 1 (bad.png): "), HasSubstr(cause),
                                        HasSubstr("material 1 baseColorTexture goes without it"))));
    EXPECT_EQ(loaded.images.size(), 1u);
    EXPECT_EQ(loaded.materials.at(1).baseColourTexture.image, scene::kNone);
    EXPECT_EQ(loaded.materials.at(1).emissiveTexture.image, scene::kNone);
    EXPECT_EQ(loaded.materials.at(1).baseColour, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(loaded.materials.at(1).emission, glm::vec3(0.5f, 0.25f, 0.125f));
  }
}

TEST_F(SceneBadFile, TextureInsideTheFolderLoads) {
  write("scene/in side.png", png(1, 1, {1, 2, 3, 4}));
  EXPECT_EQ(loadError(write("scene/a.glb", namingTexture("in%20side.png").glb())), "");
}

TEST_F(SceneBadFile, EnvironmentOutsideTheFolder) {
  GltfBuilder b;
  b.append("scenes", {{"extras", {{"limn_environment", "../sky.exr"}}}});
  EXPECT_THAT(loadError(write("scene/a.glb", b.glb())),
              AllOf(HasSubstr("limn_environment"), HasSubstr("outside the scene's folder")));
}

}  // namespace
}  // namespace limn::test
