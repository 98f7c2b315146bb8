// Declares what a prepared frame graph says about the programs of its passes: their files, what is bound to
// each of their names, and how much of them was dispatched. It is for tools, and for people who take a
// technique into an engine of their own.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/frame/frame_graph.h"

namespace limn::frame {

/// Says how a texture is filtered where a sampler reads it.
struct SamplingReport {
  GLenum minFilter = GL_NEAREST, magFilter = GL_NEAREST;
  std::array<GLenum, 3> wrap = {};  ///< along each axis
};

/// Describes one name of a program and what the pass binds to it.
struct NameReport {
  gpu::ShaderResource::Kind kind = gpu::ShaderResource::Kind::sampler;
  std::string name;
  bool slot = false;  ///< the pass binds something for each draw or dispatch; what follows was the last
  std::optional<size_t>
      access;  ///< index into PassReport::accesses; nothing: a resource outside the graph, or none yet
  const gpu::Texture* texture = nullptr;  ///< lives, like the buffer, as long as the graph
  const gpu::Buffer* buffer = nullptr;
  size_t offset = 0;                       ///< of the part of the buffer, bytes
  int64_t bytes = 0;                       ///< of the texture, or of the part of the buffer, as declared
  int level = 0, layer = -1;               ///< of an image; layer -1: all
  std::optional<SamplingReport> sampling;  ///< of a sampler
};

/// Describes one program of a pass.
struct ProgramReport {
  size_t pass = 0;  ///< index into what explain() returns
  gpu::ProgramDesc desc;
  gpu::Program* program = nullptr;  ///< lives as long as the shader library
  std::vector<NameReport> names;
  int dispatches = 0;                 ///< in the last frame
  std::array<GLuint, 3> groups = {};  ///< work groups of the last of them
};

/// Returns the word for the kind in GLSL's terms: "sampler", "image", "uniform block", "storage block".
LIMN_API std::string_view name(gpu::ShaderResource::Kind kind);

}  // namespace limn::frame
