// Declares operations on the vertices of one primitive. Internal to the scene loader.
#pragma once

#include "core/scene/scene.h"

namespace limn::scene {

/// Gives every triangle its own three vertices and its own normal (glTF 2.0, section 3.7.2.1: no normals
/// means flat). Morph targets get the change of that normal at weight 1.
void splitFlat(Primitive& primitive);

/// Gives each vertex that triangles share which are wound either way in the texture a twin for the mirrored
/// ones, so that tangents that are generated are those of one side (as MikkTSpace's are). The primitive has
/// no tangents yet.
void splitMirrored(Primitive& primitive);

/// Computes bounds, jointBounds and the morph targets' deltaBounds.
void computeBounds(Primitive& primitive);

/// Returns the rectangle that the primitive's two triangles form, or nothing when they form none. The
/// triangles must be coplanar, face the same way and have right angles within 1e-3.
std::optional<Quad> findRectangle(const Primitive& primitive);

}  // namespace limn::scene
