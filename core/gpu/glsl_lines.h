// A GLSL file as lines, with what the preprocessor of ShaderLibrary must know about each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limn::gpu {

struct GlslLine {
  std::string_view text;     ///< as written; points into the file's text
  std::string directive;     ///< "include", "if", ...; empty where the line is not the start of a directive
  std::string argument;      ///< of the directive, without comments, continued lines joined
  bool conditional = false;  ///< inside an #if other than the file's own include guard
  /// At the #if that opens a chain: LIMN_ macros that the chain tests for their value without asking whether
  /// they exist.
  std::vector<std::string> requiredMacros;
};

struct GlslFile {
  /// `text` must outlive the file.
  explicit GlslFile(std::string_view text);
  std::vector<GlslLine> lines;
};

}  // namespace limn::gpu
