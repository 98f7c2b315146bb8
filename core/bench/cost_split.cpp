#include "core/bench/cost_split.h"

namespace limn::bench {
namespace {

double& partOf(CostSplit& split, frame::PassRole role) {
  switch (role) {
    case frame::PassRole::map:
      return split.maps;
    case frame::PassRole::filter:
      return split.filters;
    case frame::PassRole::technique:
      return split.technique;
    case frame::PassRole::core:
      break;
  }
  return split.rest;
}

}  // namespace

CostSplit costSplit(const render::FrameStats& stats) {
  CostSplit split;
  for (const render::PassStats& pass : stats.passes) partOf(split, pass.role) += pass.ms.median;
  return split;
}

}  // namespace limn::bench
