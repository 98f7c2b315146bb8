// Declares how caustic rays are sorted on the GPU by what they are drawn as, so that drawing one kind costs
// nothing for the others: empty parts of the buffer (which hierarchical caustic maps leave out: Wyman 2008),
// and rays that are drawn in another way.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>

#include "core/caustics/caustic_rays.h"
#include "glsl/caustics/ray_runs.glsl"

namespace limn::caustics {

/// The number of rays that one dispatch can list: every device dispatches 65535 work groups in a row, and a
/// group takes glsl::runs_per_group runs of rays.
inline constexpr int64_t kMostListedRays = int64_t{65535} * glsl::runs_per_group * glsl::rays_per_run;

/// Says how the rays of one kind are drawn.
struct RayKind {
  uint32_t vertices = 0;   ///< of each ray; 0: the kind is not used
  bool instances = false;  ///< each ray is an instance of `vertices` vertices; else all in one sequence
};

struct RayLists {
  frame::BufferHandle indices;  ///< into the caustic-ray buffer; glsl/caustics/listed_ray.glsl reads it
  frame::BufferHandle draws;    ///< commands of glDrawArraysIndirect, a glsl::RayDraw per kind
};

/// Describes the pass that determines the kind of each ray.
struct RaySorting {
  std::string_view technique;
  /// Holds a compute shader that defines ray_kind(), which reads the storage block Rays, and that includes
  /// glsl/caustics/ray_kinds.glsl.
  gpu::ProgramDesc program;
  std::array<RayKind, glsl::ray_kinds> kinds;
  /// Says whether kinds depend on nothing but the rays and what `declare` says, the camera left out: the
  /// lists are kept while these do not change.
  bool kept = false;
  std::function<void(frame::PassBuilder&)> declare = {};  ///< what else it reads
  std::function<void(gpu::Program&)> bind = {};           ///< sets its uniforms
};

/// Declares the passes that list `rays`, of which there must be some.
LIMN_API RayLists addRayLists(frame::FrameGraph& graph, const CausticRays& rays, const RaySorting& sorting);

/// Declares in `pass` the reads of a pass that draws the lists.
LIMN_API void declareRayLists(frame::PassBuilder& pass, const RayLists& lists);
/// Draws the rays of one kind with the current program, whose vertex shader finds them by listed_ray().
LIMN_API void drawRays(frame::PassContext& context, const RayLists& lists, unsigned kind, GLenum primitive);

}  // namespace limn::caustics
