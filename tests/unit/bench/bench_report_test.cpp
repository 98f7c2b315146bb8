// What the report page is given. Whether it shows it is tested in a browser, tests/report/.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/private/report_pictures.h"
#include "core/bench/report.h"

namespace limn::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const Json kNone = {{"thumbnail", -1}, {"whole", -1}};
constexpr const char* kScript = "</script><img src=x onerror=alert(1)>";

class BenchReport : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("limn_report_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "results/pictures");
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path results() const { return folder_ / "results"; }

  Row row(const std::string& technique, float grey) const {
    Row row;
    row.what.scene = "balls";
    row.what.term = "visibility";
    row.what.technique = technique;
    row.what.width = 48;
    row.what.height = 32;
    row.key = technique;
    row.referenceFile = "references/truth.exr";
    row.cost.renderer = "llvmpipe";
    row.cost.software = true;
    row.cost.frameMs = {1, 1, 1, 3, {}};
    row.spectrum = {1, 2, 3};
    row.picture = "pictures/" + technique + ".png";
    Image image = Image::rgb(48, 32);
    std::ranges::fill(image.data(), grey);
    writePng(results() / row.picture, image);
    writePng(results() / "pictures/truth.png", image);
    return row;
  }

  Json data(const std::vector<Row>& rows) const { return Json::parse(reportData(rows, results()).json); }

  fs::path folder_;
};

TEST_F(BenchReport, HoldsRowsPicturesAndWindows) {
  const auto [json, pictures] = reportData(std::vector{row("pcss", 0.5f), row("vssm", 0.6f)}, results());
  const Json page = Json::parse(json);
  ASSERT_EQ(page["tables"].size(), 1u);
  const Json& table = page["tables"][0];
  ASSERT_EQ(table["rows"].size(), 2u);
  EXPECT_EQ(table["windows"].size(), 2u);
  EXPECT_EQ(table["software"], true);
  EXPECT_EQ(table["rows"][0]["spectrum"].size(), 3u);
  EXPECT_EQ(table["rows"][0]["difference"], kNone) << "none was kept";
  EXPECT_EQ(table["rows"][0]["command"],
            "limn render balls --technique pcss --size 48x32 --output-term visibility --out picture.png");
  EXPECT_FALSE(page.contains("pictures")) << "they stand behind the script";
  const Json& picture = table["rows"][1]["picture"];
  const std::string png = "data:image/png;base64,iVBORw0KGgo", webp = "data:image/webp;base64,UklGR";
  std::size_t last = 0;
  for (const auto& [index, begin] : {std::pair(picture["thumbnail"].get<int>(), webp),
                                     std::pair(table["rows"][1]["windows"][1].get<int>(), png),
                                     std::pair(table["reference"]["picture"]["whole"].get<int>(), png),
                                     std::pair(picture["whole"].get<int>(), png)}) {
    const std::string tag = "<script type=\"text/plain\" id=\"picture-" + std::to_string(index) + "\">";
    const std::size_t at = pictures.find(tag);
    ASSERT_NE(at, std::string::npos) << index;
    EXPECT_GE(at, last) << "thumbnails first, whole pictures last";
    last = at;
    const std::string uri = pictures.substr(at + tag.size(), pictures.find('<', at + 1) - at - tag.size());
    EXPECT_TRUE(uri.starts_with(begin)) << uri.substr(0, 60);
    EXPECT_EQ(uri.substr(uri.find(',') + 1).size() % 4, 0u);
  }
}

TEST_F(BenchReport, AnOutdatedBaselineIsMarked) {
  std::vector<Row> rows = {row("pcss", 0.5f), row("vssm", 0.5f)};
  rows[0].what.baseline = true;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].provenance.program = "1";
    rows[i].line = i + 1;
  }
  EXPECT_EQ(data(rows)["tables"][0]["baseline"], "pcss");
  rows[1].provenance.program = "2";
  EXPECT_EQ(data(rows)["tables"][0]["baseline"], "pcss \u2020");
}

TEST_F(BenchReport, HoldsWhatWasMeasuredRatherThanAskedFor) {
  std::vector<Row> rows = {row("pcss", 0.5f), row("vssm", 0.5f), row("savsm", 0.5f)};
  for (Row& row : rows) row.what.turns = 5;
  rows[0].what.baseline = true;
  rows[0].cost.frameMs = {2, 2, 2, 5, {2, 2, 2, 2, 2}, 5};
  rows[1].cost.frameMs = {1, 1, 1, 3, {1, 1, 1}, 3};
  rows[2].failure = "lost";
  rows[1].what.frames = 3;  // as in a folder of limn tune, where settings are tried with less
  rows[1].what.warmup = 2;
  const Json table = data(rows)["tables"][0];
  EXPECT_EQ(table["turns"], (Json{3, 5}));
  EXPECT_EQ(table["frames"], (Json{0, 3}));
  EXPECT_EQ(table["warmup"], (Json{0, 2}));
  EXPECT_EQ(table["rows"][1]["times_as_fast"],
            (Json{{"value", 2.0}, {"low", 2.0}, {"high", 2.0}, {"turns", 3}}));
}

