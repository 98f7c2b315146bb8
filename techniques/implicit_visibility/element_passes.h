// Declares the surface elements of a frame on the GPU: buffers, and the passes that bring them to the pose
// and link them.
#pragma once

#include <algorithm>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/radiosity/links.h"
#include "core/radiosity/scene_elements.h"
#include "core/technique/technique.h"

namespace limn::implicit_visibility {

struct ElementSettings {
  radiosity::LinkSettings links;
  bool flat = false;          ///< every pair of leaves, without hierarchy; on the CPU
  bool onGpu = false;         ///< links are made there
  float longestEdge = 0.05f;  ///< radii of the scene
  float lift = 0;             ///< as radiosity::Bodies has it
  int glossy = 0;             ///< N of the 6 x N x N bins that elements send light into; 0: evenly
  int64_t memory = 0;         ///< bytes that links may take
  std::string_view technique;
};

/// Holds the links of leaves [first, first + count), as many as one storage block holds and one row of work
/// groups takes.
struct LinkChunk {
  frame::BufferHandle links;
  uint32_t first = 0, count = 0;
};

/// Declares a picture to add to, or to write V to.
struct PassRequest {
  frame::FrameGraph& graph;
  const TechniqueInputs& inputs;
  frame::TextureHandle target;
};

/// Holds V of some lights at all leaves, light after light, and which lights they are.
struct SeenLights {
  frame::BufferHandle seen, indices;
};

/// Holds what arrives at leaves, and where it comes from: radiance of elements, or of bins.
struct Gathered {
  frame::BufferHandle irradiance, source;
  bool sky = false;
};

/// Declares the passes of the elements. The object must outlive the graph.
class ElementPasses {
 public:
  /// Declares "update elements" and "links" (thesis, section 4.3.2): both work on the CPU and upload, unless
  /// links are made on the GPU. Throws UsageError for scenes whose links take more memory than allowed.
  ElementPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs, const ElementSettings& settings);

  bool fits(const scene::Pose& pose) const { return elements_.fits(pose); }
  const radiosity::SceneElements& elements() const { return elements_; }
  uint32_t slots() const { return elements_.forest().slots(); }
  uint32_t leafSlots() const { return elements_.forest().leafSlots(); }
  /// Returns the number of radiance values that each element sends.
  uint32_t sentCount() const {
    return settings_.glossy > 0 ? 6 * static_cast<uint32_t>(settings_.glossy * settings_.glossy) : 1;
  }
  bool glossy() const { return settings_.glossy > 0; }
  /// Returns N of the 6 x N x N bins of links.
  int resolution() const { return settings_.links.resolution; }
  /// Returns the directions and solid angles of bins, as radiosity::binTable() has them.
  std::span<const glm::vec4> binTable() const { return binTable_; }
  /// Returns the links that the processor made; none where they are made on the GPU.
  const radiosity::Links& links() const { return links_; }
  /// Says whether the processor makes the links.
  bool linksOnProcessor() const { return !settings_.onGpu; }
  /// Says whether leaves gather on the processor: on software renderers, where it has made the links, and
  /// elements send evenly.
  bool gathersOnProcessor() const { return software_ && !settings_.onGpu && !glossy(); }

  frame::BufferHandle groups, leaves, corners, directions, materials;
  std::vector<LinkChunk> chunks;

  /// Returns a compute program of this folder, with BINS and GLOSSY defined.
  frame::ProgramHandle program(frame::PassBuilder& pass, const char* file,
                               std::map<std::string, std::string> defines = {}) const;
  /// Declares that a pass reads the directions of bins, as bin_lookup.glsl does.
  void readDirections(frame::PassBuilder& pass) const;
  /// Adds SKY and MEDIUM for a program that looks through bins, at the environment if `sky`, and declares
  /// what it reads of the scene's medium. Returns whether it also needs a block with the medium.
  bool readSky(frame::PassBuilder& pass, const TechniqueInputs& inputs, bool sky,
               std::map<std::string, std::string>& defines) const;
  /// Declares that a pass reads elements and links in the processor's memory.
  void readInMemory(frame::PassBuilder& pass) const;
  /// Declares that a pass reads all links, and returns the slot to which one chunk after the other is bound.
  frame::SlotHandle readLinks(frame::PassBuilder& pass) const;
  /// Binds a chunk's links, and tells the program which leaves they belong to.
  static void bind(const frame::PassContext& context, gpu::Program& kernel, frame::SlotHandle links,
                   const LinkChunk& chunk);
  /// Sets the rotation to the bins in a program that includes elements.glsl.
  void setSpace(gpu::Program& program) const;

 private:
  void createBuffers(gpu::Device& device);
  void addUpdate(frame::FrameGraph& graph, const TechniqueInputs& inputs);
  void addLinks(frame::FrameGraph& graph);
  void addGpuLinks(frame::FrameGraph& graph);
  void addGpuLinks(frame::FrameGraph& graph, LinkChunk& chunk) const;

  ElementSettings settings_;
  const scene::Pose& pose_;
  radiosity::SceneElements elements_;
  radiosity::Links links_;
  std::vector<glm::vec4> binTable_;
  gpu::Buffer groupBuffer_, leafBuffer_, cornerBuffer_, directions_, materialBuffer_, rootBuffer_,
      firstTriangleBuffer_;
  bool software_ = false;
  bool boundedLoops_ = false;       ///< shaders leave loops early, whichever paths the device takes
  mutable bool linksRead_ = false;  ///< by shaders; else those that the processor made stay in its memory
  frame::BufferHandle roots_, firstTriangles_;
  std::deque<gpu::Buffer> linkBuffers_;  ///< the graph keeps their addresses
};

}  // namespace limn::implicit_visibility
