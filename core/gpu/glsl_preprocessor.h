// The textual half of ShaderLibrary, without OpenGL: include expansion, and the way back from a compiler's
// message to the file and line it is about.
//
// Conditions are left to the GLSL compiler, which alone knows every macro. So that an include inside a
// condition is right whichever way that goes, each included file is wrapped in a guard of its own, and an
// include that cannot be resolved is a compile error (#error) where the condition holds and nothing where it
// does not (#ifdef __cplusplus). A LIMN_ macro that an #if or #elif tests must be defined, or the compilation
// fails: GLSL compilers would silently read it as 0. #ifdef and defined() are free to ask.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn::gpu {

/// The text of a file by its full path, or nothing.
using SourceLookup = std::function<std::optional<std::string>(const std::string& path)>;

struct ExpandedSource {
  std::string text;                ///< #version, defines and everything included, with #line directives
  std::vector<std::string> files;  ///< path of each source string number that the #line directives name
};

/// Throws Error, naming file and line, for a missing file, an include that cannot be found or includes
/// itself, a #version of the file's own and a define that is no identifier or spans lines.
LIMN_API ExpandedSource expandGlsl(const std::string& entry,
                                   const std::map<std::string, std::string>& defines,
                                   const SourceLookup& lookup);

struct LIMN_API ShaderDiagnostic {
  std::string file;  ///< path as in ExpandedSource::files
  int line = 0;
  bool warning = false;
  std::string message;
  std::string text() const;  ///< "file:line: message"
};

/// The diagnostics of a compiler's log (the formats of Mesa, NVIDIA, and of AMD and Intel on Windows) that
/// name a file; other lines are left out.
LIMN_API std::vector<ShaderDiagnostic> parseShaderLog(std::string_view log,
                                                      std::span<const std::string> files);

}  // namespace limn::gpu
