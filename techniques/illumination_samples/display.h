// Shows the solution as a picture.
#pragma once

#include <map>

#include "core/indirect/surface_lookup.h"
#include "techniques/illumination_samples/solution.h"

namespace limn::illumination_samples {

/// Declares the passes that show light. The object must outlive the graph.
class Display {
 public:
  Display(const Elements& elements, const SolutionSettings& settings)
      : elements_(elements), settings_(settings) {}

  /// Adds the light of a solution to `target` and returns it.
  frame::TextureHandle show(frame::FrameGraph& graph, const TechniqueInputs& inputs, const Solution& solution,
                            frame::TextureHandle target);

 private:
  void readTrees(frame::PassBuilder& pass, const Solution& solution) const;
  void setTrees(gpu::Program& program) const;
  /// Declares the pass that draws the tree of the leaf in the middle over the picture.
  frame::TextureHandle drawTree(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                const Solution& solution, frame::TextureHandle around,
                                frame::TextureHandle picture) const;
  /// Returns what leaves send towards the eye, whatever it is shown on. Declares the pass that looks their
  /// trees up when first asked for a solution.
  frame::BufferHandle towardsEye(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const Solution& solution);

  const Elements& elements_;
  SolutionSettings settings_;
  indirect::SurfaceLookup lookup_;
  std::map<const Solution*, frame::BufferHandle> towards_;
};

}  // namespace limn::illumination_samples
