#include <fmt/format.h>

#include <atomic>

#include "core/base/error.h"
#include "core/frame/private/access.h"
#include "core/frame/private/graph_data.h"

namespace limn::frame {
namespace {

/// Tells handles of graphs apart, also those of a graph that is gone, in whose memory another one may lie.
uint32_t newTag() {
  static std::atomic<uint32_t> graphs = 0;
  return ++graphs;
}

template <class Handle>
constexpr bool kIsTexture = std::is_same_v<Handle, TextureHandle>;
template <class Handle>
constexpr const char* kKindName = kIsTexture<Handle> ? "texture" : "buffer";

/// Empty when the handle names a resource of this graph, otherwise what is wrong with it.
template <class Handle>
std::string handleProblem(const Graph& graph, Handle handle) {
  if (!handle) return fmt::format("a null {} handle", kKindName<Handle>);
  if (handle.graph != graph.tag || handle.resource >= graph.resources.size() ||
      graph.resources[handle.resource].texture != kIsTexture<Handle> ||
      handle.version >= graph.resources[handle.resource].versions.size()) {
    return fmt::format("a {} handle of another graph", kKindName<Handle>);
  }
  return {};
}

template <class Handle>
bool accepts(Graph& graph, uint32_t pass, Handle handle, Access access, bool write, std::string_view why) {
  const char* verb = write ? "writes" : "reads";
  const std::string wrong = handleProblem(graph, handle);
  if (!wrong.empty()) {
    graph.problems.push_back(fmt::format("pass '{}' {} {} ({})", graph.title(pass), verb, wrong, why));
    return false;
  }
  const bool fits = kIsTexture<Handle> ? fitsTexture(access) : fitsBuffer(access);
  if (!fits || isWrite(access) != write) {
    graph.problems.push_back(fmt::format(
        "pass '{}' {} {} '{}' as {}, which is no {} of a {}", graph.title(pass), verb, kKindName<Handle>,
        graph.resources[handle.resource].name, name(access), write ? "write" : "read", kKindName<Handle>));
    return false;
  }
  return true;
}

template <class Handle>
void declareRead(Graph& graph, uint32_t pass, Handle handle, Access access, std::string_view why) {
  graph.planned = false;
  graph.passes[pass].refused = !accepts(graph, pass, handle, access, false, why);
  if (graph.passes[pass].refused) return;
  graph.passes[pass].accesses.push_back(
      {handle.resource, handle.version, kNoIndex, access, std::string(why)});
  graph.resources[handle.resource].versions[handle.version].readers.push_back(pass);
}

template <class Handle>
Handle declareWrite(Graph& graph, uint32_t pass, Handle handle, Access access, std::string_view why) {
  graph.planned = false;
  graph.passes[pass].refused = !accepts(graph, pass, handle, access, true, why);
  if (graph.passes[pass].refused) return handle;
  Resource& resource = graph.resources[handle.resource];
  const auto next = static_cast<uint32_t>(resource.versions.size());
  Version& parent = resource.versions[handle.version];
  if (parent.overwriter == kNoIndex) {
    parent.overwriter = next;
  } else {
    const uint32_t other = resource.versions[parent.overwriter].producer;
    graph.problems.push_back(fmt::format("passes '{}' and '{}' both write on top of version {} of '{}'",
                                         graph.title(other), graph.title(pass), handle.version,
                                         resource.name));
  }
  resource.versions.push_back({pass, handle.version, kNoIndex, {}});
  graph.passes[pass].accesses.push_back({handle.resource, next, handle.version, access, std::string(why)});
  return {handle.resource, next, handle.graph};
}

void declareName(Graph& graph, uint32_t pass, NamedResource named) {
  std::vector<NamedResource>& names = graph.passes[pass].names;
  for (const NamedResource& other : names) {
    if (other.name == named.name) {
      graph.problems.push_back(
          fmt::format("pass '{}' has two resources named '{}'", graph.title(pass), named.name));
    }
  }
  names.push_back(std::move(named));
}

/// Names what was declared last.
void nameAccess(Graph& graph, uint32_t pass, const ShaderName& name) {
  const std::vector<ResourceAccess>& accesses = graph.passes[pass].accesses;
  if (accesses.empty() || graph.passes[pass].refused) return;
  const ResourceAccess& last = accesses.back();
  if (!isShaderAccess(last.access)) {
    graph.problems.push_back(fmt::format("pass '{}' has '{}' as {}, which no shader calls '{}'",
                                         graph.title(pass), graph.resources[last.resource].name,
                                         limn::frame::name(last.access), name.text));
  }
  declareName(graph, pass,
              {.name = std::string(name.text),
               .access = static_cast<uint32_t>(accesses.size() - 1),
               .level = name.mipLevel,
               .layer = name.mipLayer,
               .sampler = name.sampler});
}

template <class Handle>
void declareOutput(Graph& graph, Handle handle) {
  graph.planned = false;
  const std::string wrong = handleProblem(graph, handle);
  if (!wrong.empty()) {
    graph.problems.push_back("output of " + wrong);
    return;
  }
  graph.resources[handle.resource].outputs.push_back(handle.version);
}

template <class Handle>
Handle add(Graph& graph, Resource resource) {
  graph.planned = false;
  resource.texture = kIsTexture<Handle>;
  resource.versions.resize(1);
  graph.resources.push_back(std::move(resource));
  return {static_cast<uint32_t>(graph.resources.size() - 1), 0, graph.tag};
}

/// Two names for one object would hide the hazards between them.
void checkImportedOnce(Graph& graph, const void* object, std::string_view name) {
  for (const Resource& other : graph.resources) {
    if (other.importedTexture == object || other.importedBuffer == object) {
      graph.problems.push_back(
          fmt::format("'{}' and '{}' import the same object: import it once", other.name, name));
    }
  }
}

template <class Handle>
Resource& importedResource(Graph& graph, Handle handle) {
  const std::string wrong = handleProblem(graph, handle);
  if (!wrong.empty()) throw Error("frame graph: touch of " + wrong);
  Resource& resource = graph.resources[handle.resource];
  if (!resource.imported()) {
    throw Error(fmt::format("frame graph: touch of '{}', which is not imported", resource.name));
  }
  return resource;
}

}  // namespace

PassRole defaultRole(std::string_view technique) {
  return technique == "core" ? PassRole::core : PassRole::technique;
}

std::string Graph::title(uint32_t pass) const {
  const Pass& p = passes[pass];
  return p.technique == "core" ? p.name : p.technique + "/" + p.name;
}

FrameGraph::FrameGraph() : implementation_(std::make_unique<Implementation>()) {
  implementation_->tag = newTag();
}

FrameGraph::~FrameGraph() = default;

TextureHandle FrameGraph::createTexture(std::string_view name, const gpu::TextureDesc& desc) {
  Resource resource;
  resource.name = name;
  resource.textureDesc = gpu::resolved(desc);
  return add<TextureHandle>(*implementation_, std::move(resource));
}

BufferHandle FrameGraph::createBuffer(std::string_view name, const BufferDesc& desc) {
  Resource resource;
  resource.name = name;
  resource.bufferDesc = desc;
  return add<BufferHandle>(*implementation_, std::move(resource));
}

TextureHandle FrameGraph::importTexture(std::string_view name, const gpu::Texture& texture) {
  checkImportedOnce(*implementation_, &texture, name);
  Resource resource;
  resource.name = name;
  resource.importedTexture = &texture;
  return add<TextureHandle>(*implementation_, std::move(resource));
}

BufferHandle FrameGraph::importBuffer(std::string_view name, const gpu::Buffer& buffer) {
  checkImportedOnce(*implementation_, &buffer, name);
  Resource resource;
  resource.name = name;
  resource.importedBuffer = &buffer;
  return add<BufferHandle>(*implementation_, std::move(resource));
}

PassBuilder FrameGraph::addPass(std::string_view name, std::string_view technique) {
  Graph& graph = *implementation_;
  graph.planned = false;
  const auto taken = [&](const std::string& candidate) {
    for (const Pass& pass : graph.passes) {
      if (pass.technique == technique && pass.name == candidate) return true;
    }
    return false;
  };
  std::string unique(name);
  for (int number = 2; taken(unique); ++number) unique = fmt::format("{} {}", name, number);
  Pass& pass = graph.passes.emplace_back();
  pass.name = std::move(unique);
  pass.technique = technique;
  pass.role = defaultRole(technique);
  return {*this, static_cast<uint32_t>(graph.passes.size() - 1)};
}

void FrameGraph::leaveOut(std::string_view name, std::string_view technique, std::string_view reason) {
  implementation_->leftOut.push_back({std::string(name), std::string(technique), std::string(reason)});
}

void FrameGraph::output(TextureHandle handle) {
  declareOutput(*implementation_, handle);
}

void FrameGraph::output(BufferHandle handle) {
  declareOutput(*implementation_, handle);
}

const gpu::TextureDesc& FrameGraph::desc(TextureHandle handle) const {
  const std::string wrong = handleProblem(*implementation_, handle);
  if (!wrong.empty()) throw Error("frame graph: description of " + wrong);
  const Resource& resource = implementation_->resources[handle.resource];
  return resource.importedTexture ? resource.importedTexture->desc() : resource.textureDesc;
}

TextureHandle FrameGraph::find(std::string_view technique, std::string_view pass, size_t access) const {
  const Graph& graph = *implementation_;
  for (const Pass& p : graph.passes) {
    if (p.technique != technique || p.name != pass || access >= p.accesses.size()) continue;
    const ResourceAccess& found = p.accesses[access];
    if (!graph.resources[found.resource].texture) return {};
    return {found.resource, found.version, graph.tag};
  }
  return {};
}

void FrameGraph::touch(TextureHandle imported) {
  ++importedResource(*implementation_, imported).revision;
  // The object may have been made anew, even under the same name.
  std::erase_if(implementation_->framebuffers, [&](const auto& entry) {
    for (const AttachmentKey& key : entry.first) {
      if (key.resource == imported.resource) return true;
    }
    return false;
  });
}

void FrameGraph::touch(BufferHandle imported) {
  ++importedResource(*implementation_, imported).revision;
}

PassBuilder& PassBuilder::read(TextureHandle handle, Access access, std::string_view why) {
  declareRead(*graph_.implementation_, pass_, handle, access, why);
  return *this;
}

PassBuilder& PassBuilder::read(BufferHandle handle, Access access, std::string_view why) {
  declareRead(*graph_.implementation_, pass_, handle, access, why);
  return *this;
}

TextureHandle PassBuilder::write(TextureHandle handle, Access access, std::string_view why) {
  return declareWrite(*graph_.implementation_, pass_, handle, access, why);
}

BufferHandle PassBuilder::write(BufferHandle handle, Access access, std::string_view why) {
  return declareWrite(*graph_.implementation_, pass_, handle, access, why);
}

PassBuilder& PassBuilder::read(TextureHandle handle, Access access, const ShaderName& name,
                               std::string_view why) {
  return read(handle, access, why).also(name);
}

PassBuilder& PassBuilder::read(BufferHandle handle, Access access, const ShaderName& name,
                               std::string_view why) {
  return read(handle, access, why).also(name);
}

TextureHandle PassBuilder::write(TextureHandle handle, Access access, const ShaderName& name,
                                 std::string_view why) {
  const TextureHandle written = write(handle, access, why);
  also(name);
  return written;
}

BufferHandle PassBuilder::write(BufferHandle handle, Access access, const ShaderName& name,
                                std::string_view why) {
  const BufferHandle written = write(handle, access, why);
  also(name);
  return written;
}

PassBuilder& PassBuilder::also(const ShaderName& name) {
  nameAccess(*graph_.implementation_, pass_, name);
  return *this;
}

PassBuilder& PassBuilder::constant(std::string_view name, const gpu::Buffer& buffer) {
  declareName(*graph_.implementation_, pass_, {.name = std::string(name), .buffer = &buffer});
  return *this;
}

PassBuilder& PassBuilder::constant(std::string_view name, const gpu::Texture& texture) {
  declareName(*graph_.implementation_, pass_, {.name = std::string(name), .texture = &texture});
  return *this;
}

SlotHandle PassBuilder::slot(std::string_view name) {
  declareName(*graph_.implementation_, pass_, {.name = std::string(name)});
  return {static_cast<uint32_t>(graph_.implementation_->passes[pass_].names.size() - 1)};
}

ProgramHandle PassBuilder::program(gpu::ProgramDesc desc) {
  Graph& graph = *graph_.implementation_;
  graph.programs.push_back({.desc = std::move(desc), .pass = pass_, .program = {}, .places = {}});
  const auto index = static_cast<uint32_t>(graph.programs.size() - 1);
  graph.passes[pass_].programs.push_back(index);
  return {index};
}

PassBuilder& PassBuilder::cacheable() {
  graph_.implementation_->passes[pass_].cacheable = true;
  return *this;
}

PassBuilder& PassBuilder::sideEffect() {
  graph_.implementation_->passes[pass_].sideEffect = true;
  return *this;
}

PassBuilder& PassBuilder::role(PassRole role) {
  graph_.implementation_->passes[pass_].role = role;
  return *this;
}

PassBuilder& PassBuilder::execute(std::function<void(PassContext&)> function) {
  graph_.implementation_->passes[pass_].function = std::move(function);
  return *this;
}

}  // namespace limn::frame
