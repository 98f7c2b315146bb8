// Computes light through the links: visibility of lights, what leaves reflect of them and of the environment,
// and bounces (thesis, section 4.3.3).
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "techniques/implicit_visibility/element_passes.h"
#include "techniques/implicit_visibility/processor_gather.h"

namespace limn::implicit_visibility {

/// Declares the passes of light. The object must outlive the graph.
class LightPasses {
 public:
  LightPasses(const ElementPasses& elements, std::string_view technique);

  /// Returns V of each leaf.
  SeenLights seenBy(const PassRequest& r, std::span<const uint32_t> lights);
  /// Returns the light of the environment in the leaves' empty bins.
  const Gathered& sky(const PassRequest& r);
  /// Returns the light that arrives over 1 to `bounces` surfaces, from lights and, if `sky`, the environment.
  /// Requests for the same light share it.
  const Gathered& reflected(const PassRequest& r, std::span<const uint32_t> lights, bool sky, int bounces);

 private:
  /// Holds the visibility of some lights at all leaves; requests for the same lights share it.
  struct Seen {
    std::vector<uint32_t> lights;
    gpu::Buffer indexBuffer;
    SeenLights handles;
  };
  /// Holds the light over surfaces that one call of reflected() asked for.
  struct Reflected {
    std::vector<uint32_t> lights;
    bool sky = false;
    int bounces = 0;
    Gathered gathered;
  };
  /// Holds two buffers of what leaves send: one to keep, and one to be pulled up.
  using Sent = std::pair<frame::BufferHandle, frame::BufferHandle>;

  const Seen& seen(const PassRequest& r, std::span<const uint32_t> lights);
  /// Returns the first of `lights`, as many as a picture has asked V for together, so that both share it;
  /// where it has not, a batch.
  std::span<const uint32_t> firstBatch(std::span<const uint32_t> lights) const;
  /// Returns what leaves reflect of lights and environment.
  Sent directLight(const PassRequest& r, std::span<const uint32_t> lights, bool sky);
  /// Adds what leaves reflect of some lights and, if `sky`, of the environment to `before`; empty: nothing
  /// comes before. The second buffer is made where `last`.
  Sent addDirectLight(const PassRequest& r, std::span<const uint32_t> lights, bool sky,
                      frame::BufferHandle before, bool last);
  /// Sets the levels above the leaves to their children's mean (thesis: pull-up).
  frame::BufferHandle pullUp(const PassRequest& r, frame::BufferHandle outgoing);
  /// Returns what arrives at leaves from `outgoing`, and in `next` what they then send on.
  Gathered gather(const PassRequest& r, frame::BufferHandle outgoing, frame::BufferHandle direct,
                  frame::BufferHandle& next);
  /// Does the same on the processor.
  Gathered gatherOnProcessor(const PassRequest& r, frame::BufferHandle outgoing, frame::BufferHandle direct,
                             frame::BufferHandle& next);
  /// Returns the irradiance of leaves by the environment, of which `bins` holds the radiance, less what the
  /// scene's medium takes of it.
  frame::BufferHandle skyIrradiance(const PassRequest& r, frame::BufferHandle bins);
  /// Does the same on the processor, in a scene without a medium.
  frame::BufferHandle skyIrradianceOnProcessor(const PassRequest& r, std::span<const glm::vec4> radiance);
  /// Returns what leaves send into bins of directions: `direct`, and what they reflect of `gathered`; where
  /// `gathered` is the environment, the result is also kept in `direct`.
  Sent reflect(const PassRequest& r, const Gathered& gathered, frame::BufferHandle direct) const;
  /// Declares what a pass reads at leaves to look through their bins; returns the slot of the links.
  frame::SlotHandle readBins(frame::PassBuilder& pass) const;
  /// Runs gather.comp.glsl for all leaves.
  void gatherChunks(frame::PassContext& context, frame::ProgramHandle program, frame::SlotHandle links) const;

  frame::BufferHandle perSlot(const PassRequest& r, const char* name, uint32_t count = 1) const;
  /// Returns a buffer for the radiance values that elements send.
  frame::BufferHandle sent(const PassRequest& r, const char* name) const;
  /// Dispatches a work item for every value that `slots` elements send.
  void dispatchSent(const frame::PassContext& context, uint32_t slots) const;

  const ElementPasses& elements_;
  std::string_view technique_;
  std::deque<Seen> seen_;
  std::deque<Reflected> reflected_;
  std::deque<ProcessorGather> processorGathers_;  ///< the graph keeps their addresses
  std::optional<Gathered> sky_;
  gpu::Buffer environment_;
};

}  // namespace limn::implicit_visibility
