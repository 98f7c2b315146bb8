// A picture with values that are no numbers is no result.
#include <fstream>

#include "tests/cli/limn_program.h"
#include "tests/support/gltf_builder.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

TEST(NotFinite, PicturesAreRefusedAndNotWritten) {
  const TemporaryFolder folder;
  GltfBuilder builder;
  builder.triangle();
  // So close to the surface this is more than a float holds.
  builder.root["nodes"][0]["scale"] = {1e-6, 1e-6, 1e-6};
  builder.light({{"type", "point"}, {"intensity", 1e30}}, {{"translation", {3e-7, 3e-7, 1e-7}}});
  const std::vector<std::byte> bytes = builder.glb();
  const fs::path scene = folder / "blinding.glb", pictures = folder / "pictures";
  std::ofstream(scene, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  fs::create_directory(pictures);
  for (const char* name : {"a.png", "a.exr"}) {
    expectRefused(
        limn({"render", scene, "--size", "16x16", "--output-term", "direct", "--out", pictures / name}), 1,
        {name, "direct", "not finite", "of 256 pixels", "the first at"});
    EXPECT_TRUE(listing(pictures).empty()) << name;
  }
}

}  // namespace
}  // namespace limn::test
