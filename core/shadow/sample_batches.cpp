#include "core/shadow/sample_batches.h"

#include <algorithm>

namespace limn::shadow {

std::vector<SampleBatch> sampleBatches(int total, int64_t layersPerSample, int size, int mebibytes) {
  const int64_t layers = std::max<int64_t>(layersPerSample, 1);
  constexpr int64_t bytesPerTexel = 8;  // rasterised and linear depth
  constexpr int64_t mostLayers = 2048;  // every device has as many
  const int64_t fit = (int64_t{mebibytes} << 20) / (layers * size * size * bytesPerTexel);
  const int most = static_cast<int>(std::clamp<int64_t>(std::min(fit, mostLayers / layers), 1, 4096));
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

void setBatch(gpu::Program& program, const SampleBatch& batch) {
  program.set("first_sample", batch.first);
  program.set("batch_samples", batch.count);
  program.set("total_samples", batch.total);
}

}  // namespace limn::shadow
