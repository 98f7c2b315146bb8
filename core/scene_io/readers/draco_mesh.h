// Declares the decoding of one mesh. The one place that sees Draco's headers is draco_mesh.cpp.
#pragma once

#include <vector>

#include "core/scene_io/private/draco_message.h"

namespace limn::scene {

/// Appends the arrays that are asked of a mesh: the indices of its triangles, and its attributes. Throws
/// Error where the bytes are no Draco mesh, or one of other counts or attributes.
void decodeDracoMesh(const DracoMesh& mesh, std::vector<std::byte>& arrays);

}  // namespace limn::scene
