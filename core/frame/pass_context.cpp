#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "core/base/error.h"
#include "core/frame/private/access.h"
#include "core/frame/private/graph_data.h"

namespace limn::frame {
namespace {

template <class Handle>
const Resource& resourceOf(const Graph& graph, Handle handle) {
  constexpr bool texture = std::is_same_v<Handle, TextureHandle>;
  if (handle.graph != graph.tag || handle.resource >= graph.resources.size() ||
      graph.resources[handle.resource].texture != texture) {
    throw Error(fmt::format("pass '{}' uses a {} handle that is null or of another graph",
                            graph.title(graph.current), texture ? "texture" : "buffer"));
  }
  const Resource& resource = graph.resources[handle.resource];
  if (resource.textureObject == nullptr && resource.bufferObject == nullptr) {
    throw Error(fmt::format("pass '{}' uses '{}', which it did not declare and which has no memory",
                            graph.title(graph.current), resource.name));
  }
  return resource;
}

template <class Handle>
bool declared(const Graph& graph, Handle handle, std::initializer_list<Access> accesses) {
  const auto& list = graph.passes[graph.current].accesses;
  return std::any_of(list.begin(), list.end(), [&](const ResourceAccess& a) {
    if (a.resource != handle.resource || (a.version != handle.version && a.parent != handle.version))
      return false;
    return accesses.size() == 0 || std::find(accesses.begin(), accesses.end(), a.access) != accesses.end();
  });
}

/// The resource, after comparing its use with what the pass declared (in debug contexts). No accesses: any
/// will do.
template <class Handle>
const Resource& resourceFor(const Graph& graph, Handle handle, std::string_view what,
                            std::initializer_list<Access> accesses) {
  const Resource& resource = resourceOf(graph, handle);
  if (graph.checked && !declared(graph, handle, accesses)) {
    std::string expected;
    for (Access access : accesses) {
      if (!expected.empty()) expected += " or ";
      expected += name(access);
    }
    throw Error(fmt::format("pass '{}' {} '{}' (version {}), which it did not declare{}{}",
                            graph.title(graph.current), what, resource.name, handle.version,
                            expected.empty() ? "" : " as ", expected));
  }
  return resource;
}

const FramebufferEntry& findFramebuffer(Graph& graph, std::span<const PassContext::Target> colours,
                                        const PassContext::Target& depth) {
  FramebufferKey key;
  const auto keyOf = [&](const PassContext::Target& target) {
    const Resource& r = graph.resources[target.texture.resource];
    return AttachmentKey{target.texture.resource, r.id(), target.level, target.layer};
  };
  for (size_t i = 0; i < colours.size(); ++i) key[i] = keyOf(colours[i]);
  if (depth.texture) key.back() = keyOf(depth);
  const auto found = graph.framebuffers.find(key);
  if (found != graph.framebuffers.end()) return found->second;

  const auto attachmentOf = [&](const PassContext::Target& target) {
    return gpu::Attachment{graph.resources[target.texture.resource].textureObject, target.level,
                           target.layer};
  };
  std::vector<gpu::Attachment> attachments;
  for (const PassContext::Target& colour : colours) attachments.push_back(attachmentOf(colour));
  const PassContext::Target& sized = colours.empty() ? depth : colours.front();
  const gpu::TextureDesc& desc = attachmentOf(sized).texture->desc();
  FramebufferEntry entry{gpu::Framebuffer(*graph.device, graph.title(graph.current), attachments,
                                          depth.texture ? attachmentOf(depth) : gpu::Attachment{}),
                         std::max(1, desc.width >> sized.level), std::max(1, desc.height >> sized.level)};
  return graph.framebuffers.emplace(key, std::move(entry)).first->second;
}

}  // namespace

const gpu::Device& PassContext::device() const {
  return *graph_.implementation_->device;
}

const gl::Functions& PassContext::gl() const {
  return graph_.implementation_->device->gl();
}

const gpu::Texture& PassContext::texture(TextureHandle handle) const {
  return *resourceFor(*graph_.implementation_, handle, "uses texture", {}).textureObject;
}

const gpu::Buffer& PassContext::buffer(BufferHandle handle) const {
  return *resourceFor(*graph_.implementation_, handle, "uses buffer", {}).bufferObject;
}

gpu::Program& PassContext::program(ProgramHandle handle) const {
  const Graph& graph = *graph_.implementation_;
  if (handle.index >= graph.programs.size() || graph.programs[handle.index].pass != graph.current) {
    throw Error(fmt::format("pass '{}' uses a program that it did not declare", graph.title(graph.current)));
  }
  return *graph.programs[handle.index].program;
}

void PassContext::bindFramebuffer(std::initializer_list<Target> colours, Target depth) const {
  Graph& graph = *graph_.implementation_;
  if (colours.size() > kMaxColourAttachments || (colours.size() == 0 && !depth.texture)) {
    throw Error(
        fmt::format("pass '{}' binds a framebuffer of {} colours{}: accepted are 1 to {} colours, or a depth",
                    graph.title(graph.current), colours.size(), depth.texture ? "" : " and no depth",
                    kMaxColourAttachments));
  }
  for (const Target& colour : colours) {
    resourceFor(graph, colour.texture, "draws to", {Access::colourAttachment, Access::colourBlend});
  }
  if (depth.texture)
    resourceFor(graph, depth.texture, "draws depth to", {Access::depthAttachment, Access::depthTest});
  const FramebufferEntry& entry = findFramebuffer(graph, {colours.begin(), colours.size()}, depth);
  gl().BindFramebuffer(GL_FRAMEBUFFER, entry.framebuffer.id());
  gl().Viewport(0, 0, entry.width, entry.height);
}

void PassContext::countTriangles(uint64_t triangles) const {
  Graph& graph = *graph_.implementation_;
  graph.passes[graph.current].triangles += triangles;
}

void PassContext::dispatch(int width, int height, int depth, int groupX, int groupY, int groupZ) const {
  const auto groups = [](int size, int group) { return static_cast<GLuint>((size + group - 1) / group); };
  const std::array<GLuint, 3> counts{groups(width, groupX), groups(height, groupY), groups(depth, groupZ)};
  Graph& graph = *graph_.implementation_;
  if (graph.program != kNoIndex) {
    graph.programs[graph.program].groups = counts;
    ++graph.programs[graph.program].dispatches;
  }
  gl().DispatchCompute(counts[0], counts[1], counts[2]);
}

void PassContext::dispatchRows(int64_t groups) const {
  if (groups <= 0) return;
  constexpr int64_t kLongest = 32768;
  const int64_t rows = (groups + kLongest - 1) / kLongest, length = (groups + rows - 1) / rows;
  dispatch(static_cast<int>(length), static_cast<int>(rows), 1, 1, 1);
}

}  // namespace limn::frame