TEST_F(BenchReport, SaysHowLightsStandForTheEnvironment) {
  Row added = row("pcss", 0.5f);
  added.what.environment = "sky";
  added.what.environmentLights = 0.015;
  Row other = added;
  other.what.environmentCombine = "ratio";
  const Json rows = data({added, other})["tables"][0]["rows"];
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["environment_settings"], "48 squares area");
  EXPECT_EQ(rows[1]["environment_settings"], "48 squares area ratio");
  EXPECT_NE(rows[0]["name"], rows[1]["name"]);
}

TEST_F(BenchReport, SoftwareAndHardwareHaveTablesOfTheirOwn) {
  std::vector<Row> rows = {row("pcss", 0.5f), row("pcss", 0.5f)};
  rows[1].cost.renderer = "GPU";
  rows[1].cost.software = false;
  const Json page = data(rows);
  ASSERT_EQ(page["tables"].size(), 2u);
  EXPECT_NE(page["tables"][0]["software"], page["tables"][1]["software"]);
}

/// Texts group the page's tables and stand in its lists.
TEST_F(BenchReport, TablesOfAnotherReferenceHaveTheSameSubject) {
  std::vector<Row> rows = {row("pcss", 0.5f), row("pcss", 0.5f)};
  rows[1].what.reference.spp = 64;
  const Json tables = data(rows)["tables"];
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0]["subject"], "balls");
  EXPECT_EQ(tables[1]["subject"], "balls");
  EXPECT_EQ(tables[0]["measured"], "48x32, dynamic, against 256 spp, llvmpipe (software)");
  EXPECT_EQ(tables[1]["measured"], "48x32, dynamic, against 64 spp, llvmpipe (software)");
}

TEST_F(BenchReport, SubjectsTellEnvironmentsApart) {
  std::vector<Row> rows(5, row("pcss", 0.5f));
  for (Row& row : rows) row.what.environment = "a/sky.hdr";
  rows[1].what.environment = "b/sky.hdr";
  rows[2].what.environmentRotation = 90;
  rows[3].what.light = rows[4].what.light = "#1";
  rows[3].what.environmentLights = 0.1;  // of which that is another light
  std::set<std::string> subjects;
  const Json page = data(rows);
  for (const Json& table : page["tables"]) subjects.insert(table["subject"].get<std::string>());
  EXPECT_EQ(subjects.size(), rows.size());
  EXPECT_TRUE(subjects.contains("balls, environment a/sky.hdr"));
}

TEST_F(BenchReport, MachinesAndDriversStandWhereThereAreSeveral) {
  std::vector<Row> rows(3, row("pcss", 0.5f));
  rows[0].cost.machine = "a";
  rows[1].cost.machine = "b";
  rows[1].what.scene = "robot";
  rows[2].cost.renderer = "GPU";
  rows[2].cost.machine = "c";
  for (Row& row : rows) row.cost.driver = "GL 1";
  std::set<std::string> measured;
  const Json page = data(rows);
  for (const Json& table : page["tables"]) measured.insert(table["measured"].get<std::string>());
  const std::string start = "48x32, dynamic, against 256 spp, ";
  EXPECT_EQ(measured, (std::set<std::string>{start + "llvmpipe (software), a",
                                             start + "llvmpipe (software), b", start + "GPU (software)"}));
}

TEST_F(BenchReport, FailedRowsDoNotSayWhetherTheRendererIsSoftware) {
  Row failed = row("pcss", 0.5f);
  failed.failure = "lost";
  failed.cost.software = false;  // as their lines leave it
  Json table = data({failed})["tables"][0];
  EXPECT_TRUE(table["software"].is_null());
  EXPECT_EQ(table["measured"], "48x32, dynamic, against 256 spp, llvmpipe");
  table = data({failed, row("vssm", 0.5f), failed})["tables"][0];
  EXPECT_EQ(table["software"], true);
}

/// What to take over all scenes counts those that are asked and measured alike.
TEST_F(BenchReport, AWhollyFailedSceneIsAskedAsTheOthersOfItsRenderer) {
  Row failed = row("pcss", 0.5f);
  failed.what.scene = "robot";
  failed.failure = "lost";
  failed.cost.software = false;
  const Json page = data({row("pcss", 0.5f), failed});
  ASSERT_EQ(page["tables"].size(), 2u);
  EXPECT_EQ(page["tables"][1]["measured"], page["tables"][0]["measured"]);
}

