#include "core/shadow/sample_batches.h"

#include <algorithm>
#include <limits>

#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/technique/technique.h"

namespace limn::shadow {

std::vector<SampleBatch> sampleBatches(int total, const SampleLayers& layers, int mebibytes, int largest) {
  // Without maps of their own samples take no room, however much is shared.
  if (layers.each == 0) return {{0, total, total}};
  constexpr int64_t bytesPerTexel = 8;  // rasterised and linear depth
  constexpr int64_t mostLayers = 2048;  // OpenGL 4.5, table 23.54
  const int64_t fit = (int64_t{mebibytes} << 20) / (int64_t{layers.size} * layers.size * bytesPerTexel);
  const int64_t left = std::min(fit, mostLayers) - layers.shared;
  const int most = static_cast<int>(std::clamp<int64_t>(left / layers.each, 1, largest));
  // Batches of one size take one piece of memory in turn, a smaller one would take another: up to twice as
  // many as are needed, where that divides the samples evenly.
  const int least = (total + most - 1) / most;
  int count = least;
  while (count < 2 * least && total % count != 0) ++count;
  if (total % count != 0) count = least;
  const int each = (total + count - 1) / count;
  std::vector<SampleBatch> batches;
  for (int first = 0; first < total; first += each)
    batches.push_back({first, std::min(each, total - first), total});
  return batches;
}

int mostSamplesOfLoop(const TechniqueInputs& inputs) {
  // Of the renderer itself: it leaves loops whichever paths its device takes.
  if (!inputs.gpuScene.device().context().info().software) return std::numeric_limits<int>::max();
  constexpr int kSteps = 30000;  // of each of two loops; what is left is for those around them
  const int way = inputs.handles.density ? 2 * scene::kCoreMediumSteps + 1 : 0;
  return kSteps / (1 + way);
}

void SampleBatch::defineOrder(std::map<std::string, std::string>& defines) const {
  defines["SAMPLES_FIRST"] = isFirst() ? "1" : "0";
  defines["SAMPLES_LAST"] = isLast() ? "1" : "0";
}

void setBatch(gpu::Program& program, const SampleBatch& batch) {
  program.set("first_sample", batch.first);
  program.set("batch_samples", batch.count);
  program.set("total_samples", batch.total);
}

}  // namespace limn::shadow
