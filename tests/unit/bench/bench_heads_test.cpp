// The tables of stress cases and of savings share heads and digits with those of the bench.
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/bench/private/columns.h"
#include "core/bench/savings.h"
#include "core/bench/stress.h"
#include "core/image/metric_table.h"

namespace limn::bench {
namespace {

/// Metrics, times and memory have one head and one number of digits, in whichever table they stand.
TEST(BenchColumns, OtherTablesShareHeadsAndDigits) {
  EXPECT_EQ(headOf("technique"), "technique");
  EXPECT_EQ(headOf("memory_bytes"), "MiB");
  EXPECT_EQ(headOf("scene"), "scene") << "CSV alone has it";
  EXPECT_THROW(headOf("no such column"), std::logic_error);
  EXPECT_EQ(shownText(metricInfo(&Metrics::rmse), 0.123456), "0.1235");

  const StressResult stress[] = {{.technique = "pcss",
                                  .name = "far",
                                  .scene = "balls",
                                  .settings = {},
                                  .answers = {{.term = "visibility", .error = 0.123456, .benign = 0.01}}}};
  EXPECT_EQ(
      toMarkdown(stress),
      "| technique | case | scene | verdict | term that counts (others) | RMSE | RMSE unchanged | factor "
      "| allowed |\n"
      "|---|---|---|---|---|--:|--:|--:|--:|\n"
      "| pcss | far | balls | pass | visibility | 0.1235 | 0.01 | - | - |\n");

  const SavingSide side = {.ms = {1.5}, .memoryBytes = 3 << 19, .rmse = {}};
  const SavingResult savings[] = {{.name = "lights",
                                   .how = "dark",
                                   .applies = true,
                                   .passes = {"core: light"},
                                   .forced = side,
                                   .without = side,
                                   .ratio = {1, 0.5, 2}},
                                  {.name = "sky", .how = "none"}};
  EXPECT_EQ(
      toMarkdown(savings),
      "| left out | because | passes | median ms forced | median ms without | ratio (95 %) | MiB forced "
      "| MiB without | pictures |\n"
      "|---|---|--:|--:|--:|--:|--:|--:|---|\n"
      "| lights | dark | 1 | 1.500 | 1.500 | 1.000 (0.500 to 2.000) | 1.5 | 1.5 | equal |\n"
      "| sky | none |  |  |  |  |  |  | nothing to leave out |\n");
}

}  // namespace
}  // namespace limn::bench
