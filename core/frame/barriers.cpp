// Memory barriers, from OpenGL 4.5 core, section 7.13.2.
//
// Writes by shaders to images and storage blocks become visible to a later access only through the
// glMemoryBarrier bit of that access. Such writes are also not ordered after earlier reads of the same
// memory; the barrier bit of the write does that. Every other write (attachments, copies) is in command order
// already. A barrier is global: one bit covers every earlier shader write, whatever it went to.
#include <array>
#include <bit>
#include <vector>

#include "core/frame/private/access.h"
#include "core/frame/private/graph_data.h"

namespace limn::frame {
namespace {

constexpr int64_t kNever = -1;

/// Follows the accesses to every object in time. Times count passes.
class Hazards {
 public:
  explicit Hazards(size_t objects) : written_(objects, kNever), read_(objects, kNever) {}

  /// The bits needed now, before `access` to `object`.
  GLbitfield needed(size_t object, Access access, bool texture) const {
    const GLbitfield bit = barrierBit(access, texture);
    const bool afterWrite = !covered(bit, written_[object]);
    const bool afterRead = isShaderWrite(access) && !covered(bit, read_[object]);
    return afterWrite || afterRead ? bit : 0;
  }
  void issue(GLbitfield bits) {
    for (; bits != 0; bits &= bits - 1) issued_[std::countr_zero(bits)] = now_;
  }
  /// Whole contents replaced by a write in command order: it comes after all earlier accesses, and later ones
  /// after it.
  void replace(size_t object) { written_[object] = read_[object] = kNever; }
  void write(size_t object) { written_[object] = now_; }
  void read(size_t object) { read_[object] = now_; }
  void advance() { ++now_; }

 private:
  bool covered(GLbitfield bit, int64_t time) const {
    return time == kNever || issued_[std::countr_zero(bit)] > time;
  }
  int64_t now_ = 0;
  std::vector<int64_t> written_, read_;  ///< last shader write, last read
  std::array<int64_t, 32> issued_{};
};

/// Transient resources that share memory are one object.
size_t objectOf(const Graph& graph, uint32_t resource) {
  const Resource& r = graph.resources[resource];
  return r.imported() ? graph.physicals.size() + resource : r.physical;
}

bool leavesTheGraph(const Resource& r) {
  return r.first != kNoIndex && (r.imported() || !r.outputs.empty());
}

constexpr std::array kTextureUses{Access::sampled, Access::imageLoad, Access::copySource,
                                  Access::colourBlend};
constexpr std::array kBufferUses{Access::uniformBuffer, Access::storageLoad,    Access::vertexBuffer,
                                 Access::indexBuffer,   Access::indirectBuffer, Access::copySource};

template <class Visit>
void forUsesOutside(const Graph& graph, Visit&& visit) {
  for (uint32_t i = 0; i < graph.resources.size(); ++i) {
    const Resource& r = graph.resources[i];
    if (!leavesTheGraph(r)) continue;
    const std::span<const Access> uses =
        r.texture ? std::span<const Access>(kTextureUses) : std::span<const Access>(kBufferUses);
    for (Access use : uses) visit(objectOf(graph, i), use, r.texture);
  }
}

GLbitfield stepPass(const Graph& graph, const Pass& pass, Hazards& hazards) {
  GLbitfield bits = 0;
  for (const ResourceAccess& a : pass.accesses) {
    bits |= hazards.needed(objectOf(graph, a.resource), a.access, graph.resources[a.resource].texture);
  }
  hazards.issue(bits);
  for (const ResourceAccess& a : pass.accesses) {
    const size_t object = objectOf(graph, a.resource);
    if (a.write() && !isShaderWrite(a.access) && !isReadModifyWrite(a.access)) hazards.replace(object);
  }
  for (const ResourceAccess& a : pass.accesses) {
    if (!a.write()) hazards.read(objectOf(graph, a.resource));
    if (isShaderWrite(a.access)) hazards.write(objectOf(graph, a.resource));
  }
  hazards.advance();
  return bits;
}

/// What the caller does with outputs and imported resources between two frames: anything.
GLbitfield stepOutside(const Graph& graph, Hazards& hazards) {
  GLbitfield bits = 0;
  forUsesOutside(
      graph, [&](size_t object, Access use, bool texture) { bits |= hazards.needed(object, use, texture); });
  hazards.issue(bits);
  forUsesOutside(graph, [&](size_t object, Access, bool) { hazards.read(object); });
  hazards.advance();
  return bits;
}

/// One more frame: the bits before each pass of the order and after the last.
std::vector<GLbitfield> stepFrame(const Graph& graph, Hazards& hazards) {
  std::vector<GLbitfield> bits;
  for (uint32_t p : graph.order) bits.push_back(stepPass(graph, graph.passes[p], hazards));
  bits.push_back(stepOutside(graph, hazards));
  return bits;
}

}  // namespace

void deriveBarriers(Graph& graph) {
  // The first frame finds nothing pending, so the list is that of a later frame, when it repeats itself.
  // Should it alternate instead, all bits of an alternation are issued: more bits never make another one
  // necessary.
  constexpr int frames = 8;
  Hazards hazards(graph.physicals.size() + graph.resources.size());
  std::vector<GLbitfield> bits = stepFrame(graph, hazards);
  for (int frame = 1; frame < frames; ++frame) {
    std::vector<GLbitfield> next = stepFrame(graph, hazards);
    const bool repeats = frame > 1 && next == bits;
    if (!repeats && frame >= frames / 2) {
      for (size_t i = 0; i < bits.size(); ++i) next[i] |= bits[i];
    }
    bits = std::move(next);
    if (repeats) break;
  }
  for (size_t i = 0; i < graph.order.size(); ++i) graph.passes[graph.order[i]].barriers = bits[i];
  graph.finalBarriers = bits.back();
}

}  // namespace limn::frame
