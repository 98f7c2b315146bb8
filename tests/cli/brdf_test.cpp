// limn brdf: what a BRDF is like, a measured one made by simulation, and what factorisations make of it.
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/cli/limn_program.h"
#include "tests/support/glb.h"

namespace limn::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class BrdfCommand : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// A file of simulated grooves that are nearly flat: Lambertian, with the mean albedo of the walls.
  std::string flat(const std::string& size = "6") {
    const Outcome outcome = limn({"brdf", "simulate", path("flat.bsdf"), "--slope", "0.1", "--rising", "0.2",
                                  "--falling", "0.6,0.4,0.2", "--strips", "4", "--size", size, "--float32"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return path("flat.bsdf");
  }

  /// The JSON that a command prints.
  static json printed(std::vector<std::string> command) {
    command.insert(command.begin(), "brdf");
    command.emplace_back("--json");
    const Outcome outcome = limn(command);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out);
  }

  TemporaryFolder folder_;
};

TEST_F(BrdfCommand, SimulatedGroovesAreMeasuredData) {
  const json info = printed({"info", flat(), "--picture", path("lobes.png")});
  EXPECT_EQ(info["nodes"], json({6, 6, 6, 6}));
  EXPECT_EQ(info["bytes"], 6 * 6 * 6 * 6 * 12);
  EXPECT_EQ(info["isotropic"], false);
  EXPECT_LT(info["reciprocity_defect"].get<double>(), 1e-6);
  EXPECT_NEAR(info["largest"].get<double>(), 0.4 / std::numbers::pi, 0.01);
  ASSERT_EQ(info["albedo"].size(), 6u);
  // At 80 degrees from the side a wall tilted by 0.1 degrees is seen 1 % more of than the other.
  for (const json& row : info["albedo"]) {
    EXPECT_NEAR(row["albedo"][0].get<double>(), 0.4, 5e-3) << row;
    EXPECT_NEAR(row["albedo"][1].get<double>(), 0.3, 5e-3) << row;
    EXPECT_NEAR(row["albedo"][2].get<double>(), 0.2, 5e-3) << row;
  }
  EXPECT_GT(std::filesystem::file_size(path("lobes.png")), 1000u);

  const json fits = printed({"fit", flat(), "--fit", "dfg", "--texels", "16"})["fits"];
  ASSERT_EQ(fits.size(), 1u);
  EXPECT_LT(fits[0]["error"].get<double>(), 0.01);
  EXPECT_EQ(fits[0]["bytes"], 16 * 3 * 3 * 2);
}

TEST_F(BrdfCommand, MerlFilesAreRead) {
  {
    // 0.6, 0.3 and 0.1 over pi at all nodes, in the units of the database.
    std::ofstream out(path("paint.binary"), std::ios::binary);
    const std::int32_t header[] = {90, 90, 180};
    out.write(reinterpret_cast<const char*>(header), sizeof header);
    for (const double scaled : {0.6, 0.3 / 1.15, 0.1 / 1.66}) {
      const std::vector<double> plane(90 * 90 * 180, scaled * 1500 / std::numbers::pi);
      out.write(reinterpret_cast<const char*>(plane.data()),
                static_cast<std::streamsize>(plane.size() * sizeof(double)));
    }
  }
  const json info = printed({"info", path("paint.binary")});
  EXPECT_EQ(info["nodes"], json({90, 90, 180}));
  ASSERT_EQ(info["albedo"].size(), 3u);
  for (const json& row : info["albedo"]) {
    EXPECT_NEAR(row["albedo"][0].get<double>(), 0.6, 2e-3);
    EXPECT_NEAR(row["albedo"][2].get<double>(), 0.1, 2e-3);
  }
}

