// For tests that run one program without a frame graph: buffers and textures at the places that the program
// gives them.
#pragma once

#include <string_view>

#include "core/base/error.h"
#include "core/gpu/objects.h"

namespace limn::test {

/// The unit behind a name; throws Error where the program has none.
inline const gpu::ShaderResource& resourceNamed(gpu::Program& program, std::string_view name) {
  for (const gpu::ShaderResource& resource : program.resources())
    if (resource.name == name) return resource;
  throw Error("no resource of this name in " + program.label() + ": " + std::string(name));
}

inline void bindByName(const gl::Functions& gl, gpu::Program& program, std::string_view name,
                       const gpu::Buffer& buffer) {
  const gpu::ShaderResource& to = resourceNamed(program, name);
  gl.BindBufferBase(
      to.kind == gpu::ShaderResource::Kind::uniformBlock ? GL_UNIFORM_BUFFER : GL_SHADER_STORAGE_BUFFER,
      to.unit, buffer.id());
}

/// An image is written only.
inline void bindByName(const gl::Functions& gl, gpu::Program& program, std::string_view name,
                       const gpu::Texture& texture, const gpu::Sampler* sampler = nullptr) {
  const gpu::ShaderResource& to = resourceNamed(program, name);
  if (to.kind == gpu::ShaderResource::Kind::image) {
    gl.BindImageTexture(to.unit, texture.id(), 0, GL_TRUE, 0, GL_WRITE_ONLY, texture.desc().format);
    return;
  }
  gl.BindTextureUnit(to.unit, texture.id());
  gl.BindSampler(to.unit, sampler != nullptr ? sampler->id() : 0);
}

}  // namespace limn::test
