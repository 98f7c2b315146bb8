#include "core/gpu/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "core/base/error.h"

namespace limn::gpu {
namespace {

constexpr ObjectKind kSamplerKind{[](const gl::Functions& gl, GLuint id) { gl.DeleteSamplers(1, &id); },
                                  &Counters::samplers};
constexpr ObjectKind kVertexArrayKind{
    [](const gl::Functions& gl, GLuint id) { gl.DeleteVertexArrays(1, &id); }, &Counters::vertexArrays};
constexpr ObjectKind kQueryKind{[](const gl::Functions& gl, GLuint id) { gl.DeleteQueries(1, &id); },
                                &Counters::queries};
constexpr ObjectKind kProgramKind{[](const gl::Functions& gl, GLuint id) { gl.DeleteProgram(id); },
                                  &Counters::programs};

}  // namespace

Object::Object(Object&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)),
      id_(std::exchange(other.id_, 0u)),
      kind_(other.kind_),
      counted_(other.counted_) {}

Object& Object::operator=(Object&& other) noexcept {
  Object moved(std::move(other));
  std::swap(device_, moved.device_);
  std::swap(id_, moved.id_);
  std::swap(kind_, moved.kind_);
  std::swap(counted_, moved.counted_);
  return *this;
}

Object::~Object() {
  if (id_ == 0) return;
  const ContextScope scope(&device_->context());
  kind_->remove(device_->gl(), id_);
  Counters& counters = device_->mutableCounters();
  --(counters.*kind_->count);
  if (kind_->bytes != nullptr) counters.*kind_->bytes -= counted_;
}

void Object::count(int64_t bytes) {
  Counters& counters = device_->mutableCounters();
  ++(counters.*kind_->count);
  if (kind_->bytes != nullptr) counters.*kind_->bytes += bytes;
  counted_ = bytes;
}

void Object::setLabel(GLenum kind, std::string_view label) const {
  constexpr size_t longestLabel = 255;  // GL_MAX_LABEL_LENGTH is at least 256, the terminator included
  const size_t length = std::min(label.size(), longestLabel);
  device_->gl().ObjectLabel(kind, id_, static_cast<GLsizei>(length), label.data());
}

Sampler::Sampler(Device& device, GLenum minFilter, GLenum magFilter, GLenum wrap)
    : Object(device, kSamplerKind) {
  const gl::Functions& gl = device.gl();
  gl.CreateSamplers(1, &id_);
  count();
  gl.SamplerParameteri(id_, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minFilter));
  gl.SamplerParameteri(id_, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magFilter));
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    gl.SamplerParameteri(id_, axis, static_cast<GLint>(wrap));
  }
}

VertexArray::VertexArray(Device& device, std::span<const VertexAttribute> attributes)
    : Object(device, kVertexArrayKind) {
  const gl::Functions& gl = device.gl();
  gl.CreateVertexArrays(1, &id_);
  count();
  for (const VertexAttribute& a : attributes) {
    gl.EnableVertexArrayAttrib(id_, a.location);
    if (a.integer) {
      gl.VertexArrayAttribIFormat(id_, a.location, a.components, a.type, a.offset);
    } else {
      gl.VertexArrayAttribFormat(id_, a.location, a.components, a.type, a.normalised ? GL_TRUE : GL_FALSE,
                                 a.offset);
    }
    gl.VertexArrayAttribBinding(id_, a.location, a.binding);
  }
}

Query::Query(Device& device, GLenum target) : Object(device, kQueryKind), target_(target) {
  device.gl().CreateQueries(target, 1, &id_);
  count();
}

void Query::begin() {
  device_->gl().BeginQuery(target_, id_);
}

void Query::end() {
  device_->gl().EndQuery(target_);
}

uint64_t Query::result() const {
  GLuint64 result = 0;
  device_->gl().GetQueryObjectui64v(id_, GL_QUERY_RESULT, &result);
  return result;
}

Program::Program(Device& device, GLuint program, std::string label)
    : Object(device, kProgramKind), label_(std::move(label)) {
  static std::atomic<uint64_t> linked = 0;
  serial_ = ++linked;
  id_ = program;
  count();
  setLabel(GL_PROGRAM, label_);
}

void Program::use() const {
  device_->gl().UseProgram(id_);
}

void Program::set(const char* name, int value) {
  device_->gl().ProgramUniform1i(id_, location(name), value);
}

void Program::set(const char* name, unsigned value) {
  device_->gl().ProgramUniform1ui(id_, location(name), value);
}

void Program::set(const char* name, float value) {
  device_->gl().ProgramUniform1f(id_, location(name), value);
}

void Program::set4(const char* name, const float* value) {
  device_->gl().ProgramUniform4fv(id_, location(name), 1, value);
}

GLint Program::location(const char* name) {
  for (const auto& [known, location] : locations_)
    if (known == name) return location;
  const GLint location = device_->gl().GetUniformLocation(id_, name);
  if (location < 0 && device_->software())
    throw Error(fmt::format("program '{}' has no active uniform '{}'", label_, name));
  locations_.emplace_back(name, location);
  return location;
}

}  // namespace limn::gpu