TEST_F(BrdfCommand, FitsOfModels) {
  const json metal = printed({"fit", "metal:0.3", "--fit", "dfg"});
  EXPECT_EQ(metal["source"], "metal:0.3");
  EXPECT_LE(metal["fits"][0]["error"].get<double>(), 0.01);
  EXPECT_LE(metal["fits"][0]["albedo_deviation"].get<double>(), 0.015);
  EXPECT_EQ(metal["fits"][0]["bytes"], 1152);

  const auto plastic = [](std::vector<std::string> more) {
    std::vector<std::string> all{"fit", "plastic:0.15", "--fit", "pqp", "--texels", "32", "--no-refine"};
    all.insert(all.end(), more.begin(), more.end());
    return printed(all)["fits"][0];
  };
  const json floor = plastic({}), none = plastic({"--no-floor"}), wide = plastic({"--format", "float32"});
  EXPECT_GT(none["error"].get<double>(), 2 * floor["error"].get<double>());
  EXPECT_EQ(wide["bytes"].get<int>(), 2 * floor["bytes"].get<int>());

  // Every kind, in few texels.
  const Outcome all = limn({"brdf", "fit", "metal:0.5", "--texels", "8"});
  ASSERT_EQ(all.status, 0) << all.err;
  for (const char* name : {"dfg 8 ", "baked 8 x 8", "pqp 8 ", "pqp 8 x 8, warped", "pqp 8 x 8 ",
                           "dfg 8 x 8, warped", "1 term", "4 terms", "trilinear 8 x 4 x 4", "deviation"})
    EXPECT_THAT(all.out, HasSubstr(name));
}

/// Sums of products: each kind among all has as many as it takes, and a kind by itself refuses more.
TEST_F(BrdfCommand, FitsOfMoreProductsThanTheyTake) {
  const Outcome all =
      limn({"brdf", "fit", "metal:0.5", "--texels", "8", "--terms", "3", "--no-floor", "--no-refine"});
  ASSERT_EQ(all.status, 0) << all.err;
  for (const char* name : {"dfg 8, 2 terms", "pqp 8 x 8, warped, 2 terms", "svd 8 x 8, 3 terms"})
    EXPECT_THAT(all.out, HasSubstr(name));
  expectRefused(limn({"brdf", "fit", "metal:0.5", "--fit", "dfg", "--terms", "3"}), 2,
                {"--terms 3", "--fit dfg", "1 to 2"});
  expectRefused(limn({"brdf", "fit", "metal:0.5", "--fit", "trilinear", "--terms", "2"}), 2,
                {"--terms 2", "--fit trilinear", "takes 1"});
}

/// svd among all kinds has as many as it takes, and says so.
TEST_F(BrdfCommand, FitsOfMoreTexelsThanSvdTakes) {
  const Outcome all =
      limn({"brdf", "fit", "metal:0.5", "--texels", "49", "--terms", "1", "--no-floor", "--no-refine"});
  ASSERT_EQ(all.status, 0) << all.err;
  for (const char* name : {"dfg 49 ", "pqp 49 x 49", "svd 48 x 48, 1 term", "trilinear 49 x "})
    EXPECT_THAT(all.out, HasSubstr(name));
}

TEST_F(BrdfCommand, MaterialsOfScenes) {
  const json brushed = printed({"info", "--scene", "disk_and_sphere", "--material", "brushed"});
  EXPECT_EQ(brushed["isotropic"], false);
  EXPECT_EQ(brushed["nodes"], json::array());
  EXPECT_NE(brushed["albedo"][1], brushed["albedo"][4]) << "along the scratches and across them";
  const json floor = printed({"info", "--scene", "disk_and_sphere", "--material", "floor"});
  EXPECT_EQ(floor["isotropic"], true);
  expectRefused(limn({"brdf", "info", "--scene", "disk_and_sphere", "--material", "brush"}), 2,
                {"no material 'brush'", "brushed"});
  expectRefused(limn({"brdf", "info", "--scene", "disk_and_sphere"}), 2, {"--material"});
  expectRefused(limn({"brdf", "fit", "--scene", "no_scene", "--material", "floor"}), 1, {"no_scene"});

  // A measured one is what its file alone is.
  const std::filesystem::path file = kAssets / "teapot_groove" / "grooves.bsdf";
  const auto error = [](std::vector<std::string> source) {
    source.insert(source.begin(), "fit");
    source.insert(source.end(), {"--fit", "svd", "--texels", "8"});
    return printed(source)["fits"][0]["error"].get<double>();
  };
  const double ofFile = error({file.string()});
  EXPECT_GT(ofFile, 0);
  EXPECT_NEAR(error({"--scene", "teapot_groove", "--material", "grooves"}), ofFile, 1e-6);
}

