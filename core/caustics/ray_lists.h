// Caustic rays sorted by what they are drawn as, on the GPU, so that drawing a kind of them costs nothing for
// the others: empty parts of the buffer (what hierarchical caustic maps leave out: Wyman 2008), and rays that
// are drawn otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>

#include "core/caustics/caustic_rays.h"
#include "glsl/caustics/ray_runs.glsl"

namespace limn::caustics {

/// How the rays of one kind are drawn.
struct RayKind {
  uint32_t vertices = 0;   ///< of each ray; 0: there is no such kind
  bool instances = false;  ///< each ray is an instance of so many vertices; else they follow each other
};

struct RayLists {
  frame::BufferHandle indices;  ///< into the caustic-ray buffer; glsl/caustics/listed_ray.glsl reads it
  frame::BufferHandle draws;    ///< what glDrawArraysIndirect takes, a glsl::RayDraw per kind
};

/// The pass that knows of what kind a ray is.
struct RaySorting {
  std::string_view technique;
  /// Of a compute shader that defines ray_kind() and includes glsl/caustics/ray_kinds.glsl, with the rays at
  /// binding 0.
  gpu::ProgramDesc program;
  std::array<RayKind, glsl::ray_kinds> kinds;
  std::function<void(frame::PassBuilder&)> declare = {};              ///< what else it reads
  std::function<void(frame::PassContext&, gpu::Program&)> bind = {};  ///< that, and its uniforms
};

LIMN_API RayLists addRayLists(frame::FrameGraph& graph, const CausticRays& rays, const RaySorting& sorting);

/// Of a pass that draws the lists.
LIMN_API void declareRayLists(frame::PassBuilder& pass, const RayLists& lists);
/// Draws the rays of one kind with the current program, whose vertex shader finds them by listed_ray().
LIMN_API void drawRays(frame::PassContext& context, const RayLists& lists, unsigned kind, GLenum primitive);

}  // namespace limn::caustics
