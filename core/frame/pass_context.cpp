#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "core/base/error.h"
#include "core/frame/access.h"
#include "core/frame/graph_data.h"

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
const Resource& use(const Graph& graph, Handle handle, std::string_view what,
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

const Resource& useAsImage(const Graph& graph, TextureHandle handle, GLenum access) {
  switch (access) {
    case GL_READ_ONLY:
      return use(graph, handle, "loads from image", {Access::imageLoad, Access::imageLoadStore});
    case GL_WRITE_ONLY:
      return use(graph, handle, "stores to image", {Access::imageStore, Access::imageLoadStore});
    default:
      return use(graph, handle, "loads from and stores to image", {Access::imageLoadStore});
  }
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
  return *use(*graph_.implementation_, handle, "uses texture", {}).textureObject;
}

const gpu::Buffer& PassContext::buffer(BufferHandle handle) const {
  return *use(*graph_.implementation_, handle, "uses buffer", {}).bufferObject;
}

gpu::Program& PassContext::program(ProgramHandle handle) const {
  const Graph& graph = *graph_.implementation_;
  if (handle.index >= graph.programs.size() || graph.programs[handle.index].pass != graph.current) {
    throw Error(fmt::format("pass '{}' uses a program that it did not declare", graph.title(graph.current)));
  }
  return *graph.programs[handle.index].program;
}

void PassContext::bindSampled(unsigned unit, TextureHandle handle, const gpu::Sampler* sampler) const {
  const Resource& resource = use(*graph_.implementation_, handle, "samples texture", {Access::sampled});
  gl().BindTextureUnit(unit, resource.id());
  gl().BindSampler(unit, sampler != nullptr ? sampler->id() : 0);
}

void PassContext::bindImage(unsigned unit, TextureHandle handle, GLenum access, int level, int layer) const {
  const Resource& resource = useAsImage(*graph_.implementation_, handle, access);
  gl().BindImageTexture(unit, resource.id(), level, layer < 0 ? GL_TRUE : GL_FALSE, std::max(layer, 0),
                        access, resource.textureObject->desc().format);
}

void PassContext::bindStorage(unsigned binding, BufferHandle handle) const {
  const Resource& resource = use(*graph_.implementation_, handle, "binds storage buffer",
                                 {Access::storageLoad, Access::storageStore, Access::storageLoadStore});
  // The declared size, not the pool's: length() of an unsized array in a shader counts what was asked for.
  const size_t bytes = resource.bufferDesc.bytes;
  if (bytes == 0) {
    gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, resource.id());
  } else {
    gl().BindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, resource.id(), 0, static_cast<GLsizeiptr>(bytes));
  }
}

void PassContext::bindUniform(unsigned binding, BufferHandle handle) const {
  const Resource& resource =
      use(*graph_.implementation_, handle, "binds uniform buffer", {Access::uniformBuffer});
  gl().BindBufferBase(GL_UNIFORM_BUFFER, binding, resource.id());
}

void PassContext::bindFramebuffer(std::initializer_list<Target> colours, Target depth) const {
  Graph& graph = *graph_.implementation_;
  if (colours.size() > max_colour_attachments || (colours.size() == 0 && !depth.texture)) {
    throw Error(
        fmt::format("pass '{}' binds a framebuffer of {} colours{}: accepted are 1 to {} colours, or a depth",
                    graph.title(graph.current), colours.size(), depth.texture ? "" : " and no depth",
                    max_colour_attachments));
  }
  for (const Target& colour : colours) {
    use(graph, colour.texture, "draws to", {Access::colourAttachment, Access::colourBlend});
  }
  if (depth.texture)
    use(graph, depth.texture, "draws depth to", {Access::depthAttachment, Access::depthTest});
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
  gl().DispatchCompute(groups(width, groupX), groups(height, groupY), groups(depth, groupZ));
}

}  // namespace limn::frame
