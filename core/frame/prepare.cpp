// Programs and memory for the passes that are kept.
#include <fmt/format.h>

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/frame/private/graph_data.h"
#include "core/frame/private/resource_pool.h"

namespace limn::frame {
namespace {

/// Not every back end can make what OpenGL calls a debug context, but messages are switched on in all.
bool isDebugContext(const gl::Functions& gl) {
  GLint flags = 0;
  gl.GetIntegerv(GL_CONTEXT_FLAGS, &flags);
  return (flags & GL_CONTEXT_FLAG_DEBUG_BIT) != 0 || gl.IsEnabled(GL_DEBUG_OUTPUT) == GL_TRUE;
}

std::set<gpu::ProgramDesc> missingPrograms(const Graph& graph, const gpu::ShaderLibrary& shaders) {
  std::set<gpu::ProgramDesc> missing;
  for (uint32_t p : graph.order) {
    for (uint32_t index : graph.passes[p].programs) {
      if (!shaders.has(graph.programs[index].desc)) missing.insert(graph.programs[index].desc);
    }
  }
  return missing;
}

void compilePrograms(Graph& graph, gpu::ShaderLibrary& shaders, const FrameGraph::CompileProgress& progress) {
  const int wanted = progress ? static_cast<int>(missingPrograms(graph, shaders).size()) : 0;
  int compiled = 0;
  for (uint32_t p : graph.order) {
    if (!graph.passes[p].function) {
      throw Error(fmt::format("frame graph: pass '{}' has no function to execute", graph.title(p)));
    }
    for (uint32_t index : graph.passes[p].programs) {
      const gpu::ProgramDesc& desc = graph.programs[index].desc;
      if (progress && !shaders.has(desc)) progress(compiled++, wanted);
      graph.programs[index].program = &shaders.program(desc);
    }
  }
}

std::string labelOf(const Graph& graph, const Physical& physical) {
  std::string label;
  for (uint32_t r : physical.resources) {
    if (!label.empty()) label += " | ";
    label += graph.resources[r].name;
  }
  return label;
}

}  // namespace

void Graph::release() {
  framebuffers.clear();
  textures.clear();
  buffers.clear();
  for (Resource& r : resources) {
    r.textureObject = r.importedTexture;
    r.bufferObject = r.importedBuffer;
  }
  for (ProgramUse& use : programs) {
    use.program = nullptr;
    use.placesOf = 0;
  }
  for (Pass& pass : passes) {
    pass.valid = false;
    pass.run = true;
    pass.timed = false;
    pass.queries = {};
  }
  device = nullptr;
  firstFrame = true;
  lastTiming = Timing::off;
}

void FrameGraph::prepare(gpu::Device& device, gpu::ShaderLibrary& shaders, ResourcePool& pool,
                         const CompileProgress& progress) {
  Graph& graph = *implementation_;
  graph.release();
  plan();
  compilePrograms(graph, shaders, progress);
  // What no graph uses any more is freed before more memory is taken, or that of two graphs would be held at
  // once.
  ResourcePool::Implementation& kept = *pool.implementation_;
  const size_t count = graph.physicals.size();
  std::vector<std::shared_ptr<gpu::Texture>> textures(count);
  std::vector<std::shared_ptr<gpu::Buffer>> buffers(count);
  for (size_t i = 0; i < count; ++i) {
    const Physical& physical = graph.physicals[i];
    if (physical.texture)
      textures[i] = kept.findTexture(labelOf(graph, physical), physical.textureDesc);
    else
      buffers[i] = kept.findBuffer(labelOf(graph, physical), physical.bufferBytes);
  }
  pool.trim();
  for (size_t i = 0; i < count; ++i) {
    const Physical& physical = graph.physicals[i];
    if (physical.texture) {
      if (!textures[i]) textures[i] = kept.makeTexture(labelOf(graph, physical), physical.textureDesc);
      graph.textures.push_back(std::move(textures[i]));
    } else {
      if (!buffers[i]) buffers[i] = kept.makeBuffer(labelOf(graph, physical), physical.bufferBytes);
      graph.buffers.push_back(std::move(buffers[i]));
    }
    for (uint32_t r : physical.resources) {
      if (physical.texture) graph.resources[r].textureObject = graph.textures.back().get();
      if (!physical.texture) graph.resources[r].bufferObject = graph.buffers.back().get();
    }
  }
  findPlaces(graph, shaders);
  graph.checked = isDebugContext(device.gl());
  graph.device = &device;
}

const gpu::Texture& FrameGraph::texture(TextureHandle handle) const {
  const Graph& graph = *implementation_;
  desc(handle);  // refuses a foreign handle
  const gpu::Texture* texture = graph.resources[handle.resource].textureObject;
  if (texture == nullptr) {
    throw Error(
        fmt::format("frame graph: texture '{}' has no memory: the graph is not prepared or nothing uses it",
                    graph.resources[handle.resource].name));
  }
  return *texture;
}

const gpu::Buffer& FrameGraph::buffer(BufferHandle handle) const {
  const Graph& graph = *implementation_;
  if (handle.graph != graph.tag || handle.resource >= graph.resources.size() ||
      graph.resources[handle.resource].texture) {
    throw Error("frame graph: contents of a buffer handle of another graph");
  }
  const gpu::Buffer* buffer = graph.resources[handle.resource].bufferObject;
  if (buffer == nullptr) {
    throw Error(
        fmt::format("frame graph: buffer '{}' has no memory: the graph is not prepared or nothing uses it",
                    graph.resources[handle.resource].name));
  }
  return *buffer;
}

}  // namespace limn::frame
