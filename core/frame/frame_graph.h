// Declares a frame as a graph of passes over typed handles.
//
// A pass states what it reads and writes, how (Access) and why. From that the graph orders the passes, leaves
// out those whose results are not needed (and says why), derives the memory barriers, places transient
// resources in a pool where disjoint lifetimes share memory, keeps the results of cacheable passes while
// their inputs do not change, times each pass, and prints itself.
//
// Handles are versions of a resource: write() returns the next version; a read names the version it needs. A
// pass that reads version k runs after the pass that wrote k and before the one that overwrites it.
// Independent passes run in the order of their declaration. Two passes that both overwrite the same version
// are an error that names both.
//
// The graph is built once and executed every frame; it must be rebuilt when the set of passes, a size or a
// parameter changes. Execution allocates nothing. A pass that is left out compiles no program and allocates
// no resource.
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

/// Identifies the contents of a texture between two writes.
struct TextureHandle {
  uint32_t resource = ~0u;
  uint32_t version = 0;
  uint32_t graph = 0;  ///< the graph that made it; another graph refuses it
  explicit operator bool() const { return resource != ~0u; }
  bool operator==(const TextureHandle&) const = default;
};
/// Identifies the contents of a buffer between two writes.
struct BufferHandle {
  uint32_t resource = ~0u;
  uint32_t version = 0;
  uint32_t graph = 0;
  explicit operator bool() const { return resource != ~0u; }
  bool operator==(const BufferHandle&) const = default;
};
/// Identifies a program of a pass, made by PassBuilder::program().
struct ProgramHandle {
  uint32_t index = ~0u;
};
/// Identifies a name in a pass's shaders to which the pass binds something different for each draw.
struct SlotHandle {
  uint32_t index = ~0u;
};

/// Holds the name by which the shaders of a pass know a resource: that of a sampler, an image or a block. No
/// binding numbers are declared; the graph asks the linked programs for the unit of each name.
struct ShaderName {
  std::string_view text;
  int mipLevel = 0;                       ///< of an image
  int mipLayer = -1;                      ///< of an image; -1: all layers
  const gpu::Sampler* sampler = nullptr;  ///< null: the texture's own sampling state

  constexpr ShaderName(const char* name) : text(name) {}
  constexpr ShaderName(std::string_view name) : text(name) {}
  /// Returns the same name for one mip level.
  constexpr ShaderName level(int value) const {
    ShaderName changed = *this;
    changed.mipLevel = value;
    return changed;
  }
  /// Returns the same name, sampled with `value`, which must outlive the graph.
  constexpr ShaderName sampledWith(const gpu::Sampler* value) const {
    ShaderName changed = *this;
    changed.sampler = value;
    return changed;
  }
};

/// Says how a pass uses a resource. Barriers, and what is bound to the names of shaders, follow from it.
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

/// Describes a transient buffer.
struct BufferDesc {
  size_t bytes = 0;
  bool operator==(const BufferDesc&) const = default;
};

/// Says what a pass is for; the cost of a frame is reported by role.
enum class PassRole : uint8_t {
  core,       ///< G-buffer, shading and other work of core in every frame
  map,        ///< rasterises the scene into maps that other passes read: shadows, light, surfaces
  filter,     ///< derives lookup data from maps: pyramids, summed-area tables, Fourier images
  technique,  ///< any other work of a technique, or of a service on behalf of techniques
};
LIMN_API std::string_view name(PassRole role);

class FrameGraph;

/// Gives a pass access to its resources while it executes. GL state on entry: no program, no framebuffer, no
/// vertex array; depth test (less), blending (one, zero, add), culling (back faces), scissor, stencil test
/// and polygon offset off; colour and depth writes on; viewport undefined. A pass sets what it needs of these
/// and need not restore it; it must restore all other state that it changes. Barriers inside a pass are not
/// derived: work that depends on a shader's writes belongs in another pass. In a debug context, using a
/// handle in a way the pass did not declare throws Error naming pass, resource and access.
class LIMN_API PassContext {
 public:
  const gpu::Device& device() const;
  const gl::Functions& gl() const;
  /// Returns the object behind a handle that the pass declared.
  const gpu::Texture& texture(TextureHandle handle) const;
  const gpu::Buffer& buffer(BufferHandle handle) const;

