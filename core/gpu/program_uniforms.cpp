#include "core/gpu/program_uniforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace limn::gpu {
namespace {

enum class Scalar { real, integer, natural };

struct UniformType {
  GLenum type;
  const char* name;
  Scalar scalar;
  size_t components;
};

constexpr std::array<UniformType, 14> kTypes{{{GL_FLOAT, "float", Scalar::real, 1},
                                              {GL_FLOAT_VEC2, "vec2", Scalar::real, 2},
                                              {GL_FLOAT_VEC3, "vec3", Scalar::real, 3},
                                              {GL_FLOAT_VEC4, "vec4", Scalar::real, 4},
                                              {GL_FLOAT_MAT3, "mat3", Scalar::real, 9},
                                              {GL_FLOAT_MAT4, "mat4", Scalar::real, 16},
                                              {GL_INT, "int", Scalar::integer, 1},
                                              {GL_INT_VEC2, "ivec2", Scalar::integer, 2},
                                              {GL_INT_VEC3, "ivec3", Scalar::integer, 3},
                                              {GL_INT_VEC4, "ivec4", Scalar::integer, 4},
                                              {GL_UNSIGNED_INT, "uint", Scalar::natural, 1},
                                              {GL_UNSIGNED_INT_VEC2, "uvec2", Scalar::natural, 2},
                                              {GL_UNSIGNED_INT_VEC3, "uvec3", Scalar::natural, 3},
                                              {GL_UNSIGNED_INT_VEC4, "uvec4", Scalar::natural, 4}}};

/// Reads up to 16 components by that one of glGetnUniform*v which fits their type.
template <class T, class Read>
std::string valueText(Read read, GLuint program, GLint location, size_t components) {
  std::array<T, 16> values{};
  read(program, location, static_cast<GLsizei>(sizeof(values)), values.data());
  return fmt::format(
      "{}", fmt::join(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(components), ", "));
}

std::string valueAt(const gl::Functions& gl, GLuint program, GLint location, const UniformType& type) {
  switch (type.scalar) {
    case Scalar::real:
      return valueText<GLfloat>(gl.GetnUniformfv, program, location, type.components);
    case Scalar::integer:
      return valueText<GLint>(gl.GetnUniformiv, program, location, type.components);
    case Scalar::natural:
      return valueText<GLuint>(gl.GetnUniformuiv, program, location, type.components);
  }
  return {};
}

struct Active {
  std::string name;  // without the index of an array
  GLenum type = 0;
  GLint elements = 0;
  bool array = false;
};

/// Whether the name is that of a sampler or an image.
bool isOpaque(Program& program, const std::string& name) {
  const std::vector<ShaderResource>& all = program.resources();
  return std::ranges::find(all, name, &ShaderResource::name) != all.end();
}

}  // namespace

std::vector<UniformValue> uniformValues(Program& program) {
  const gl::Functions& gl = program.device().gl();
  GLint count = 0, longest = 0;
  gl.GetProgramiv(program.id(), GL_ACTIVE_UNIFORMS, &count);
  gl.GetProgramiv(program.id(), GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
  std::vector<Active> found;
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    std::string name(static_cast<size_t>(longest), 0);
    GLsizei length = 0;
    Active active;
    gl.GetActiveUniform(program.id(), i, longest, &length, &active.elements, &active.type, name.data());
    name.resize(static_cast<size_t>(length));
    const bool plain = gl.GetUniformLocation(program.id(), name.c_str()) >= 0;  // no member of a block
    if (!plain || isOpaque(program, name)) continue;
    active.array = name.ends_with("[0]");
    if (active.array) name.resize(name.size() - 3);
    active.name = std::move(name);
    found.push_back(std::move(active));
  }
  std::ranges::sort(found, {}, &Active::name);
  std::vector<UniformValue> values;
  for (const Active& active : found) {
    const auto type = std::ranges::find(kTypes, active.type, &UniformType::type);
    for (GLint element = 0; element < active.elements; ++element) {
      const std::string name = active.array ? fmt::format("{}[{}]", active.name, element) : active.name;
      const GLint location = gl.GetUniformLocation(program.id(), name.c_str());
      if (type == kTypes.end())
        values.push_back({name, fmt::format("{:#x}", active.type), ""});
      else if (location >= 0)
        values.push_back({name, type->name, valueAt(gl, program.id(), location, *type)});
    }
  }
  return values;
}

}  // namespace limn::gpu