TEST_F(BenchReport, TextsCannotLeaveTheScript) {
  Row bad = row("pcss", 0.5f);
  bad.what.scene = bad.what.title = bad.cost.renderer = bad.cost.machine = kScript;
  Row failed = bad;
  failed.failure = std::string(kScript) + "\xff<!-- \xe2\x80\xa8 \xe2\x80\xae";  // line separator, direction
  failed.what.light = kScript;
  const std::vector<Row> rows = {bad, failed};
  const std::string text = reportData(rows, results()).json;
  EXPECT_EQ(text.find('<'), std::string::npos);
  EXPECT_TRUE(std::ranges::all_of(text, [](unsigned char c) { return c < 0x80; }));
  EXPECT_EQ(Json::parse(text)["tables"][0]["subject"], kScript);
  writeReport(rows, results());
  const std::string page = readTextFile(results() / "index.html");
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(page.find("{{"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(page.find("unsafe-inline"), std::string::npos);
}

TEST_F(BenchReport, FilesThatMadeTheStressTableStayOutside) {
  writeTextFile(results() / "stress.json",
                R"({"results": [{"case": "far", "provenance": {"techniques": [{"file": "/a/t.so"}]}}, 1]})");
  EXPECT_EQ(data({row("pcss", 0.5f)})["stability"]["results"], Json::array({{{"case", "far"}}}));
}

TEST_F(BenchReport, StressResultsOfAnotherProgramAreMarked) {
  writeTextFile(results() / "stress.json", R"({"results": [{"case": "none"},
      {"case": "old", "provenance": {"program": "1"}}, {"case": "new", "provenance": {"program": "2"}}]})");
  EXPECT_EQ(data({row("pcss", 0.5f)})["stability"]["results"],
            Json::parse(R"([{"case": "none", "outdated": true}, {"case": "old", "outdated": true},
                            {"case": "new"}])"));
}

TEST_F(BenchReport, StressResultsOfAnotherTechniqueAreMarked) {
  writeTextFile(results() / "stress.json", R"({"results": [
      {"case": "old", "provenance": {"program": "1", "techniques": [{"technique": "t", "hash": "1"}]}},
      {"case": "new", "provenance": {"program": "1", "techniques": [{"technique": "t", "hash": "2"}, 3]}}]})");
  EXPECT_EQ(data({row("pcss", 0.5f)})["stability"]["results"],
            Json::parse(R"([{"case": "old", "outdated": true}, {"case": "new"}])"));
}

TEST_F(BenchReport, OnlyObjectsOfTheStressTableArePassedOn) {
  writeTextFile(
      results() / "stress.json",
      R"({"results": [null, {"answers": [null, {"verdict": "pass"}, []]}, {"answers": 1}, "far"]})");
  EXPECT_EQ(data({row("pcss", 0.5f)})["stability"]["results"],
            Json::parse(R"([{"answers": [{"verdict": "pass"}]}, {"answers": 1}])"));
  for (const char* odd : {"[]", "null", R"({"results": {"far": null}})"}) {
    writeTextFile(results() / "stress.json", odd);
    EXPECT_EQ(data({row("pcss", 0.5f)})["stability"], Json::parse(odd));
  }
}

TEST_F(BenchReport, StressTablesThatNestTooDeepAreRefused) {
  constexpr std::size_t levels = 200'000;
  writeTextFile(results() / "stress.json",
                R"({"results": [{"case": )" + std::string(levels, '[') + std::string(levels, ']') + "}]}");
  EXPECT_THROW(data({row("pcss", 0.5f)}), Error);
}

TEST_F(BenchReport, OnlyPicturesInsideTheFolderAreRead) {
  Image secret = Image::rgb(4, 4);
  writePng(folder_ / "secret.png", secret);
  fs::create_symlink(folder_ / "secret.png", results() / "pictures/link.png");
  writeTextFile(results() / "pictures/text.txt", "text");
  for (const std::string& file :
       {std::string("../secret.png"), (folder_ / "secret.png").string(), std::string("pictures/link.png"),
        std::string("pictures/text.txt"), std::string("pictures/missing.png"), std::string("pictures")}) {
    Row stray = row("pcss", 0.5f);
    stray.picture = file;
    EXPECT_EQ(data({stray})["tables"][0]["rows"][0]["picture"], kNone) << file;
  }
}

TEST_F(BenchReport, BrokenPictureLeavesTheReportWhole) {
  const Row broken = row("pcss", 0.5f);
  writeTextFile(results() / broken.picture, "no PNG");
  const Json table = data({broken})["tables"][0];
  EXPECT_EQ(table["rows"][0]["picture"], kNone);
  EXPECT_TRUE(table["windows"].empty());
}

