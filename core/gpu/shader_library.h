// Declares the library that finds, expands, compiles and caches GLSL programs.
//
// Sources are embedded in the binaries. A mount maps a prefix to embedded files and, optionally, to a folder
// on disk whose files take precedence and are reloaded when they change: prefix "" holds glsl/ (paths begin
// with "glsl/"), and each technique mounts "techniques/NAME/". #include "path" is looked up beside the
// including file, then from ""; #include NAME takes the path that the define NAME of the program holds. Every
// file is included once per stage (include guards are allowed but not needed). The stage of an entry file
// follows from its name: .vert.glsl .frag.glsl .geom.glsl .comp.glsl. The library writes "#version 450 core",
// the defines, then the expanded text with #line directives; a compile error is reported as Error with the
// original "file:line: message" of the diagnostics. A LIMN_ macro that an #if tests without asking defined()
// must be defined, or the compilation fails. Warnings of the compiler are errors in debug contexts of
// software renderers, where they name a limn file; a driver that finds a text in its cache does not compile
// it, nor warn of it, again.
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

/// Describes a program by its stage files and its permutation. Equal descriptions give the same program.
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

  /// Adds sources under `prefix` ("" or "techniques/NAME/"). With an empty `overrideFolder` only embedded
  /// ones are used.
  void mount(std::string prefix, std::span<const EmbeddedSource> sources,
             std::filesystem::path overrideFolder = {});

  /// Returns the program, compiled at the first request. The reference stays valid until the library is
  /// destroyed; reload() replaces the program behind it. Throws Error when the program cannot be compiled.
  Program& program(const ProgramDesc& desc);

  /// Says whether the program is already compiled, so that program() would not compile it.
  bool has(const ProgramDesc& desc) const;

  /// Says whether the text of a compiled program contains `word`, even in a part that the compiler removed or
  /// that its defines keep from being included.
  bool mentions(const ProgramDesc& desc, std::string_view word) const;

  /// Holds what reload() did.
  struct ReloadResult {
    bool changed = false;             ///< a file changed, even if its text is the same
    int reloaded = 0;                 ///< programs
    std::vector<std::string> errors;  ///< one per program whose current files do not compile
  };
  /// Recompiles the programs whose files changed on disk since they were compiled, and returns what it did. A
  /// program that fails to compile keeps its last good version. Returns within microseconds when nothing
  /// changed.
  ReloadResult reload();

  /// Returns the text from which a stage is compiled, for tests and diagnosis.
  std::string expanded(const ProgramDesc& desc, std::string_view file) const;
  /// Returns the same text for other engines: without what only C++ reads, and with comments in place of
  /// #line directives that say which file lines are from.
  std::string standalone(const ProgramDesc& desc, std::string_view file) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::gpu