TEST_F(BrdfCommand, WrongUsageIsOneLine) {
  expectRefused(limn({"brdf"}), 2, {"info, simulate or fit"});
  expectRefused(limn({"brdf", "inof"}), 2, {"inof"});
  expectRefused(limn({"brdf", "info"}), 2, {"source", "--scene"});
  expectRefused(limn({"brdf", "info", "metal:2"}), 2, {"metal:2", "0.001 to 1"});
  expectRefused(limn({"brdf", "info", "metl"}), 2, {"'metl'", "metal:ALPHA"});
  expectRefused(limn({"brdf", "info", "groove", "--picture", "lobes.jpg"}), 2, {"lobes.jpg", ".png"});
  expectRefused(limn({"brdf", "fit", "groove", "--fit", "dgf"}), 2, {"'dgf'", "did you mean dfg", "svd"});
  expectRefused(limn({"brdf", "fit", "groove", "--format", "byte"}), 2, {"'byte'", "half"});
  expectRefused(limn({"brdf", "fit", "groove", "--texels", "1"}), 2, {"--texels", "2"});
  expectRefused(limn({"brdf", "fit", "groove", "--fit", "svd", "--texels", "60"}), 2, {"60", "48"});
  // Before the source is read.
  expectRefused(limn({"brdf", "fit", path("none.bsdf"), "--fit", "svd", "--texels", "49"}), 2,
                {"--texels 49", "--fit svd", "48"});
  for (const auto& [kind, flag] : {std::pair("dfg", "--no-warp"),
                                   {"pqp", "--no-warp"},
                                   {"svd", "--no-warp"},
                                   {"svd", "--no-refine"},
                                   {"trilinear", "--no-floor"}})
    expectRefused(limn({"brdf", "fit", "metal:0.5", "--fit", kind, flag}), 2,
                  {flag, kind, "does not change"});
  expectRefused(limn({"brdf", "simulate", "groove.png"}), 2, {"groove.png", ".bsdf"});
  for (const char* colour : {"1,2", "0.1,0.2,0.3,", "1.5", "red", "", "-0.1"})
    expectRefused(limn({"brdf", "simulate", path("a.bsdf"), "--rising", colour}), 2,
                  {"--rising", "red,green,blue"});
  expectRefused(limn({"brdf", "simulate", path("a.bsdf"), "--slope", "90"}), 2, {"--slope"});
  expectRefused(limn({"brdf", "simulate", path("a.bsdf"), "--size", "49"}), 2, {"--size", "48"});
  EXPECT_TRUE(listing(folder_.path()).empty());
}

TEST_F(BrdfCommand, BrokenFilesAndPlacesEndInOneLine) {
  expectRefused(limn({"brdf", "info", path("none.bsdf")}), 1, {"none.bsdf"});
  expectRefused(limn({"brdf", "simulate", path("none") + "/a.bsdf"}), 1, {"a.bsdf"});
  const std::string good = contents(flat("2"));
  const auto refused = [&](const std::string& bytes, const std::string& part) {
    std::ofstream(path("broken.bsdf"), std::ios::binary) << bytes;
    for (const char* command : {"info", "fit"})
      expectRefused(limn({"brdf", command, path("broken.bsdf")}), 1, {"broken.bsdf: ", part});
  };
  const auto with = [&](float value) {
    std::string bytes = good;
    bytes.replace(bytes.size() - sizeof value, sizeof value, reinterpret_cast<const char*>(&value),
                  sizeof value);
    return bytes;
  };
  refused("", "tensor_file");
  refused(good.substr(0, good.size() - 1), "lies beyond");
  refused(good.substr(0, 30), "ends within its table");
  refused(with(-1), "holds -1");
  refused(with(std::numeric_limits<float>::quiet_NaN()), "nan");
  std::string renamed = good;
  renamed.replace(renamed.find("disc_pairs"), 10, "disc_pears");
  refused(renamed, "without the array");
  std::ofstream(path("broken.binary"), std::ios::binary) << good;
  EXPECT_EQ(limn({"brdf", "info", path("broken.binary")}).status, 0) << "the content decides";
  std::ofstream(path("broken.binary"), std::ios::binary) << "neither of them";
  expectRefused(limn({"brdf", "info", path("broken.binary")}), 1, {"broken.binary: not a MERL BRDF"});
}

}  // namespace
}  // namespace limn::test