TEST_F(BenchReport, PicturesBeyondTheBudgetAreCompressedThenReduced) {
  const std::vector<std::string> files = {row("pcss", 0.5f).picture};
  const auto bytes = fs::file_size(results() / files[0]);
  EmbeddedPictures exact(results(), files);
  EXPECT_EQ(exact.reduction(), 1);
  EXPECT_EQ(exact.whole(files[0]), 0);
  EXPECT_TRUE(exact.uris()[0].starts_with("data:image/png;base64,"));
  EmbeddedPictures smaller(results(), files, bytes / 2);
  EXPECT_TRUE(smaller.compressed());
  EXPECT_EQ(smaller.reduction(), 1);
  EmbeddedPictures small(results(), files, bytes / 8);
  EXPECT_EQ(small.reduction(), 2);
  EXPECT_EQ(small.whole(files[0]), 0);
  EXPECT_EQ(small.whole(files[0]), 0) << "each picture once";
  EXPECT_TRUE(small.uris()[0].starts_with("data:image/webp;base64,UklGR")) << small.uris()[0].substr(0, 40);
  EXPECT_EQ(small.window(files[0], {0, 0, 8, 8}), 1);
  EXPECT_TRUE(small.uris()[1].starts_with("data:image/png;base64,")) << "windows are exact";
  EXPECT_EQ(small.window(files[0], {44, 0, 8, 8}), -1) << "beyond the picture";
}

TEST_F(BenchReport, PicturesLongerThanAWebpMayBeAreReduced) {
  const std::vector<std::string> files = {"pictures/long.png"};
  writePng(results() / files[0], Image::rgb(16384, 1));
  EmbeddedPictures pictures(results(), files, fs::file_size(results() / files[0]) / 2);
  EXPECT_EQ(pictures.reduction(), 1);
  EXPECT_EQ(pictures.whole(files[0]), 0);
  EXPECT_TRUE(pictures.uris().at(0).starts_with("data:image/webp;base64,UklGR"));
}

TEST_F(BenchReport, ThumbnailsHaveAtMost192Pixels) {
  const auto thumbnail = [&](int width, int height) {
    writePng(results() / "pictures/black.png", Image::rgb(width, height));
    EmbeddedPictures pictures(results(), {});
    EXPECT_EQ(pictures.thumbnail("pictures/black.png"), 0);
    EXPECT_EQ(pictures.thumbnail("pictures/black.png"), 0) << "each picture once";
    return pictures.uris().at(0);
  };
  EXPECT_TRUE(thumbnail(192, 30).starts_with("data:image/webp;base64,UklGR"));
  EXPECT_EQ(thumbnail(384, 60), thumbnail(192, 30)) << "black pictures of a size are the same file";
  EXPECT_EQ(thumbnail(30, 194), thumbnail(15, 97));
  EXPECT_NE(thumbnail(192, 30), thumbnail(96, 15)) << "no smaller than they need to be";
}

/// Decoding takes most of a report's time: a file that is gone in between is not missed.
TEST_F(BenchReport, WhatIsAskedOfAPictureInOneGoDecodesItOnce) {
  const std::vector<std::string> files = {row("pcss", 0.5f).picture, row("vssm", 0.5f).picture};
  EmbeddedPictures pictures(results(), files, 0);
  EXPECT_EQ(pictures.thumbnail(files[0]), 0);
  fs::remove(results() / files[0]);
  EXPECT_EQ(pictures.window(files[0], {0, 0, 8, 8}), 1);
  EXPECT_EQ(pictures.thumbnail(files[1]), 2);
  EXPECT_EQ(pictures.window(files[0], {8, 8, 8, 8}), -1) << "it is read again after another";
}

TEST(WindowChooser, FindsWherePicturesDiffer) {
  Image reference = Image::rgb(96, 64), a = reference, b = reference;
  const auto paint = [](Image& image, int x0, int y0, float value) {
    for (int y = y0; y < y0 + 16; ++y)
      for (int x = x0; x < x0 + 16; ++x)
        for (int c = 0; c < 3; ++c) image.at(x, y, c) = value;
  };
  // Both are equally wrong at the left, differently at the right; the second of these is the smaller one.
  paint(a, 4, 8, 1.0f);
  paint(b, 4, 8, 1.0f);
  paint(a, 70, 40, 0.9f);
  paint(b, 40, 2, 0.5f);
  WindowChooser chooser(reference);
  EXPECT_TRUE(chooser.choose(2).empty());
  chooser.add(a);
  chooser.add(b);
  chooser.add(Image::rgb(3, 3));  // of another size
  EXPECT_EQ(chooser.choose(2), (std::vector<Window>{{70, 40, 16, 16}, {40, 2, 16, 16}}));
}

TEST(WindowChooser, SmallPicturesHaveNone) {
  const Image reference = Image::rgb(40, 15);
  WindowChooser chooser(reference);
  chooser.add(reference);
  EXPECT_TRUE(chooser.choose(2).empty());
}

}  // namespace
}  // namespace limn::bench
