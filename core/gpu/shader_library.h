// Finds, expands, compiles and caches GLSL programs.
//
// Sources are embedded in the binaries. A mount maps a prefix to embedded files and, optionally, to a folder
// on disk whose files take precedence and are reloaded when they change: prefix "" holds glsl/ (paths begin
// with "glsl/"), and each technique mounts "techniques/NAME/". #include "path" is looked up beside the
// including file, then from "". Every file is included once per stage (include guards are allowed but not
// needed). The stage of an entry file follows from its name: .vert.glsl .frag.glsl .geom.glsl .comp.glsl. The
// library writes "#version 450 core", the defines, then the expanded text with #line directives; a compile
// error is reported as Error with the original "file:line: message" of the diagnostics. A LIMN_ macro that an
// #if tests without asking defined() must be defined, or the compilation fails. Warnings of the compiler are
// errors in debug contexts only where they name a limn file.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/gpu/objects.h"
#include "core/gpu/shader_source.h"

namespace limn::gpu {

/// A program to be: its stage files and its permutation. Equal descriptions give the same program.
struct ProgramDesc {
  std::vector<std::string> files;              ///< full paths, e.g. "techniques/pcss/filter.comp.glsl"
  std::map<std::string, std::string> defines;  ///< name to value
  bool operator==(const ProgramDesc&) const = default;
  bool operator<(const ProgramDesc& other) const {
    return std::tie(files, defines) < std::tie(other.files, other.defines);
  }
};

class LIMN_API ShaderLibrary {
 public:
  explicit ShaderLibrary(Device& device);
  ~ShaderLibrary();
  ShaderLibrary(const ShaderLibrary&) = delete;
  ShaderLibrary& operator=(const ShaderLibrary&) = delete;

  /// Adds sources under `prefix` ("" or "techniques/NAME/"). `overrideFolder` empty: embedded ones only.
  void mount(std::string prefix, std::span<const EmbeddedSource> sources,
             std::filesystem::path overrideFolder = {});

  /// Compiles at the first request. The reference stays valid until the library is destroyed; reload() swaps
  /// the program behind it. Throws Error.
  Program& program(const ProgramDesc& desc);

  /// Whether program() would find it compiled.
  bool has(const ProgramDesc& desc) const;

  /// Recompiles the programs whose files changed on disk since they were compiled. A program that fails keeps
  /// its last good version. Returns in microseconds when nothing changed.
  struct ReloadResult {
    bool changed = false;             ///< a file did, be it to the text it had
    int reloaded = 0;                 ///< programs
    std::vector<std::string> errors;  ///< one per program whose files, as they are now, make none
  };
  ReloadResult reload();

  /// The text a stage is compiled from, for tests and diagnosis.
  std::string expanded(const ProgramDesc& desc, std::string_view file) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::gpu