  /// Makes the program current, with everything that the pass named bound to it, and returns it so that plain
  /// uniforms can be set.
  gpu::Program& use(ProgramHandle handle) const;
  /// Binds a resource to a slot of the program in use; does nothing where that program does not have the
  /// name. Textures of the graph are bound as samplers or images, whichever the program declares.
  void bind(SlotHandle slot, TextureHandle texture, int level = 0, int layer = -1) const;
  void bind(SlotHandle slot, const gpu::Texture& texture, const gpu::Sampler* sampler = nullptr) const;
  /// Binds `bytes` bytes of a buffer from `offset` on to a slot; `bytes` 0 binds the whole buffer.
  void bind(SlotHandle slot, const gpu::Buffer& buffer, size_t offset = 0, size_t bytes = 0) const;

  /// Describes one attachment of bindFramebuffer().
  struct Target {
    TextureHandle texture;
    int level = 0;
    int layer = -1;  ///< -1: all layers (layered rendering)
  };
  /// Binds a framebuffer with these textures for drawing and sets the viewport to its size. The framebuffer
  /// is created once and kept.
  void bindFramebuffer(std::initializer_list<Target> colours, Target depth) const;
  void bindFramebuffer(std::initializer_list<Target> colours) const { bindFramebuffer(colours, Target{}); }
  /// Adds to the number of triangles that the pass draws, summed over all views, for --stats.
  void countTriangles(uint64_t triangles) const;
  /// Calls glDispatchCompute with ceil(size / group) groups.
  void dispatch(int width, int height, int depth, int groupX, int groupY, int groupZ = 1) const;
  /// Calls glDispatchCompute with `groups` work groups, or a few more, in rows of equal length: a driver need
  /// not take more than 65535 along an axis. glsl/numeric/work_items.glsl numbers them.
  void dispatchRows(int64_t groups) const;

 private:
  friend class FrameGraph;
  explicit PassContext(FrameGraph& graph) : graph_(graph) {}
  gpu::Program& program(ProgramHandle handle) const;
  FrameGraph& graph_;
};

/// Declares one pass. The builder is valid until the next addPass().
class LIMN_API PassBuilder {
 public:
  /// Declares a read that no shader makes by a name (attachments, vertices, indices, copies), or of a
  /// resource that is bound to a slot.
  PassBuilder& read(TextureHandle handle, Access access, std::string_view why);
  PassBuilder& read(BufferHandle handle, Access access, std::string_view why);
  /// Declares a read of a resource that the pass's programs call `name`.
  PassBuilder& read(TextureHandle handle, Access access, const ShaderName& name, std::string_view why);
  PassBuilder& read(BufferHandle handle, Access access, const ShaderName& name, std::string_view why);
  /// Declares a write and returns a handle to the contents after this pass. With a read-modify-write access
  /// the pass also depends on the contents before it.
  [[nodiscard]] TextureHandle write(TextureHandle handle, Access access, std::string_view why);
  [[nodiscard]] BufferHandle write(BufferHandle handle, Access access, std::string_view why);
  [[nodiscard]] TextureHandle write(TextureHandle handle, Access access, const ShaderName& name,
                                    std::string_view why);
  [[nodiscard]] BufferHandle write(BufferHandle handle, Access access, const ShaderName& name,
                                   std::string_view why);
  /// Adds another name for the resource that was read or written last, for example for another level of an
  /// image.
  PassBuilder& also(const ShaderName& name);
  /// Declares a resource outside the graph, which must outlive it. Neither the cache nor barriers follow it:
  /// where its contents change, a declared resource stands for it, or the CPU alone writes it and the pass is
  /// not cacheable.
  PassBuilder& constant(std::string_view name, const gpu::Buffer& buffer);
  PassBuilder& constant(std::string_view name, const gpu::Texture& texture);
  /// Declares a name to which PassContext::bind() binds something while the pass executes.
  SlotHandle slot(std::string_view name);
  /// Declares a program that the pass uses; it is compiled when the graph is prepared, and only if the pass
  /// is kept.
  ProgramHandle program(gpu::ProgramDesc desc);
  /// Declares that the outputs depend only on the declared inputs and programs: while none of those changes,
  /// the pass is skipped and its outputs are kept (in memory of their own, never aliased).
  PassBuilder& cacheable();
  /// Declares that the pass has effects outside the graph; it is never left out and never served from the
  /// cache.
  PassBuilder& sideEffect();
  /// Sets what the pass is for, if it differs from what addPass() assumes.
  PassBuilder& role(PassRole role);
  /// Sets what issues the pass's OpenGL commands; it is called in each frame in which the pass runs.
  PassBuilder& execute(std::function<void(PassContext&)> function);

