#include "core/shadow/sample_batches.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/shadow/shadow_map.h"
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

int mostStepsOfLoops(const TechniqueInputs& inputs) {
  // Of the renderer itself: it leaves loops whichever paths its device takes. The rest is for loops around.
  return inputs.gpuScene.device().context().info().software ? 60000 : std::numeric_limits<int>::max();
}

int mostSamplesOfLoop(const TechniqueInputs& inputs) {
  const int way = inputs.handles.density ? 2 * scene::kCoreMediumSteps + 1 : 0;
  const int reflects = inputs.handles.surface ? inputs.handles.surface->steps : 0;
  return mostStepsOfLoops(inputs) / 2 / (1 + way + reflects);
}

void checkSamplesOfParts(const TechniqueInputs& inputs, std::string_view technique, const ShadowMaps& maps,
                         int samples) {
  for (const LightLayout& layout : inputs.service<ShadowMapService>().layouts(maps)) {
    // Where there are several views, a sample takes up to two steps more to the one that sees it.
    const int steps = layout.faces == glsl::shadow_faces_single ? 1 : 3;
    const int parts = static_cast<int>(layout.parts()), most = mostStepsOfLoops(inputs) / (steps * parts);
    if (samples <= most) continue;
    throw UsageError(
        fmt::format("{}: each of the {} parts of a light takes {} samples, more than the {} that software "
                    "renderers get through; set fewer samples or a smaller views",
                    technique, parts, samples, most));
  }
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
