// What a frame graph holds: the declarations, the plan made from them, and the state of running it.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/frame/frame_graph.h"

namespace limn::frame {

constexpr uint32_t no_index = ~0u;

struct ResourceAccess {
  uint32_t resource;
  uint32_t version;  ///< read, or made by the write
  uint32_t parent;   ///< the version a write goes on top of; no_index for reads
  Access access;
  std::string why;

  bool write() const { return parent != no_index; }
};

struct Version {
  uint32_t producer = no_index;  ///< pass; none for the contents at the start of the frame
  uint32_t parent = no_index;
  uint32_t overwriter = no_index;  ///< the version on top of this one
  std::vector<uint32_t> readers;   ///< passes that read it without changing it
};

struct Resource {
  std::string name;
  bool texture = false;
  gpu::TextureDesc textureDesc;
  BufferDesc bufferDesc;
  const gpu::Texture* importedTexture = nullptr;
  const gpu::Buffer* importedBuffer = nullptr;
  std::vector<Version> versions;
  std::vector<uint32_t> outputs;  ///< versions
  uint64_t revision = 0;          ///< how often touch() was called

  // Plan.
  uint32_t first = no_index, last = no_index;  ///< positions in the execution order; no_index: not used
  bool persistent = false;                     ///< written by a cacheable pass
  uint32_t physical = no_index;

  // After prepare().
  const gpu::Texture* textureObject = nullptr;
  const gpu::Buffer* bufferObject = nullptr;

  bool imported() const { return importedTexture != nullptr || importedBuffer != nullptr; }
  GLuint id() const { return texture ? textureObject->id() : bufferObject->id(); }
};

/// What the cache last saw of an imported resource.
struct ImportSeen {
  uint32_t resource;
  uint64_t revision;
  GLuint id;
};

struct Pass {
  std::string name, technique;
  std::vector<ResourceAccess> accesses;
  std::vector<uint32_t> programs;
  std::function<void(PassContext&)> function;
  bool cacheable = false, sideEffect = false;

  // Plan.
  bool kept = false;
  std::string reason;
  GLbitfield barriers = 0;
  std::vector<uint32_t> inputs;     ///< passes whose results it reads
  std::vector<ImportSeen> imports;  ///< imported resources it uses
  bool alwaysRun = false;           ///< cacheable in vain: its inputs change within the frame

  // Running.
  bool valid = false;      ///< the outputs of an earlier frame are still there
  bool run = true;         ///< in the last frame
  bool timed = false;      ///< ran in the last frame with timing
  uint64_t triangles = 0;  ///< drawn in the last frame
  std::array<gpu::Query, 2> queries;
  double milliseconds = 0;
};

struct ProgramUse {
  gpu::ProgramDesc desc;
  uint32_t pass;
  gpu::Program* program = nullptr;
};

struct LeftOut {
  std::string name, technique, reason;
};

/// One GL object that serves one transient resource or several with disjoint lifetimes.
struct Physical {
  bool texture = false;
  gpu::TextureDesc textureDesc;
  size_t bufferBytes = 0;
  int64_t bytes = 0;
  bool persistent = false;
  uint32_t last = 0;
  std::vector<uint32_t> resources;
};

/// The passes that write one resource more than once a frame: either all of them run or none.
struct WriteChain {
  std::vector<uint32_t> writers;
  std::vector<uint32_t> earlyReaders;  ///< of versions that are overwritten in the same frame
};

struct AttachmentKey {
  uint32_t resource = no_index;  ///< no_index: nothing attached
  GLuint id = 0;
  int level = 0, layer = 0;
  auto operator<=>(const AttachmentKey&) const = default;
};
constexpr size_t max_colour_attachments = 8;
using FramebufferKey = std::array<AttachmentKey, max_colour_attachments + 1>;  // depth last
struct FramebufferEntry {
  gpu::Framebuffer framebuffer;
  int width, height;
};

struct Graph {
  std::vector<Resource> resources;
  std::vector<Pass> passes;
  std::vector<ProgramUse> programs;
  std::vector<LeftOut> leftOut;
  std::vector<std::string> problems;  ///< found while declaring

  // Plan.
  bool planned = false;
  std::vector<uint32_t> order;
  std::vector<Physical> physicals;
  std::vector<WriteChain> chains;
  GLbitfield finalBarriers = 0;

  // Running.
  gpu::Device* device = nullptr;  ///< null: not prepared
  std::vector<std::shared_ptr<gpu::Texture>> textures;
  std::vector<std::shared_ptr<gpu::Buffer>> buffers;
  std::map<FramebufferKey, FramebufferEntry> framebuffers;
  uint32_t current = no_index;  ///< the pass that executes
  bool checked = false;         ///< compare each use of a handle with what the pass declared
  bool firstFrame = true;
  Timing lastTiming = Timing::off;
  uint32_t querySet = 0;
  uint32_t tag = 0;  ///< marks the handles of this graph

  /// "name", or "technique/name" for passes that are not core's own.
  std::string title(uint32_t pass) const;
  /// Releases what prepare() made.
  void release();
};

struct FrameGraph::Implementation : Graph {};

/// Leaves out what contributes to no output and orders the rest; adds what is wrong to `problems`.
void cullAndOrder(Graph& graph, std::vector<std::string>& problems);
/// Lifetimes, sharing of memory.
void assignMemory(Graph& graph);
/// Barriers before each pass and after the last, for a graph that is executed again and again.
void deriveBarriers(Graph& graph);
/// What the cache has to look at.
void planCache(Graph& graph);
/// Sets Pass::run for this frame.
void decideRuns(Graph& graph);
/// Notes what a pass has just been run with.
void noteRun(Graph& graph, Pass& pass);

/// Bytes a transient buffer of this size is given: at most an eighth more, so that similar buffers share
/// memory.
size_t bufferSizeClass(size_t bytes);
int64_t resourceBytes(const Resource& resource);

}  // namespace limn::frame