 private:
  friend class FrameGraph;
  PassBuilder(FrameGraph& graph, uint32_t pass) : graph_(graph), pass_(pass) {}
  FrameGraph& graph_;
  uint32_t pass_;
};

/// Says what became of a pass in the last frame, or what the plan makes of it before the first one.
enum class PassState {
  run,
  cached,  ///< skipped: its results of an earlier frame are still valid
  leftOut  ///< nobody needs its results, or leaveOut() recorded it
};
LIMN_API std::string_view name(PassState state);

/// Describes one use of a resource by a pass.
struct AccessReport {
  std::string resource;
  Access access = Access::sampled;
  bool write = false;
  std::string why;
  std::optional<gpu::TextureDesc> texture;  ///< nothing: a buffer
  int64_t bytes = 0;                        ///< of the texture or the buffer, as declared
  /// Returns "name (access): why".
  LIMN_API std::string text() const;
};

/// Holds one row of `--explain`.
struct PassReport {
  std::string name, technique;
  PassRole role = PassRole::core;
  PassState state = PassState::run;
  std::string reason;                  ///< why it was left out or cached; empty for run
  int64_t bytes = 0;                   ///< of the resources the pass is the first to write
  uint64_t triangles = 0;              ///< drawn in the last frame
  std::vector<AccessReport> accesses;  ///< as they were declared
  GLbitfield barriers = 0;             ///< glMemoryBarrier bits issued before the pass
};

struct ProgramReport;  // core/frame/program_report.h

/// Says how the passes of a frame are timed.
enum class Timing {
  off,
  query,   ///< GL_TIME_ELAPSED; hardware
  finish,  ///< glFinish and a steady clock around each pass; software renderers, whose queries are wrong for
           ///< raster work
};
LIMN_API std::string_view name(Timing timing);
/// Returns Timing::finish on software renderers and Timing::query elsewhere.
LIMN_API Timing preferredTiming(const gpu::Device& device);

/// Holds the time of one pass in the last frame executed with timing.
struct PassTime {
  std::string name, technique;
  PassRole role = PassRole::core;
  double milliseconds = 0;
};

/// Holds textures and buffers that outlive a graph, so that a rebuilt graph reuses their memory. A graph that
/// is prepared takes what fits and frees what no prepared graph uses, before it makes the rest.
class LIMN_API ResourcePool {
 public:
  explicit ResourcePool(gpu::Device& device);
  ~ResourcePool();
  ResourcePool(const ResourcePool&) = delete;
  ResourcePool& operator=(const ResourcePool&) = delete;
  /// Frees everything that no prepared graph uses.
  void trim();
  int64_t bytes() const;

 private:
  friend class FrameGraph;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Holds a frame: declare passes and outputs, prepare() once, execute() each frame.
class LIMN_API FrameGraph {
 public:
  FrameGraph();
  ~FrameGraph();
  FrameGraph(const FrameGraph&) = delete;
  FrameGraph& operator=(const FrameGraph&) = delete;

  // Declaring.

