// Declares the decoder of meshes compressed by Draco, which runs within limits in a separate process.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene_io/private/draco_message.h"

namespace limn::scene {

/// Limits the resources that decoding the meshes of a scene may use.
struct DracoLimits {
  std::uint64_t memory = std::uint64_t{1} << 33;  ///< bytes of address space of the process that decodes them
  std::chrono::milliseconds time{120'000};
};

/// Holds the arrays of all meshes, or why one of them is refused.
struct DracoArrays {
  std::vector<std::byte> bytes;  ///< as DracoMesh::answerBytes() counts them, one mesh after another
  std::size_t refused = 0;       ///< index of a mesh
  std::string reason;            ///< empty: none is refused
};

/// Decodes meshes in a separate process (limn-read-draco): its library brings a second tinygltf of another
/// layout, and a damaged mesh may crash it. Throws Error with one line where the process fails.
DracoArrays decodeDracoMeshes(std::span<const DracoMesh> meshes, const DracoLimits& limits = {});

}  // namespace limn::scene
