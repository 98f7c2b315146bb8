#include "core/question/technique_names.h"

namespace limn {
namespace {

/// The parts between separators: at least one.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (size_t end = text.find(separator); end != std::string_view::npos; end = text.find(separator)) {
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  parts.push_back(text);
  return parts;
}

}  // namespace

std::vector<NamedTechnique> namedTechniques(std::string_view text) {
  std::vector<std::string_view> parts = split(text, ',');
  if (parts.back().empty()) parts.pop_back();  // an empty text, or a ',' at its end
  std::vector<NamedTechnique> techniques;
  for (const std::string_view part : parts) {
    const size_t colon = part.find(':');
    techniques.push_back({part.substr(0, colon), std::nullopt});
    if (colon != std::string_view::npos) techniques.back().terms = split(part.substr(colon + 1), '+');
  }
  return techniques;
}

std::string_view shortParameter(std::string_view techniques, std::string_view parameter) {
  const std::vector<NamedTechnique> named = namedTechniques(techniques);
  if (named.size() != 1) return parameter;
  const std::string_view own = named.front().name;
  const bool isOwn = parameter.starts_with(own) && parameter.substr(own.size()).starts_with('.');
  return isOwn ? parameter.substr(own.size() + 1) : parameter;
}

}  // namespace limn
