// Binding by name: what a pass declared meets what its linked programs ask for.
#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/frame/private/access.h"
#include "core/frame/private/graph_data.h"
#include "core/frame/program_report.h"

namespace limn::frame {
namespace {

using Kind = gpu::ShaderResource::Kind;

/// What stands for an access in GLSL.
Kind kindOf(Access access) {
  switch (access) {
    case Access::sampled:
      return Kind::sampler;
    case Access::uniformBuffer:
      return Kind::uniformBlock;
    case Access::storageLoad:
    case Access::storageStore:
    case Access::storageLoadStore:
      return Kind::storageBlock;
    default:
      return Kind::image;
  }
}

/// Whether `named` can be bound as `kind`.
bool fits(const Pass& pass, const NamedResource& named, Kind kind) {
  if (named.slot()) return true;
  if (named.texture != nullptr) return kind == Kind::sampler;
  if (named.buffer != nullptr) return kind == Kind::uniformBlock || kind == Kind::storageBlock;
  return kindOf(pass.accesses[named.access].access) == kind;
}

std::string namesOf(const Pass& pass) {
  std::vector<std::string> names;
  for (const NamedResource& named : pass.names) names.push_back(named.name);
  return names.empty() ? "nothing" : joined(names, "and");
}

GLenum imageAccess(Access access) {
  switch (access) {
    case Access::imageLoad:
      return GL_READ_ONLY;
    case Access::imageStore:
      return GL_WRITE_ONLY;
    default:
      return GL_READ_WRITE;
  }
}

void placeImage(const gl::Functions& gl, GLuint unit, const Resource& resource, Access access, int level,
                int layer) {
  gl.BindImageTexture(unit, resource.id(), level, layer < 0 ? GL_TRUE : GL_FALSE, std::max(layer, 0),
                      imageAccess(access), resource.textureObject->desc().format);
}

void placeSampler(const gl::Functions& gl, GLuint unit, GLuint texture, const gpu::Sampler* sampler) {
  gl.BindTextureUnit(unit, texture);
  gl.BindSampler(unit, sampler != nullptr ? sampler->id() : 0);
}

/// Returns the bytes to bind of a whole buffer. Uniform blocks may state more than it holds, so they get its
/// room as well (0); of storage blocks length() of an unsized array counts what was asked for.
size_t wholeBytes(Kind kind, size_t bytes) {
  return kind == Kind::storageBlock ? bytes : 0;
}

void placeBlock(const gl::Functions& gl, Kind kind, GLuint unit, GLuint buffer, size_t offset, size_t bytes) {
  const GLenum target = kind == Kind::uniformBlock ? GL_UNIFORM_BUFFER : GL_SHADER_STORAGE_BUFFER;
  if (bytes == 0) {
    gl.BindBufferBase(target, unit, buffer);
  } else {
    gl.BindBufferRange(target, unit, buffer, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes));
  }
}

void bindPlace(Graph& graph, const Pass& pass, const Place& place) {
  const gl::Functions& gl = graph.device->gl();
  const NamedResource& named = pass.names[place.name];
  if (named.slot()) return;
  if (named.texture != nullptr) return placeSampler(gl, place.unit, named.texture->id(), named.sampler);
  if (named.buffer != nullptr) {
    return placeBlock(gl, place.kind, place.unit, named.buffer->id(), 0,
                      wholeBytes(place.kind, named.buffer->size()));
  }
  const ResourceAccess& access = pass.accesses[named.access];
  const Resource& resource = graph.resources[access.resource];
  switch (place.kind) {
    case Kind::sampler:
      return placeSampler(gl, place.unit, resource.id(), named.sampler);
    case Kind::image:
      return placeImage(gl, place.unit, resource, access.access, named.level, named.layer);
    case Kind::uniformBlock:
    case Kind::storageBlock: {
      const gpu::Buffer* imported = resource.importedBuffer;  // else the declared size, not the pool's
      return placeBlock(gl, place.kind, place.unit, resource.id(), 0,
                        wholeBytes(place.kind, imported ? imported->size() : resource.bufferDesc.bytes));
    }
  }
}

/// Where the program in use has the slot; null where it has no such name.
Place* placeOf(Graph& graph, SlotHandle slot) {
  if (graph.program == kNoIndex || graph.programs[graph.program].pass != graph.current ||
      slot.index >= graph.passes[graph.current].names.size()) {
    throw Error(fmt::format("pass '{}' fills a slot without a program, or one that it did not announce",
                            graph.title(graph.current)));
  }
  for (Place& place : graph.programs[graph.program].places)
    if (place.name == slot.index) return &place;
  return nullptr;
}

/// Returns which access of the pass that executes reads or makes the contents, or else writes on top of them.
uint32_t accessTo(const Graph& graph, TextureHandle handle) {
  const std::vector<ResourceAccess>& all = graph.passes[graph.current].accesses;
  const auto find = [&](uint32_t ResourceAccess::*version) {
    return std::ranges::find_if(all, [&](const ResourceAccess& a) {
      return a.resource == handle.resource && a.*version == handle.version;
    });
  };
  auto found = find(&ResourceAccess::version);
  if (found == all.end()) found = find(&ResourceAccess::parent);
  if (found == all.end()) {
    throw Error(fmt::format("pass '{}' binds '{}' (version {}), which it did not declare",
                            graph.title(graph.current), graph.resources[handle.resource].name,
                            handle.version));
  }
  return static_cast<uint32_t>(found - all.begin());
}

}  // namespace