  /// Creates a transient resource and returns its handle: it has no contents before a pass writes it, and may
  /// share memory with others.
  TextureHandle createTexture(std::string_view name, const gpu::TextureDesc& desc);
  BufferHandle createBuffer(std::string_view name, const BufferDesc& desc);
  /// Imports a resource owned elsewhere and returns its handle. The object must outlive the graph; its id may
  /// change between frames. Its contents count as changed when touch() is called, which invalidates the
  /// cacheable passes that depend on it. An object may be imported only once. Writes to it by shaders outside
  /// the graph must already be visible (glMemoryBarrier).
  TextureHandle importTexture(std::string_view name, const gpu::Texture& texture);
  BufferHandle importBuffer(std::string_view name, const gpu::Buffer& buffer);

  /// Adds a pass. `technique` is the pass's owner, "core" for core's own passes; the role is
  /// PassRole::technique or PassRole::core accordingly. Names are unique per technique; a repeated one gets a
  /// number appended.
  PassBuilder addPass(std::string_view name, std::string_view technique = "core");
  /// Records a pass that was not declared because the scene does not need it (for --explain).
  void leaveOut(std::string_view name, std::string_view technique, std::string_view reason);
  /// Declares an output of the frame; passes that contribute to no output are left out.
  void output(TextureHandle handle);
  void output(BufferHandle handle);

  /// Returns the description of a texture, imported ones included.
  const gpu::TextureDesc& desc(TextureHandle handle) const;
  /// Returns the contents that a declared pass reads from or leaves in one of its textures; `access` is an
  /// index as in PassReport::accesses. Null where there is no such pass or access, or the access is to a
  /// buffer.
  TextureHandle find(std::string_view technique, std::string_view pass, size_t access) const;

  // Planning, without OpenGL.

  /// Orders and culls the passes, derives barriers and assigns memory. Throws Error listing every problem at
  /// once (reads of contents that nobody writes, double writes, foreign handles). Called by prepare(); public
  /// for tests and `--explain`.
  void plan();
  std::vector<PassReport> explain() const;  ///< in execution order, left-out passes last
  /// Returns the programs of the passes that are kept, in execution order. Needs prepare().
  std::vector<ProgramReport> programs() const;
  std::string graphviz() const;  ///< the planned graph in the language of Graphviz
  /// Returns the glMemoryBarrier bits issued after the last pass, so that outputs and imported resources that
  /// shaders wrote can be used outside the graph in any way.
  GLbitfield finalBarriers() const;
  int64_t transientBytes() const;           ///< with aliasing; buffers count with their size class
  int64_t transientBytesUnaliased() const;  ///< what they were if no resources shared memory

  // Running.

  /// Reports progress: called before each program that is compiled, with the number already compiled and the
  /// total.
  using CompileProgress = std::function<void(int compiled, int wanted)>;
  /// Calls plan(), then compiles the programs and allocates the resources of the passes that are kept.
  void prepare(gpu::Device& device, gpu::ShaderLibrary& shaders, ResourcePool& pool,
               const CompileProgress& progress = {});
  /// Declares that the contents of an imported resource, or the object behind it, changed.
  void touch(TextureHandle imported);
  void touch(BufferHandle imported);
  /// Forgets every cached result.
  void invalidate();
  /// Says whether execution should stop; asked before each pass that runs. A GPU may have all earlier passes
  /// still to do then, as nothing waits for it: to stop what takes it long, this waits itself (glFinish).
  using Cancelled = std::function<bool()>;
  /// Runs one frame. Needs prepare() and its context current. When a pass throws, all cached results are
  /// forgotten. Returns false if `cancelled` stopped it: the outputs are then invalid, and of the cached
  /// results only those that the skipped passes would have changed are forgotten.
  bool execute(Timing timing = Timing::off, const Cancelled& cancelled = {});
  /// Returns the times of the passes that ran in the last frame executed with timing, in order. With
  /// Timing::query it blocks here, never in execute(), until the results are available.
  std::vector<PassTime> passTimes();
  /// Returns the object behind a handle, for readback; valid after prepare().
  const gpu::Texture& texture(TextureHandle handle) const;
  const gpu::Buffer& buffer(BufferHandle handle) const;

 private:
  friend class PassBuilder;
  friend class PassContext;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::frame
