// Fewer triangles for the same shape.
#pragma once

#include "assets/generator/mesh.h"

namespace limn::assets {

/// `mesh` with at most `triangles` triangles where that can be had, by collapsing the edges that change the
/// surface least (Garland and Heckbert 1997, quadric error metrics). The vertices that stay keep their
/// position, normal, texture coordinates and joints; open borders and seams stay as they are.
Mesh simplified(const Mesh& mesh, std::size_t triangles);

/// `mesh` without seams, for materials without textures: vertices at one place with the same joints become
/// one, with smooth normals.
Mesh welded(const Mesh& mesh);

/// `mesh` with smooth normals but at edges sharper than `degrees`. Texture coordinates stay.
Mesh creased(const Mesh& mesh, float degrees);

}  // namespace limn::assets
