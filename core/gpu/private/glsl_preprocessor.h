// Declares the textual part of ShaderLibrary, which needs no OpenGL: it expands includes, and finds the file
// and line that a compiler's message refers to.
//
// Conditions are left to the GLSL compiler, which alone knows every macro. Where a condition asks for the
// program's defines alone, its answer is known here as well: an include that it keeps from being read is left
// out, since compilers take long to skip what nobody reads. To make an include inside any other condition
// right whether or not the condition holds, each included file is wrapped in a guard of its own, and an
// include that cannot be resolved becomes a compile error (#error) that takes effect only where the condition
// holds (so not inside #ifdef __cplusplus). A LIMN_ macro that an #if or #elif tests must be defined, or the
// compilation fails: GLSL compilers would silently read it as 0. #ifdef and defined() may test any macro.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn::gpu {

/// Returns the text of a file by its full path, or nothing.
using SourceLookup = std::function<std::optional<std::string>(const std::string& path)>;

struct ExpandedSource {
  std::string text;                ///< #version, defines and everything included, with #line directives
  std::vector<std::string> files;  ///< path of each source string number that the #line directives name
};

/// Says what becomes of includes that no compiler reads with the program's defines.
enum class UnreadIncludes : uint8_t { leftOut, kept };

/// Returns the entry file with its includes expanded. Throws Error, naming file and line, for a missing file,
/// an include that cannot be found or includes itself, a #version in the file itself, and a define that is no
/// identifier or spans lines.
LIMN_API ExpandedSource expandGlsl(const std::string& entry,
                                   const std::map<std::string, std::string>& defines,
                                   const SourceLookup& lookup,
                                   UnreadIncludes unread = UnreadIncludes::leftOut);

/// Returns the text for a compiler elsewhere: without what only C++ reads (#ifdef __cplusplus), and in place
/// of #line directives with a comment, "// ---- PATH", wherever lines of another file begin.
LIMN_API std::string standaloneGlsl(const ExpandedSource& source);

struct LIMN_API ShaderDiagnostic {
  std::string file;  ///< path as in ExpandedSource::files
  int line = 0;
  bool warning = false;
  std::string message;
  std::string text() const;  ///< "file:line: message"
};

/// Returns the diagnostics in a compiler's log that name a file; ignores other lines. Knows the formats of
/// Mesa, NVIDIA, and of AMD and Intel on Windows.
LIMN_API std::vector<ShaderDiagnostic> parseShaderLog(std::string_view log,
                                                      std::span<const std::string> files);

}  // namespace limn::gpu
