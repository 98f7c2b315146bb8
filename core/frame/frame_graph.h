// A frame as a graph of passes over typed handles.
//
// A pass names what it reads and writes, how (Access) and why. From that the graph orders the passes, leaves
// out those whose results nobody needs (and says why), derives the memory barriers, places transient
// resources in a pool where disjoint lifetimes share memory, keeps the results of cacheable passes while
// their inputs did not change, times each pass, and prints itself.
//
// Handles are versions of a resource: write() returns the next version; a read names the version it wants. A
// pass that reads version k runs after the pass that wrote k and before the one that overwrites it. Among
// independent passes the order of declaration decides. Two passes that both write on top of the same version
// are an error naming both.
//
// The graph is built once and executed every frame; rebuild it when the set of passes, a size or a parameter
// changes. Executing allocates nothing. A pass that is left out compiles no program and allocates no
// resource.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/gpu/objects.h"
#include "core/gpu/shader_library.h"

namespace limn::frame {

struct TextureHandle {
  uint32_t resource = ~0u;
  uint32_t version = 0;
  uint32_t graph = 0;  ///< the graph that made it; another graph refuses it
  explicit operator bool() const { return resource != ~0u; }
  bool operator==(const TextureHandle&) const = default;
};
struct BufferHandle {
  uint32_t resource = ~0u;
  uint32_t version = 0;
  uint32_t graph = 0;
  explicit operator bool() const { return resource != ~0u; }
  bool operator==(const BufferHandle&) const = default;
};
struct ProgramHandle {
  uint32_t index = ~0u;
};

enum class Access : uint8_t {
  // reads
  sampled,    ///< texture unit
  imageLoad,  ///< image unit, read only
  uniformBuffer,
  storageLoad,  ///< shader storage block, read only
  vertexBuffer,
  indexBuffer,
  indirectBuffer,
  copySource,  ///< glCopyImageSubData, glCopyBufferSubData, readback
  // writes: the pass defines the whole contents
  imageStore,
  storageStore,
  colourAttachment,  ///< cleared or fully covered by the pass
  depthAttachment,
  copyTarget,  ///< also glClearTexImage, glBufferSubData; glGenerateTextureMipmap together with a `sampled`
               ///< read
  // read, modify, write
  imageLoadStore,
  storageLoadStore,  ///< also atomics
  colourBlend,       ///< attachment that keeps what earlier passes put there
  depthTest,         ///< depth attachment tested and possibly written on top of earlier contents
};
LIMN_API std::string_view name(Access access);

/// What a transient buffer is.
struct BufferDesc {
  size_t bytes = 0;
  bool operator==(const BufferDesc&) const = default;
};

class FrameGraph;

/// What a pass sees while it executes. GL state on entry: no program, no framebuffer, no vertex array; depth
/// test (less), blending (one, zero, add), culling (back faces), scissor, stencil test and polygon offset
/// off; colour and depth writes on; viewport undefined. A pass sets what it needs of these and need not
/// restore it; other state it puts back itself. Barriers inside a pass are not derived: what depends on a
/// shader's writes is another pass. In a debug context, using a handle in a way the pass did not declare
/// throws Error naming pass, resource and access.
class LIMN_API PassContext {
 public:
  const gpu::Device& device() const;
  const gl::Functions& gl() const;
  const gpu::Texture& texture(TextureHandle handle) const;
  const gpu::Buffer& buffer(BufferHandle handle) const;
  gpu::Program& program(ProgramHandle handle) const;

