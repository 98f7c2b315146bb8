// Asks limn-read-draco (core/scene_io/readers) and checks what it answers.
#include "core/scene_io/private/draco_meshes.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/helper.h"

namespace limn::scene {

DracoArrays decodeDracoMeshes(std::span<const DracoMesh> meshes, const DracoLimits& limits) {
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(limits.time).count();
  const HelperAnswer answer = runHelper(
      "limn-read-draco", {fmt::format("{}", limits.memory), fmt::format("{}", seconds)},
      {.time = limits.time, .answerBytes = largestDracoMessage(meshes)}, encodeDracoRequest(meshes));
  if (!answer.failure.empty()) throw Error(answer.failure);
  const DracoAnswer decoded = decodeDracoAnswer(answer.bytes, meshes);
  return {{decoded.arrays.begin(), decoded.arrays.end()}, decoded.refused, decoded.reason};
}

}  // namespace limn::scene
