// Messages of GLSL compilers back to limn's files; see glsl_preprocessor.h.
#include <fmt/format.h>

#include <regex>

#include "core/base/text.h"
#include "core/gpu/private/glsl_preprocessor.h"

namespace limn::gpu {
namespace {

struct Format {
  std::regex expression;
  int file, line, severity, message;  // group numbers
};

}  // namespace

std::string ShaderDiagnostic::text() const {
  return fmt::format("{}:{}: {}", file, line, message);
}

std::vector<ShaderDiagnostic> parseShaderLog(std::string_view log, std::span<const std::string> files) {
  const Format formats[] = {
      {std::regex(R"(^(\d+):(\d+)\(\d+\): (?:preprocessor )?(\w+): (.*)$)"), 1, 2, 3, 4},      // Mesa
      {std::regex(R"(^(\d+)\((\d+)\) : (?:fatal )?(\w+) (?:[A-Z]\d+: )?(.*)$)"), 1, 2, 3, 4},  // NVIDIA
      {std::regex(R"(^(\w+): (\d+):(\d+): (.*)$)"), 2, 3, 1, 4},                               // AMD, Intel
  };
  std::vector<ShaderDiagnostic> diagnostics;
  while (!log.empty()) {
    const size_t end = log.find('\n');
    const std::string line(log.substr(0, end));
    log = end == std::string_view::npos ? std::string_view() : log.substr(end + 1);
    for (const Format& format : formats) {
      std::smatch match;
      if (!std::regex_match(line, match, format.expression)) continue;
      const auto file = parseWhole<size_t>(match[format.file].str()),
                 row = parseWhole<size_t>(match[format.line].str());
      if (!file || !row || *file >= files.size()) break;
      const std::string severity = match[format.severity];
      diagnostics.push_back({files[*file], static_cast<int>(*row),
                             severity == "warning" || severity == "WARNING", match[format.message]});
      break;
    }
  }
  return diagnostics;
}

}  // namespace limn::gpu
