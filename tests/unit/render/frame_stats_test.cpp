#include "core/render/frame_stats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limn::render {
namespace {

TEST(FrameStats, QuartilesInterpolateBetweenOrderStatistics) {
  const Quartiles q = quartiles({4, 1, 3, 2});
  EXPECT_DOUBLE_EQ(q.median, 2.5);
  EXPECT_DOUBLE_EQ(q.q1, 1.75);
  EXPECT_DOUBLE_EQ(q.q3, 3.25);
  EXPECT_EQ(q.n, 4);
  EXPECT_DOUBLE_EQ(quartiles({7}).q3, 7);
  EXPECT_EQ(quartiles({}).n, 0);
}

TEST(FrameStats, QuantilesReachFromTheLeastToTheGreatest) {
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0), 1);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 1), 4);
  EXPECT_DOUBLE_EQ(quantile({5, 1, 4, 2, 3}, 0.99), 4.96);
  EXPECT_EQ(quantile({}, 0.5), 0);
}

TEST(FrameStats, AreWholeInTheirJson) {
  FrameStats stats;
  stats.renderer = "a \"renderer\"";
  stats.timer = frame::Timing::query;
  stats.dynamic = false;
  stats.width = 3;
  stats.height = 5;
  stats.framesPerPicture = 4;
  stats.parameters = {{"pcss.bias", "1.5"}};
  stats.frameMs = {2, 1, 3, 7};
  stats.passes.push_back(
      {"shadow maps", "shadow", frame::PassRole::map, frame::PassState::leftOut, "no geometry", {}, 12});
  stats.shadowMaps.push_back({"key", "hemicube", 5, 0.1, 20, 0});
  stats.uncoveredPixels = 4;
  const std::string text = toJson(stats);
  for (const char* part :
       {R"("renderer":"a \"renderer\"")",
        R"("timer":"query","dynamic":false,"size":[3,5],"frames_per_picture":4,)",
        R"("parameters":{"pcss.bias":"1.5"},"frame_ms":{"median":2.0,"q1":1.0,"q3":3.0,"n":7},)",
        R"("passes":[{"name":"shadow maps","technique":"shadow","role":"map","state":"left_out",)",
        R"("reason":"no geometry","ms":{"median":0.0,"q1":0.0,"q3":0.0,"n":0},"bytes":12,"triangles":0}],)",
        R"("shadow_maps":[{"light":"key","projection":"hemicube","layers":5,"near":0.1,"far":20.0,)",
        R"("half_angle":0.0}],"uncovered_pixels":4})"})
    EXPECT_THAT(text, testing::HasSubstr(part));
}

}  // namespace
}  // namespace limn::render
