#include <gtest/gtest.h>

#include "core/bench/cost_split.h"

namespace limn::bench {
namespace {

TEST(BenchCostSplit, SumsMediansByRoleWhateverPassesAreCalled) {
  render::FrameStats stats;
  const auto add = [&](const char* name, const char* technique, frame::PassRole role, double ms) {
    render::PassStats& pass = stats.passes.emplace_back();
    pass.name = name;
    pass.technique = technique;
    pass.role = role;
    pass.ms.median = ms;
  };
  add("gbuffer", "core", frame::PassRole::core, 1);
  add("shadow maps", "shadow", frame::PassRole::map, 2);
  add("surface lookup", "some_technique", frame::PassRole::map, 4);
  add("pyramid level 0", "shadow", frame::PassRole::filter, 8);
  add("visibility", "some_technique", frame::PassRole::technique, 16);
  add("shadow", "shadow", frame::PassRole::technique, 32);
  add("maps", "core", frame::PassRole::core, 64);
  const CostSplit split = costSplit(stats);
  EXPECT_DOUBLE_EQ(split.rest, 65);
  EXPECT_DOUBLE_EQ(split.maps, 6);
  EXPECT_DOUBLE_EQ(split.filters, 8);
  EXPECT_DOUBLE_EQ(split.technique, 48);
}

}  // namespace
}  // namespace limn::bench