  void bindSampled(unsigned unit, TextureHandle handle, const gpu::Sampler* sampler = nullptr) const;
  /// layer -1: all layers.
  void bindImage(unsigned unit, TextureHandle handle, GLenum access, int level = 0, int layer = -1) const;
  void bindStorage(unsigned binding, BufferHandle handle) const;
  void bindUniform(unsigned binding, BufferHandle handle) const;
  /// A framebuffer over these textures, made once and kept; bound for drawing, viewport set to its size.
  struct Target {
    TextureHandle texture;
    int level = 0;
    int layer = -1;  ///< -1: all layers (layered rendering)
  };
  void bindFramebuffer(std::initializer_list<Target> colours, Target depth) const;
  void bindFramebuffer(std::initializer_list<Target> colours) const { bindFramebuffer(colours, Target{}); }
  /// For --stats: the pass draws so many triangles (on top of what it said before), views counted.
  void countTriangles(uint64_t triangles) const;
  /// glDispatchCompute over ceil(size / group).
  void dispatch(int width, int height, int depth, int groupX, int groupY, int groupZ = 1) const;

 private:
  friend class FrameGraph;
  explicit PassContext(FrameGraph& graph) : graph_(graph) {}
  FrameGraph& graph_;
};

/// Declares one pass. Valid until the next addPass().
class LIMN_API PassBuilder {
 public:
  PassBuilder& read(TextureHandle handle, Access access, std::string_view why);
  PassBuilder& read(BufferHandle handle, Access access, std::string_view why);
  /// The returned handle names the contents after this pass. With a read-modify-write access the pass also
  /// depends on the contents before it.
  [[nodiscard]] TextureHandle write(TextureHandle handle, Access access, std::string_view why);
  [[nodiscard]] BufferHandle write(BufferHandle handle, Access access, std::string_view why);
  /// A program the pass uses; compiled when the graph is prepared, and only if the pass is kept.
  ProgramHandle program(gpu::ProgramDesc desc);
  /// The outputs depend on nothing but the declared inputs: while none of those changed, the pass is skipped
  /// and its outputs are kept (in memory of their own, never aliased).
  PassBuilder& cacheable();
  /// The pass is wanted for what it does outside the graph; it is never left out and never served from the
  /// cache.
  PassBuilder& sideEffect();
  PassBuilder& execute(std::function<void(PassContext&)> function);

 private:
  friend class FrameGraph;
  PassBuilder(FrameGraph& graph, uint32_t pass) : graph_(graph), pass_(pass) {}
  FrameGraph& graph_;
  uint32_t pass_;
};

enum class PassState { run, cached, leftOut };
LIMN_API std::string_view name(PassState state);

/// One use of a resource by a pass.
struct AccessReport {
  std::string resource;
  Access access = Access::sampled;
  bool write = false;
  std::string why;
  std::optional<gpu::TextureDesc> texture;  ///< nothing: a buffer
  /// "name (access): why"
  LIMN_API std::string text() const;
};

/// One row of `--explain`.
struct PassReport {
  std::string name, technique;
  PassState state = PassState::run;
  std::string reason;                  ///< why it was left out or cached; empty for run
  int64_t bytes = 0;                   ///< of the resources the pass is the first to write
  uint64_t triangles = 0;              ///< drawn in the last frame
  std::vector<AccessReport> accesses;  ///< as they were declared
  GLbitfield barriers = 0;             ///< glMemoryBarrier bits issued before the pass
};

/// How the passes of a frame are timed.
enum class Timing {
  off,
  query,   ///< GL_TIME_ELAPSED; hardware
  finish,  ///< glFinish and a steady clock around each pass; software renderers, whose queries are false for
           ///< raster
};
LIMN_API std::string_view name(Timing timing);
/// finish on software renderers, query elsewhere.
LIMN_API Timing preferredTiming(const gpu::Device& device);

struct PassTime {
  std::string name, technique;
  double milliseconds = 0;
};

/// Textures and buffers that outlive a graph, so that a rebuilt graph finds its memory again.
class LIMN_API ResourcePool {
 public:
  explicit ResourcePool(gpu::Device& device);
  ~ResourcePool();
  ResourcePool(const ResourcePool&) = delete;
  ResourcePool& operator=(const ResourcePool&) = delete;
  /// Frees what no prepared graph uses.
  void trim();
  int64_t bytes() const;

