// Declares the data of a frame graph: the declarations, the plan made from them, and the state of its
// execution.
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

constexpr uint32_t kNoIndex = ~0u;

struct ResourceAccess {
  uint32_t resource;
  uint32_t version;  ///< read, or made by the write
  uint32_t parent;   ///< the version a write goes on top of; kNoIndex for reads
  Access access;
  std::string why;

  bool write() const { return parent != kNoIndex; }
};

/// Holds a name in a pass's shaders and what is bound to it.
struct NamedResource {
  std::string name;
  uint32_t access = kNoIndex;           ///< of the pass
  const gpu::Buffer* buffer = nullptr;  ///< a constant
  const gpu::Texture* texture = nullptr;
  int level = 0, layer = -1;
  const gpu::Sampler* sampler = nullptr;

  bool slot() const { return access == kNoIndex && buffer == nullptr && texture == nullptr; }
};

struct Version {
  uint32_t producer = kNoIndex;  ///< pass; none for the contents at the start of the frame
  uint32_t parent = kNoIndex;
  uint32_t overwriter = kNoIndex;  ///< the version on top of this one
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
  uint32_t first = kNoIndex, last = kNoIndex;  ///< positions in the execution order; kNoIndex: not used
  bool persistent = false;                     ///< written by a cacheable pass
  uint32_t physical = kNoIndex;

  // After prepare().
  const gpu::Texture* textureObject = nullptr;
  const gpu::Buffer* bufferObject = nullptr;

  bool imported() const { return importedTexture != nullptr || importedBuffer != nullptr; }
  GLuint id() const { return texture ? textureObject->id() : bufferObject->id(); }
};

/// Holds the state in which the cache last saw an imported resource.
struct ImportSeen {
  uint32_t resource;
  uint64_t revision;
  GLuint id;
};

struct Pass {
  std::string name, technique;
  PassRole role = PassRole::core;
  std::vector<ResourceAccess> accesses;
  std::vector<NamedResource> names;
  std::vector<uint32_t> programs;
  std::function<void(PassContext&)> function;
  bool cacheable = false, sideEffect = false;
  bool refused = false;  ///< what was declared last: it is not in `accesses`

  // Plan.
  bool kept = false;
  std::string reason;
  GLbitfield barriers = 0;
  std::vector<uint32_t> inputs;     ///< passes whose results it reads
  std::vector<ImportSeen> imports;  ///< imported resources it uses
  bool alwaysRun = false;           ///< cacheable to no effect: its inputs change within the frame

  // Running.
  bool valid = false;      ///< the outputs of an earlier frame are still there
  bool run = true;         ///< in the last frame
  bool timed = false;      ///< ran in the last frame with timing
  uint64_t triangles = 0;  ///< drawn in the last frame
  std::array<gpu::Query, 2> queries;
  double milliseconds = 0;
};

/// Holds what a pass bound last to a slot.
struct SlotBinding {
  uint32_t access = kNoIndex;  ///< of the pass
  const gpu::Texture* texture = nullptr;
  const gpu::Buffer* buffer = nullptr;
  size_t offset = 0, bytes = 0;  ///< of a buffer; bytes 0: all of it
  int level = 0, layer = -1;
  const gpu::Sampler* sampler = nullptr;
};

/// Holds the unit at which a program expects what a pass named.
struct Place {
  gpu::ShaderResource::Kind kind;
  GLuint unit;
  uint32_t name;     ///< of the pass
  SlotBinding slot;  ///< where the name is a slot
};

struct ProgramUse {
  gpu::ProgramDesc desc;
  uint32_t pass;
  gpu::Program* program = nullptr;

  // After prepare().
  uint64_t placesOf = 0;  ///< serial of the program they were asked of: another after shaders were reloaded
  std::vector<Place> places;  ///< slots among them
  uint64_t ranWith = 0;       ///< serial of the program when the pass ran last
  int dispatches = 0;         ///< in the last frame
  std::array<GLuint, 3> groups = {};
};

struct LeftOut {
  std::string name, technique, reason;
};

/// Returns the role of passes of that owner that do not declare another one.
PassRole defaultRole(std::string_view technique);

/// Describes one GL object that serves one transient resource or several with disjoint lifetimes.
struct Physical {
  bool texture = false;
  gpu::TextureDesc textureDesc;
  size_t bufferBytes = 0;
  int64_t bytes = 0;
  bool persistent = false;
  uint32_t last = 0;
  std::vector<uint32_t> resources;
};

/// Holds the passes that write one resource more than once a frame: either all of them run or none.
struct WriteChain {
  std::vector<uint32_t> writers;
  std::vector<uint32_t> earlyReaders;  ///< of versions that are overwritten in the same frame
};

struct AttachmentKey {
  uint32_t resource = kNoIndex;  ///< kNoIndex: nothing attached
  GLuint id = 0;
  int level = 0, layer = 0;
  auto operator<=>(const AttachmentKey&) const = default;
};
constexpr size_t kMaxColourAttachments = 8;
using FramebufferKey = std::array<AttachmentKey, kMaxColourAttachments + 1>;  // depth last
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
  uint32_t current = kNoIndex;  ///< the pass that executes
  uint32_t program = kNoIndex;  ///< that it uses
  bool checked = false;         ///< compare each use of a handle with what the pass declared
  bool firstFrame = true;
  Timing lastTiming = Timing::off;
  uint32_t querySet = 0;
  uint32_t tag = 0;  ///< marks the handles of this graph

  /// Returns "name", or "technique/name" for passes that are not core's own.
  std::string title(uint32_t pass) const;
  /// Releases everything that prepare() created.
  void release();
};

struct FrameGraph::Implementation : Graph {};

/// Asks the program for the units of what its pass named, and adds errors to `problems`: names that the pass
/// lacks, or has for something of another kind.
void findPlaces(Graph& graph, ProgramUse& use, std::vector<std::string>& problems);
/// Does so for every program of the passes that are kept, and looks for names that occur in no program of
/// their pass, not even in a part that the compiler left out. Throws Error with all that is wrong.
void findPlaces(Graph& graph, const gpu::ShaderLibrary& shaders);

/// Leaves out passes that contribute to no output and orders the others; adds errors to `problems`.
void cullAndOrder(Graph& graph, std::vector<std::string>& problems);
/// Computes lifetimes and lets resources share memory.
void assignMemory(Graph& graph);
/// Derives the barriers before each pass and after the last, for a graph that is executed repeatedly.
void deriveBarriers(Graph& graph);
/// Determines which inputs the cache must check.
void planCache(Graph& graph);
/// Sets Pass::run for this frame.
void decideRuns(Graph& graph);
/// Records the inputs with which a pass has just run.
void noteRun(Graph& graph, Pass& pass);

/// Returns the bytes allocated for a transient buffer of this size: at most an eighth more, so that similar
/// buffers share memory.
size_t bufferSizeClass(size_t bytes);
int64_t resourceBytes(const Resource& resource);

}  // namespace limn::frame
