// Cases and rows of a bench made in memory, for tests of what is done with them.
#pragma once

#include <limits>
#include <string>

#include "core/bench/row.h"

namespace limn::bench::test {

inline Case exampleCase(const std::string& technique = "pcss", int samples = 16) {
  Case c;
  c.scene = "cornell_box";
  c.camera = "main";
  c.term = "visibility";
  c.width = 32;
  c.height = 16;
  c.technique = technique;
  c.parameters = {{technique + ".samples", std::to_string(samples)}};
  c.frames = 5;
  c.warmup = 1;
  return c;
}

inline Row exampleRow(const Case& c, double rmse = 0.25, double ms = 2.5) {
  Row row;
  row.what = c;
  row.key = rowKey(c, "llvmpipe");
  row.referenceFile = "references/a.exr";
  row.referenceNoise = 0.001;
  row.referenceSeconds = 7.5;
  row.error.rmse = rmse;
  row.error.rel_mse = 0.1;
  row.error.bias = -0.01;
  row.error.p999 = 0.7;
  row.error.psnr = -std::numeric_limits<double>::infinity();  // the reference is almost black
  row.error.flip = 0.125;
  row.error.structured = 0.03;
  row.error.pixels = 512;
  row.error.noise_floor = 0.003;
  row.penumbra = row.error;
  row.misjudged = {200, 10, 100, 1};
  row.cost.renderer = "llvmpipe";
  row.cost.backend = "egl";
  row.cost.timer = "finish";
  row.cost.software = true;
  row.cost.frameMs = {ms, ms - 0.25, ms + 0.25, 5, {ms - 0.5, ms - 0.25, ms, ms + 0.25, ms + 0.5}};
  row.cost.split = {ms / 2, ms / 4, ms / 4, ms};
  row.cost.memoryBytes = 3 << 20;
  row.cost.details = R"({"passes":[{"name":"shadow map"}]})";
  return row;
}

/// The row with other figures than exampleRow() has, except those that it is given.
inline Row withOtherFigures(Row row) {
  row.error.rel_mse = 0.2;
  row.error.bias = 0.02;
  row.error.p999 = 0.8;
  row.error.psnr = 40;
  row.error.flip = 0.25;
  row.error.structured = 0.04;
  row.misjudged = {200, 20, 100, 2};
  row.cost.frameMs.n = 6;
  row.cost.memoryBytes = 5 << 20;
  return row;
}

}  // namespace limn::bench::test