void findPlaces(Graph& graph, ProgramUse& use, std::vector<std::string>& problems) {
  const Pass& pass = graph.passes[use.pass];
  use.places.clear();
  use.placesOf = use.program->serial();
  for (const gpu::ShaderResource& resource : use.program->resources()) {
    const auto found = std::ranges::find(pass.names, resource.name, &NamedResource::name);
    if (found == pass.names.end()) {
      problems.push_back(fmt::format("{} uses the {} '{}', but pass '{}' names {}", use.program->label(),
                                     name(resource.kind), resource.name, graph.title(use.pass),
                                     namesOf(pass)));
    } else if (!fits(pass, *found, resource.kind)) {
      problems.push_back(fmt::format(
          "'{}' is a {} in {}, but {} in pass '{}'", resource.name, name(resource.kind), use.program->label(),
          found->access == kNoIndex ? "a constant" : name(pass.accesses[found->access].access),
          graph.title(use.pass)));
    } else {
      use.places.push_back(
          {resource.kind, resource.unit, static_cast<uint32_t>(found - pass.names.begin()), {}});
    }
  }
}

void findPlaces(Graph& graph, const gpu::ShaderLibrary& shaders) {
  std::vector<std::string> problems;
  for (const uint32_t p : graph.order) {
    const Pass& pass = graph.passes[p];
    for (const uint32_t index : pass.programs) findPlaces(graph, graph.programs[index], problems);
    for (uint32_t n = 0; n < pass.names.size(); ++n) {
      const NamedResource& named = pass.names[n];
      // The text is searched only for what the linked programs do not use.
      const bool known = std::ranges::any_of(pass.programs, [&](uint32_t index) {
        const ProgramUse& use = graph.programs[index];
        return std::ranges::find(use.places, n, &Place::name) != use.places.end() ||
               shaders.mentions(use.desc, named.name);
      });
      if (known) continue;
      std::string files;
      for (const uint32_t index : pass.programs)
        files += (files.empty() ? "" : ", ") + graph.programs[index].program->label();
      problems.push_back(fmt::format("pass '{}' names '{}', which is not in {}", graph.title(p), named.name,
                                     files.empty() ? "any program" : files));
    }
  }
  if (!problems.empty()) throw Error("frame graph: " + joined(problems, "and"));
}

gpu::Program& PassContext::use(ProgramHandle handle) const {
  Graph& graph = *graph_.implementation_;
  gpu::Program& used = program(handle);
  ProgramUse& use = graph.programs[handle.index];
  if (use.placesOf != used.serial()) {
    std::vector<std::string> problems;
    findPlaces(graph, use, problems);
    if (!problems.empty()) {
      use.placesOf = 0;  // the next frame looks again, and is refused again
      throw Error(joined(problems, "and"));
    }
  }
  if (graph.program == handle.index) return used;  // since this pass began: all is where it was
  used.use();
  graph.program = handle.index;
  const Pass& pass = graph.passes[graph.current];
  for (const Place& place : use.places) bindPlace(graph, pass, place);
  return used;
}

void PassContext::bind(SlotHandle slot, TextureHandle handle, int level, int layer) const {
  Graph& graph = *graph_.implementation_;
  Place* place = placeOf(graph, slot);
  if (place == nullptr) return;
  texture(handle);  // refuses what was not declared
  const Resource& resource = graph.resources[handle.resource];
  const uint32_t access = accessTo(graph, handle);
  place->slot = {.access = access, .texture = resource.textureObject, .level = level, .layer = layer};
  if (place->kind == Kind::sampler) return placeSampler(gl(), place->unit, resource.id(), nullptr);
  placeImage(gl(), place->unit, resource, graph.passes[graph.current].accesses[access].access, level, layer);
}

void PassContext::bind(SlotHandle slot, const gpu::Texture& texture, const gpu::Sampler* sampler) const {
  Place* place = placeOf(*graph_.implementation_, slot);
  if (place == nullptr) return;
  place->slot = {.texture = &texture, .sampler = sampler};
  placeSampler(gl(), place->unit, texture.id(), sampler);
}

void PassContext::bind(SlotHandle slot, const gpu::Buffer& buffer, size_t offset, size_t bytes) const {
  Place* place = placeOf(*graph_.implementation_, slot);
  if (place == nullptr) return;
  place->slot = {.buffer = &buffer, .offset = offset, .bytes = bytes};
  if (bytes == 0) bytes = wholeBytes(place->kind, buffer.size());
  placeBlock(gl(), place->kind, place->unit, buffer.id(), offset, bytes);
}

}  // namespace limn::frame
