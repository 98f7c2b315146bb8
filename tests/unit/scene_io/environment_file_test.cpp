// Environments from files: what is refused, what is clamped, and that what follows from them is finite.
#include <cmath>
#include <limits>

#include "core/image/image.h"
#include "core/scene/environment_light.h"
#include "core/shading/environment.h"
#include "core/shading/environment_decomposition.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class EnvironmentFile : public SceneFiles {
 protected:
  /// 16 x 8 pixels of 1, the first few of which are `values`.
  std::filesystem::path sky(const std::vector<float>& values) const {
    Image image = Image::rgb(16, 8);
    std::ranges::fill(image.data(), 1.f);
    for (std::size_t i = 0; i < values.size(); ++i) image.at(static_cast<int>(i), 2, 1) = values[i];
    writeExr(folder_ / "sky.exr", image);
    return folder_ / "sky.exr";
  }
  scene::Environment load(const std::filesystem::path& file) {
    warnings_.clear();
    return scene::loadEnvironment(file, warnings_);
  }
  std::string error(const std::filesystem::path& file) {
    try {
      load(file);
    } catch (const Error& thrown) {
      EXPECT_EQ(std::string(thrown.what()).find('\n'), std::string::npos);
      return thrown.what();
    }
    return {};
  }
  std::vector<std::string> warnings_;
};

TEST_F(EnvironmentFile, ThatIsNoneIsRefused) {
  EXPECT_THAT(error(write("sky.png", png(1, 1, {1, 2, 3, 4}))), HasSubstr("sky.png: an environment is"));
  EXPECT_THAT(error(write("sky.exr", GltfBuilder::toBytes("no picture"))),
              HasSubstr("sky.exr: not a picture"));
  EXPECT_THAT(error(sky({NAN})), HasSubstr("sky.exr: pixel (0, 2) is not a finite number"));
  EXPECT_THAT(error(sky({1, INFINITY})), HasSubstr("sky.exr: pixel (1, 2) is not a finite number"));
  writeExr(folder_ / "depth.exr", Image(2, 2, {"Z", "id"}));
  EXPECT_THAT(error(folder_ / "depth.exr"),
              AllOf(HasSubstr("depth.exr: no channels R, G, B"), HasSubstr("Z, id")));
}

TEST_F(EnvironmentFile, IsReadUnderANameInCapitals) {
  const std::filesystem::path capitals = folder_ / "SKY.EXR";
  std::filesystem::rename(sky({2}), capitals);
  EXPECT_EQ(load(capitals).texels[2 * 16].y, 2);
}

TEST_F(EnvironmentFile, IsToldByItsName) {
  for (const char* name : {"sky.hdr", "sky.exr", "SKY.HDR", "a/sky.Exr"})
    EXPECT_TRUE(scene::isEnvironmentFile(name)) << name;
  for (const char* name : {"sky.png", "hdr", ".hdr", "sky.hdr.png", ""})
    EXPECT_FALSE(scene::isEnvironmentFile(name)) << name;
}

TEST_F(EnvironmentFile, IsBlackWhereNoPixelShines) {
  EXPECT_TRUE(scene::isBlack({})) << "there is no map";
  scene::Environment e = load(sky({}));
  EXPECT_FALSE(scene::isBlack(e));
  e.scale = 0;
  EXPECT_TRUE(scene::isBlack(e));
  e.scale = 1;
  std::ranges::fill(e.texels, glm::vec3(0));
  EXPECT_TRUE(scene::isBlack(e));
  e.texels.back().z = 1e-6f;
  EXPECT_FALSE(scene::isBlack(e));
}

TEST_F(EnvironmentFile, WithinTheRangeIsTakenAsItIs) {
  const scene::Environment e = load(sky({0, 1e-30f, 65504, scene::kMostEnvironmentRadiance}));
  EXPECT_TRUE(warnings_.empty());
  EXPECT_EQ(e.texels[2 * 16 + 1].y, 1e-30f);
  EXPECT_EQ(e.texels[2 * 16 + 3].y, scene::kMostEnvironmentRadiance);
}

TEST_F(EnvironmentFile, OfRowsFromBelowIsTurned) {
  std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 2 +X 1\n";
  for (const int byte : {128, 0, 0, 129, 0, 0, 128, 129}) text += static_cast<char>(byte);  // red, blue
  const scene::Environment e = load(write("sky.hdr", GltfBuilder::toBytes(text)));
  EXPECT_THAT(e.texels, ElementsAre(glm::vec3(0, 0, 1), glm::vec3(1, 0, 0)));
}

TEST_F(EnvironmentFile, BeyondTheRangeIsClampedAndCounted) {
  const scene::Environment e = load(sky({-1, 3e38f, -1e-20f, std::numeric_limits<float>::max(), 5}));
  EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr("sky.exr: 4 of 128 pixels"), HasSubstr("1e+12"))));
  EXPECT_EQ(e.texels[2 * 16 + 0].y, 0);
  EXPECT_EQ(e.texels[2 * 16 + 1].y, scene::kMostEnvironmentRadiance);
  EXPECT_EQ(e.texels[2 * 16 + 2].y, 0);
  EXPECT_EQ(e.texels[2 * 16 + 4].y, 5);
}

TEST_F(EnvironmentFile, AsBrightAsItGetsGivesFiniteSums) {
  Image image = Image::rgb(16, 8);
  std::ranges::fill(image.data(), std::numeric_limits<float>::max());
  writeExr(folder_ / "sky.exr", image);
  scene::Environment e = load(folder_ / "sky.exr");
  ASSERT_EQ(warnings_.size(), 1u);
  e.scale = 1e9f;  // the largest that --environment-scale accepts

  const shading::FilteredEnvironment filtered = shading::filterEnvironment(e);
  for (const glm::vec3& texel : filtered.irradiance.texels)
    ASSERT_NEAR(e.scale * texel.x, M_PI * 1e21, 1e19);  // irradiance below uniform radiance L is pi L
  for (const auto& level : filtered.radiance)
    for (const glm::vec3& texel : level.texels) ASSERT_NEAR(e.scale * texel.y, 1e21, 1e19);

  double irradiance = 0;  // of all lights, at a right angle: 4 pi L
  for (const auto& light : shading::decomposeEnvironment(e, {.threshold = 0.1}).lights)
    irradiance += light.irradiance.z;
  EXPECT_NEAR(irradiance, 4 * M_PI * 1e12, 1e11);

  const scene::EnvironmentLight light(e);
  for (const glm::vec2 u : {glm::vec2(0.1f, 0.2f), glm::vec2(0.5f), glm::vec2(0.9f, 0.99f)}) {
    const glm::vec3 direction = light.sample(u);
    EXPECT_NEAR(glm::length(direction), 1, 1e-5);
    EXPECT_NEAR(light.radiance(direction).x, 1e21, 1e15);
    EXPECT_TRUE(std::isfinite(light.pdf(direction)) && light.pdf(direction) > 0);
    EXPECT_TRUE(std::isfinite(light.radiance(direction).x / light.pdf(direction)));
  }
}

}  // namespace
}  // namespace limn::test
