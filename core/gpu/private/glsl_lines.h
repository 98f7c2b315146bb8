// Declares a GLSL file as lines, with what the preprocessor of ShaderLibrary must know about each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn::gpu {

struct GlslLine {
  std::string_view text;  ///< as written; points into the file's text
  std::string directive;  ///< "include", "if", ...; empty where the line is not the start of a directive
  std::string argument;   ///< of the directive, without comments, continued lines joined
  bool guard = false;     ///< the #ifndef of the file's own include guard
  /// On the #if that opens a chain: LIMN_ macros whose value the chain tests without asking whether they are
  /// defined.
  std::vector<std::string> requiredMacros;
};

struct LIMN_API GlslFile {
  /// Splits `text`, which must outlive this object, into lines.
  explicit GlslFile(std::string_view text);
  std::vector<GlslLine> lines;
};

}  // namespace limn::gpu
