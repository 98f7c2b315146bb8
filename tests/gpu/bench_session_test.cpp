// What a bench keeps of a scene from row to row, and that rows are the same as where it is opened for each.
#include "core/session/bench_session.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/base/file.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/paths.h"

namespace limn::session {
namespace {

namespace fs = std::filesystem;

/// The balls in a file that can be taken away: who opens it again then fails.
class BenchSessionTest : public testing::Test {
 protected:
  BenchSessionTest() {
    fs::remove_all(folder_);
    createFolder(folder_);
    putFile();
    case_.scene = file_.string();
    case_.light = "key";
    case_.term = "visibility";
    case_.width = 32;
    case_.height = 24;
    case_.technique = "pcss";
    case_.parameters = {
        {"pcss.blocker_samples", "4"}, {"pcss.filter_samples", "4"}, {"pcss.shadow_map_size", "64"}};
    case_.frames = 1;
    case_.lightSize = 0.3;
    case_.reference.spp = 2;
  }
  ~BenchSessionTest() override { fs::remove_all(folder_); }

  void putFile() const {
    fs::copy_file(fs::path(test::kBinaryDir) / "assets/balls/balls.glb", file_,
                  fs::copy_options::overwrite_existing);
  }
  BenchSession session(const char* out) const {
    const Backend backend = GlTest::testBackend();
    return {{.backend = backend, .device = GlTest::testDevice(backend)}, folder_ / out, [] {}};
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) / ("limn_bench_session_" + std::to_string(::getpid()));
  const fs::path file_ = folder_ / "scene.glb";
  bench::Case case_;
};

bool samePixels(const Image& a, const Image& b) {
  return std::ranges::equal(a.data(), b.data());
}

TEST_F(BenchSessionTest, OneSceneIsOpenedForAllSizesOfItsLights) {
  Image small;
  bench::Reference truth;
  bench::Measurement measured;
  bench::Case larger = case_;
  larger.lightSize = 2.7;
  {
    BenchSession kept = session("kept");
    small = kept.measure(case_).image;
    fs::remove(file_);
    truth = kept.reference(larger);
    measured = kept.measure(larger);
    EXPECT_EQ(kept.time(larger).size(), 1u);
    EXPECT_TRUE(samePixels(kept.measure(case_).image, small)) << "the first size again";
    bench::Case later = case_;
    later.time = 1;
    EXPECT_THROW(kept.measure(later), Error) << "of other times the scene is opened again";
    EXPECT_THROW(kept.measure(case_), Error) << "nothing is open any more";
  }
  putFile();
  BenchSession fresh = session("fresh");
  const bench::Reference again = fresh.reference(larger);
  EXPECT_EQ(truth.file, again.file) << "which has the hash of all that was asked";
  EXPECT_TRUE(samePixels(truth.image, again.image));
  const bench::Measurement alone = fresh.measure(larger);
  EXPECT_TRUE(samePixels(measured.image, alone.image));
  EXPECT_FALSE(samePixels(measured.image, small)) << "the size matters";
  EXPECT_EQ(measured.cost.memoryBytes, alone.cost.memoryBytes);
}

/// A size that is refused leaves lights set in part.
TEST_F(BenchSessionTest, ARefusedQuestionLeavesNothingOpen) {
  BenchSession kept = session("kept");
  const Image before = kept.measure(case_).image;
  bench::Case refused = case_;
  refused.lightSize = 2.7;
  refused.camera = "no such camera";
  EXPECT_THROW(kept.measure(refused), UsageError);
  EXPECT_TRUE(samePixels(kept.measure(case_).image, before));
}

}  // namespace
}  // namespace limn::session
