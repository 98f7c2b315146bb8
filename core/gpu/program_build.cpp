#include "core/gpu/private/program_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/error.h"

namespace limn::gpu {
namespace {

constexpr size_t kShownDiagnostics = 8;

constexpr std::array<std::pair<std::string_view, GLenum>, 4> kStageSuffixes = {
    {{".vert.glsl", GL_VERTEX_SHADER},
     {".geom.glsl", GL_GEOMETRY_SHADER},
     {".frag.glsl", GL_FRAGMENT_SHADER},
     {".comp.glsl", GL_COMPUTE_SHADER}}};

GLenum stageOf(const std::string& file) {
  for (const auto& [suffix, stage] : kStageSuffixes) {
    if (file.ends_with(suffix)) return stage;
  }
  throw Error(
      fmt::format("shader file '{}' is no stage: accepted are names ending in .vert.glsl, .geom.glsl, "
                  ".frag.glsl, .comp.glsl",
                  file));
}

/// Deletes a shader or program object at the end of the scope, unless it was released.
class ScopedName {
 public:
  ScopedName(GLuint id, void (*destroy)(GLuint)) : id_(id), destroy_(destroy) {}
  ScopedName(ScopedName&& other) noexcept : id_(other.release()), destroy_(other.destroy_) {}
  ScopedName& operator=(ScopedName&&) = delete;
  ~ScopedName() {
    if (id_ != 0) destroy_(id_);
  }
  GLuint get() const { return id_; }
  GLuint release() { return std::exchange(id_, 0u); }

 private:
  GLuint id_;
  void (*destroy_)(GLuint);
};

/// The log of a shader or a program, read with the commands for its kind.
template <class GetParameter, class GetLog>
std::string infoLog(GLuint id, GetParameter getParameter, GetLog getLog) {
  GLint length = 0;
  getParameter(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(std::max(length, 1)), '\0');
  GLsizei written = 0;
  getLog(id, static_cast<GLsizei>(log.size()), &written, log.data());
  log.resize(static_cast<size_t>(written));
  return log;
}

/// Many diagnostics in one line.
std::string summary(std::span<const ShaderDiagnostic> diagnostics, const std::string& log) {
  std::string text;
  for (const ShaderDiagnostic& diagnostic :
       diagnostics.first(std::min(diagnostics.size(), kShownDiagnostics))) {
    text += (text.empty() ? "" : "; ") + diagnostic.text();
  }
  if (diagnostics.size() > kShownDiagnostics)
    text += fmt::format("; and {} more", diagnostics.size() - kShownDiagnostics);
  if (!text.empty()) return text;
  text = log.empty() ? "the driver gives no reason" : log;
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

ScopedName compileStage(Device& device, const std::string& label, const ShaderStage& stage) {
  const gl::Functions& gl = device.gl();
  ScopedName shader(gl.CreateShader(stageOf(stage.file)), gl.DeleteShader);
  const char* start = stage.source.text.c_str();
  gl.ShaderSource(shader.get(), 1, &start, nullptr);
  gl.CompileShader(shader.get());
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);

  const std::string log = infoLog(shader.get(), gl.GetShaderiv, gl.GetShaderInfoLog);
  std::vector<ShaderDiagnostic> diagnostics = parseShaderLog(log, stage.source.files);
  // Errors first: warnings may be a consequence of them, and the list is cut.
  std::stable_partition(diagnostics.begin(), diagnostics.end(), [](const auto& d) { return !d.warning; });
  if (compiled == GL_FALSE) {
    throw Error(fmt::format("cannot compile {}: {}", label, summary(diagnostics, log)));
  }
  // Mesa's, which every test sees. Other compilers warn of what is sound, as of members that nobody reads
  // unset.
  if (device.context().info().debug && device.context().info().software && !diagnostics.empty()) {
    throw Error(fmt::format("warnings in {}: {}", label, summary(diagnostics, log)));
  }
  return shader;
}

}  // namespace

GLuint linkProgram(Device& device, const std::string& label, std::span<const ShaderStage> stages) {
  if (stages.empty()) throw Error("a program needs at least one shader file");
  const gl::Functions& gl = device.gl();
  std::vector<ScopedName> shaders;
  for (const ShaderStage& stage : stages) shaders.push_back(compileStage(device, label, stage));

  ScopedName program(gl.CreateProgram(), gl.DeleteProgram);
  for (const ScopedName& shader : shaders) gl.AttachShader(program.get(), shader.get());
  gl.LinkProgram(program.get());
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked == GL_FALSE) {
    throw Error(fmt::format("cannot link {}: {}", label,
                            summary({}, infoLog(program.get(), gl.GetProgramiv, gl.GetProgramInfoLog))));
  }
  for (const ScopedName& shader : shaders) gl.DetachShader(program.get(), shader.get());
  ++device.mutableCounters().programsCompiled;
  return program.release();
}

}  // namespace limn::gpu
