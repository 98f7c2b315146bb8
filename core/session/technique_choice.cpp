#include "core/session/technique_choice.h"

#include <fmt/format.h>

#include <string_view>

#include "core/base/error.h"

namespace limn::session {

std::vector<render::TechniqueUse> TechniqueChoice::resolve(const TechniqueRegistry& registry) const {
  std::vector<render::TechniqueUse> uses;
  std::string_view rest = techniques;
  while (!rest.empty()) {
    const size_t comma = rest.find(',');
    const std::string_view name = rest.substr(0, comma);
    const TechniquePlugin& plugin = registry.find(name);
    for (const auto& use : uses)
      if (use.plugin == &plugin)
        throw UsageError(fmt::format("technique {} is named twice; once is enough", name));
    uses.push_back({&plugin, ParameterValues(std::string(name), plugin.info->parameters)});
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  }
  for (const std::string& setting : settings) {
    const size_t dot = setting.find('.'), equals = setting.find('=');
    if (dot == std::string::npos || equals == std::string::npos || equals < dot)
      throw UsageError(
          fmt::format("--set '{}' is not accepted; expected TECHNIQUE.PARAMETER=VALUE", setting));
    const std::string technique = setting.substr(0, dot);
    bool found = false;
    for (auto& use : uses) {
      if (technique != use.plugin->info->name) continue;
      use.parameters.set(setting.substr(dot + 1, equals - dot - 1), setting.substr(equals + 1));
      found = true;
    }
    if (!found)
      throw UsageError(
          fmt::format("--set '{}' names technique {}, which --technique does not", setting, technique));
  }
  return uses;
}

}  // namespace limn::session
