// Declares what an instance of a pose draws.
#pragma once

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::scene {

/// Returns the triangles that the instance draws, before skin and morph targets. Those of a geometry source
/// live as long as somebody holds DynamicGeometry::primitive, and their material is that of Scene::Dynamic.
LIMN_API const Primitive& primitiveOf(const Scene& scene, const Pose& pose, const DrawInstance& instance);

/// Returns the index into Scene::materials of the material that the instance is drawn with.
LIMN_API int materialIndexOf(const Scene& scene, const DrawInstance& instance);

/// Returns the material that the instance is drawn with.
LIMN_API const Material& materialOf(const Scene& scene, const DrawInstance& instance);

/// Returns whether the instance's triangles are wound the other way round than those of its mesh, by its
/// matrix or by the node of its skin.
LIMN_API bool mirrored(const DrawInstance& instance);

}  // namespace limn::scene
