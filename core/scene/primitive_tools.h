// Internal to the scene loader: operations on one primitive's vertices.
#pragma once

#include "core/scene/scene.h"

namespace limn::scene {

/// Gives every triangle its own three vertices and its own normal (glTF 2.0, section 3.7.2.1: no normals
/// means flat). Morph targets get the change of that normal at weight 1.
void splitFlat(Primitive& primitive);

/// Fills bounds, jointBounds and the targets' deltaBounds.
void computeBounds(Primitive& primitive);

/// The rectangle that two triangles form: coplanar, facing the same way, right angles within 1e-3.
std::optional<Quad> findRectangle(const Primitive& primitive);

}  // namespace limn::scene