 private:
  friend class FrameGraph;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

class LIMN_API FrameGraph {
 public:
  FrameGraph();
  ~FrameGraph();
  FrameGraph(const FrameGraph&) = delete;
  FrameGraph& operator=(const FrameGraph&) = delete;

  // --- declaring
  // -------------------------------------------------------------------------------------------------
  TextureHandle createTexture(std::string_view name, const gpu::TextureDesc& desc);
  BufferHandle createBuffer(std::string_view name, const BufferDesc& desc);
  /// Resources owned elsewhere. The object must outlive the graph; its id may change between frames.
  /// Contents count as changed when touch() is called, which invalidates the cacheable passes that depend on
  /// it. One object is imported once. What shaders outside the graph wrote to it must be visible
  /// (glMemoryBarrier) already.
  TextureHandle importTexture(std::string_view name, const gpu::Texture& texture);
  BufferHandle importBuffer(std::string_view name, const gpu::Buffer& buffer);

  /// `technique`: whose pass it is, "core" for the core's own. Names are unique per technique; a repeated one
  /// gets a number appended.
  PassBuilder addPass(std::string_view name, std::string_view technique = "core");
  /// Records a pass that was not even declared because the scene does not need it (for --explain).
  void leaveOut(std::string_view name, std::string_view technique, std::string_view reason);
  /// What the frame is for: passes that contribute to none of these outputs are left out.
  void output(TextureHandle handle);
  void output(BufferHandle handle);

  const gpu::TextureDesc& desc(TextureHandle handle) const;
  /// What a declared pass reads or leaves behind in one of its textures: `access` counts as
  /// PassReport::accesses does. Null where there is no such pass or access, or the access is to a buffer.
  TextureHandle find(std::string_view technique, std::string_view pass, size_t access) const;

  // --- planning (no OpenGL)
  // --------------------------------------------------------------------------------------
  /// Orders, culls, derives barriers, assigns memory. Throws Error listing every problem at once (reads of
  /// contents nobody writes, double writes, foreign handles). Called by prepare(); public for tests and
  /// `--explain`.
  void plan();
  std::vector<PassReport> explain() const;  ///< in execution order, left-out passes last
  std::string graphviz() const;
  /// glMemoryBarrier bits issued after the last pass, so that outputs and imported resources that shaders
  /// wrote can be used outside by any means.
  GLbitfield finalBarriers() const;
  int64_t transientBytes() const;  ///< with aliasing; buffers count with their size class
  int64_t transientBytesUnaliased() const;

  // --- running
  // ---------------------------------------------------------------------------------------------------
  /// Called before each program that is compiled: how many were, of how many.
  using CompileProgress = std::function<void(int compiled, int wanted)>;
  /// plan(), then compiles the programs and allocates the resources of the passes that are kept.
  void prepare(gpu::Device& device, gpu::ShaderLibrary& shaders, ResourcePool& pool,
               const CompileProgress& progress = {});
  /// The contents of an imported resource, or the object behind it, changed.
  void touch(TextureHandle imported);
  void touch(BufferHandle imported);
  /// Forgets every cached result (after a shader was reloaded, for example).
  void invalidate();
  /// Asked before each pass that runs.
  using Cancelled = std::function<bool()>;
  /// Runs one frame. Needs prepare() and its context current. When a pass throws, cached results are
  /// forgotten. False: `cancelled` said so, and the outputs are worth nothing; of the cached results only those
  /// that the passes left over would have changed are forgotten.
  bool execute(Timing timing = Timing::off, const Cancelled& cancelled = {});
  /// The passes that ran in the last frame executed with timing, in order. Timing::query blocks here until
  /// the results are there, never in execute().
  std::vector<PassTime> passTimes();
  /// After prepare(): the object behind a handle, for readback.
  const gpu::Texture& texture(TextureHandle handle) const;
  const gpu::Buffer& buffer(BufferHandle handle) const;

 private:
  friend class PassBuilder;
  friend class PassContext;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::frame
