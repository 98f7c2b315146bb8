#include "core/gpu/objects.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace limn::gpu {

void Object::setLabel(GLenum kind, std::string_view label) const {
  constexpr size_t longestLabel = 255;  // GL_MAX_LABEL_LENGTH is at least 256, the terminator included
  const size_t length = std::min(label.size(), longestLabel);
  device_->gl().ObjectLabel(kind, id_, static_cast<GLsizei>(length), label.data());
}

Sampler::Sampler(Device& device, GLenum minFilter, GLenum magFilter, GLenum wrap) : Object(device, 0) {
  const gl::Functions& gl = device.gl();
  gl.CreateSamplers(1, &id_);
  gl.SamplerParameteri(id_, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minFilter));
  gl.SamplerParameteri(id_, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magFilter));
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    gl.SamplerParameteri(id_, axis, static_cast<GLint>(wrap));
  }
  ++device.mutableCounters().samplers;
}

Sampler::Sampler(Sampler&& other) noexcept = default;

Sampler& Sampler::operator=(Sampler&& other) noexcept {
  Sampler moved(std::move(other));
  swap(moved);
  return *this;
}

Sampler::~Sampler() {
  if (id_ == 0) return;
  const ContextScope scope(&device_->context());
  device_->gl().DeleteSamplers(1, &id_);
  --device_->mutableCounters().samplers;
}

VertexArray::VertexArray(Device& device, std::span<const VertexAttribute> attributes) : Object(device, 0) {
  const gl::Functions& gl = device.gl();
  gl.CreateVertexArrays(1, &id_);
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
  ++device.mutableCounters().vertexArrays;
}

VertexArray::VertexArray(VertexArray&& other) noexcept = default;

VertexArray& VertexArray::operator=(VertexArray&& other) noexcept {
  VertexArray moved(std::move(other));
  swap(moved);
  return *this;
}

VertexArray::~VertexArray() {
  if (id_ == 0) return;
  const ContextScope scope(&device_->context());
  device_->gl().DeleteVertexArrays(1, &id_);
  --device_->mutableCounters().vertexArrays;
}

Query::Query(Device& device, GLenum target) : Object(device, 0), target_(target) {
  device.gl().CreateQueries(target, 1, &id_);
  ++device.mutableCounters().queries;
}

Query::Query(Query&& other) noexcept = default;

Query& Query::operator=(Query&& other) noexcept {
  Query moved(std::move(other));
  swap(moved);
  std::swap(target_, moved.target_);
  return *this;
}

Query::~Query() {
  if (id_ == 0) return;
  const ContextScope scope(&device_->context());
  device_->gl().DeleteQueries(1, &id_);
  --device_->mutableCounters().queries;
}

void Query::begin() {
  device_->gl().BeginQuery(target_, id_);
}

void Query::end() {
  device_->gl().EndQuery(target_);
}

bool Query::available() const {
  GLuint available = 0;
  device_->gl().GetQueryObjectuiv(id_, GL_QUERY_RESULT_AVAILABLE, &available);
  return available != 0;
}

uint64_t Query::result() const {
  GLuint64 result = 0;
  device_->gl().GetQueryObjectui64v(id_, GL_QUERY_RESULT, &result);
  return result;
}

Program::Program(Device& device, GLuint program, std::string label)
    : Object(device, program), label_(std::move(label)) {
  setLabel(GL_PROGRAM, label_);
  ++device.mutableCounters().programs;
}

Program::Program(Program&& other) noexcept = default;

Program& Program::operator=(Program&& other) noexcept {
  Program moved(std::move(other));
  swap(moved);
  std::swap(label_, moved.label_);
  std::swap(resources_, moved.resources_);
  std::swap(locations_, moved.locations_);
  return *this;
}

Program::~Program() {
  if (id_ == 0) return;
  const ContextScope scope(&device_->context());
  device_->gl().DeleteProgram(id_);
  --device_->mutableCounters().programs;
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

void Program::set2(const char* name, float x, float y) {
  device_->gl().ProgramUniform2f(id_, location(name), x, y);
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
