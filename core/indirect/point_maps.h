// Fills paraboloid maps from points on the surfaces instead of from triangles (Ritschel et al. 2008,
// Imperfect Shadow Maps): what a map costs depends on its points, not on the scene's triangles.
//
// Each map takes its own points. A point stands for a disc, which covers the texels whose centres lie in a
// circle of its solid angle, at the depth of the disc's plane; the nearest wins. Alpha masks are not looked
// at: a masked surface blocks as a whole.
#pragma once

#include <optional>
#include <string_view>

#include "core/frame/frame_graph.h"
#include "core/gpu_scene/scene_handles.h"
#include "core/indirect/paraboloid_maps.h"
#include "core/indirect/scene_points.h"

namespace limn::indirect {

struct PointMapDesc {
  int count = 0;        ///< maps
  int first = 0;        ///< element of the views that the first map belongs to
  int size = 64;        ///< texels per side
  int points = 2048;    ///< splatted into each map; at most as many as were chosen
  float splat = 4;      ///< texels: radius of the largest splat
  int fillLevels = 0;   ///< holes of 2 to this power texels are closed, 0 to 6; 0: none
  float fillDepth = 0;  ///< depths farther apart than this are not averaged, shares of far - near
  std::string_view technique = "indirect";  ///< owner of the passes
  /// Says whether the maps are kept while nothing changes. False when batches of maps share one piece of
  /// memory.
  bool cacheable = true;
};

/// Returns how many maps of `size` texels per side fit a batch (paraboloidBatch()) and the storage block that
/// points are splatted into.
LIMN_API int pointMapBatch(const gpu::Device& device, int size);

/// Fills sets of maps from one choice of points. Must outlive the graph.
class LIMN_API PointMapPass {
 public:
  /// Chooses points for maps that take `points` each: `windows` times as many, so that as many maps differ.
  PointMapPass(gpu::Device& device, const scene::Scene& scene, const scene::Pose& pose, int points,
               int windows);
  /// Chooses points again if triangles were added or removed, or the size of an instance changed.
  void update(const scene::Pose& pose);
  /// Declares the pass that places the points where the surfaces are now; before the first add().
  void place(frame::FrameGraph& graph, const SceneHandles& handles, std::string_view technique);
  /// Declares the passes that fill maps as ParaboloidMapPass::add() draws them. Throws UsageError for more
  /// maps than pointMapBatch().
  ParaboloidMaps add(frame::FrameGraph& graph, const gpu::Device& device, frame::BufferHandle views,
                     const PointMapDesc& desc);

 private:
  ScenePoints points_;
  frame::BufferHandle placed_;
};

/// Returns the pass of a technique that fills maps from `points` points each: `pass`, which is made and has
/// its points placed when it is asked for the first time.
LIMN_API PointMapPass& pointMapPass(std::optional<PointMapPass>& pass, frame::FrameGraph& graph,
                                    const TechniqueInputs& inputs, int points, std::string_view technique);

}  // namespace limn::indirect
