// The units of a program's samplers, images and blocks: found by reflection, so that no number stands in GLSL
// or C++.
#include <algorithm>
#include <array>
#include <optional>

#include "core/gpu/objects.h"

namespace limn::gpu {
namespace {

using Kind = ShaderResource::Kind;

constexpr std::array<GLenum, 3> kUsedByStage = {
    GL_REFERENCED_BY_VERTEX_SHADER, GL_REFERENCED_BY_FRAGMENT_SHADER, GL_REFERENCED_BY_COMPUTE_SHADER};
constexpr GLenum kUsedByGeometry = GL_REFERENCED_BY_GEOMETRY_SHADER;

/// Nothing for a type that is neither sampler nor image.
std::optional<Kind> kindOf(GLenum type) {
  switch (type) {
    case GL_SAMPLER_2D:
    case GL_SAMPLER_3D:
    case GL_SAMPLER_CUBE:
    case GL_SAMPLER_2D_ARRAY:
    case GL_SAMPLER_CUBE_MAP_ARRAY:
    case GL_INT_SAMPLER_2D:
    case GL_INT_SAMPLER_3D:
    case GL_INT_SAMPLER_CUBE:
    case GL_INT_SAMPLER_2D_ARRAY:
    case GL_INT_SAMPLER_CUBE_MAP_ARRAY:
    case GL_UNSIGNED_INT_SAMPLER_2D:
    case GL_UNSIGNED_INT_SAMPLER_3D:
    case GL_UNSIGNED_INT_SAMPLER_CUBE:
    case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
    case GL_UNSIGNED_INT_SAMPLER_CUBE_MAP_ARRAY:
    case GL_SAMPLER_2D_SHADOW:
    case GL_SAMPLER_2D_ARRAY_SHADOW:
      return Kind::sampler;
    case GL_IMAGE_2D:
    case GL_IMAGE_3D:
    case GL_IMAGE_CUBE:
    case GL_IMAGE_2D_ARRAY:
    case GL_IMAGE_CUBE_MAP_ARRAY:
    case GL_INT_IMAGE_2D:
    case GL_INT_IMAGE_3D:
    case GL_INT_IMAGE_CUBE:
    case GL_INT_IMAGE_2D_ARRAY:
    case GL_INT_IMAGE_CUBE_MAP_ARRAY:
    case GL_UNSIGNED_INT_IMAGE_2D:
    case GL_UNSIGNED_INT_IMAGE_3D:
    case GL_UNSIGNED_INT_IMAGE_CUBE:
    case GL_UNSIGNED_INT_IMAGE_2D_ARRAY:
    case GL_UNSIGNED_INT_IMAGE_CUBE_MAP_ARRAY:
      return Kind::image;
    default:
      return {};
  }
}

/// Reads one interface of a program (ARB_program_interface_query, core since 4.3).
class Reflection {
 public:
  Reflection(const gl::Functions& gl, GLuint program) : gl_(gl), program_(program) {}

  void collect(GLenum interface, std::vector<ShaderResource>& to) const {
    GLint count = 0;
    gl_.GetProgramInterfaceiv(program_, interface, GL_ACTIVE_RESOURCES, &count);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
      const std::optional<Kind> kind = kindAt(interface, i);
      if (kind && isUsed(interface, i)) to.push_back({*kind, 0, nameAt(interface, i)});
    }
  }

 private:
  GLint property(GLenum interface, GLuint index, GLenum which) const {
    GLint value = 0;
    gl_.GetProgramResourceiv(program_, interface, index, 1, &which, 1, nullptr, &value);
    return value;
  }
  std::optional<Kind> kindAt(GLenum interface, GLuint index) const {
    if (interface == GL_UNIFORM_BLOCK) return Kind::uniformBlock;
    if (interface == GL_SHADER_STORAGE_BLOCK) return Kind::storageBlock;
    return kindOf(static_cast<GLenum>(property(interface, index, GL_TYPE)));
  }
  /// Mesa 22 says of storage blocks behind a computed index that no stage refers to them: all of them count.
  bool isUsed(GLenum interface, GLuint index) const {
    if (interface == GL_SHADER_STORAGE_BLOCK) return true;
    return property(interface, index, kUsedByGeometry) != 0 ||
           std::ranges::any_of(kUsedByStage,
                               [&](GLenum stage) { return property(interface, index, stage) != 0; });
  }
  std::string nameAt(GLenum interface, GLuint index) const {
    std::string name(static_cast<size_t>(property(interface, index, GL_NAME_LENGTH)), 0);
    GLsizei length = 0;
    gl_.GetProgramResourceName(program_, interface, index, static_cast<GLsizei>(name.size()), &length,
                               name.data());
    name.resize(static_cast<size_t>(length));
    return name;
  }

  const gl::Functions& gl_;
  GLuint program_;
};

void assign(const gl::Functions& gl, GLuint program, const ShaderResource& resource) {
  switch (resource.kind) {
    case Kind::sampler:
    case Kind::image:
      gl.ProgramUniform1i(program, gl.GetUniformLocation(program, resource.name.c_str()),
                          static_cast<GLint>(resource.unit));
      break;
    case Kind::uniformBlock:
      gl.UniformBlockBinding(program, gl.GetUniformBlockIndex(program, resource.name.c_str()), resource.unit);
      break;
    case Kind::storageBlock:
      gl.ShaderStorageBlockBinding(
          program, gl.GetProgramResourceIndex(program, GL_SHADER_STORAGE_BLOCK, resource.name.c_str()),
          resource.unit);
  }
}

}  // namespace

const std::vector<ShaderResource>& Program::resources() {
  if (resources_) return *resources_;
  const gl::Functions& gl = device_->gl();
  const Reflection reflection(gl, id_);
  std::vector<ShaderResource>& all = resources_.emplace();
  for (const GLenum interface : {GL_UNIFORM, GL_UNIFORM_BLOCK, GL_SHADER_STORAGE_BLOCK})
    reflection.collect(interface, all);
  std::ranges::sort(all, {}, &ShaderResource::name);
  std::array<GLuint, 4> next{};
  for (ShaderResource& resource : all) {
    resource.unit = next[static_cast<size_t>(resource.kind)]++;
    assign(gl, id_, resource);
  }
  return all;
}

}  // namespace limn::gpu
