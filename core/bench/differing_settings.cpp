#include "core/bench/private/differing_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <vector>

#include "core/question/question_fields.h"
#include "core/question/technique_names.h"

namespace limn::bench {
namespace {

using Parameters = std::map<std::string, std::string>;  // by "technique.parameter"

Parameters parametersOf(const Row& row) {
  Parameters parameters(row.what.parameters.begin(), row.what.parameters.end());
  if (row.cost.details.empty()) return parameters;
  const nlohmann::json stats = nlohmann::json::parse(row.cost.details, nullptr, false);
  if (!stats.is_object()) return parameters;
  const nlohmann::json known = stats.value("parameters", nlohmann::json::object());
  for (const auto& [name, value] : known.items())
    parameters.insert_or_assign(name, value.is_string() ? value.get<std::string>() : value.dump());
  return parameters;
}

/// The name that two techniques may share: without the technique.
std::string shortName(const std::string& name) {
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? name : name.substr(dot + 1);
}

/// Whether the row's technique, or one of a combination, is the parameter's.
bool declares(const Row& row, const std::string& name) {
  return std::ranges::any_of(namedTechniques(row.what.technique), [&](const NamedTechnique& named) {
    return named.name == std::string_view(name).substr(0, name.find('.'));
  });
}

/// The other side's parameter of that name that is not of the first side's techniques.
Parameters::const_iterator namesake(const std::string& name, const Row& own, const Parameters& other) {
  return std::ranges::find_if(other, [&](const auto& parameter) {
    return shortName(parameter.first) == shortName(name) && !declares(own, parameter.first);
  });
}

class Differences {
 public:
  void add(const std::string& name, const std::string& first, const std::string& second) {
    const auto shown = [](const std::string& value) { return value.empty() ? "-" : value; };
    if (first != second) texts_.push_back(fmt::format("{} {} / {}", name, shown(first), shown(second)));
  }
  std::string text() const { return texts_.empty() ? "none" : fmt::format("{}", fmt::join(texts_, ", ")); }

 private:
  std::vector<std::string> texts_;
};

std::string valueText(const QuestionField& field, const Case& c) {
  std::vector<std::string> values = printed(field, c);
  if (field.file)
    for (std::string& value : values) value = std::filesystem::path(value).filename().string();
  return fmt::format("{}", fmt::join(values, " "));
}

void addQuestion(Differences& differences, const Case& first, const Case& second) {
  for (const QuestionField& field : questionFields())
    differences.add(field.key, valueText(field, first), valueText(field, second));
  const auto size = [](const Case& c) {
    return c.timeWidth > 0 ? fmt::format("{}x{}", c.timeWidth, c.timeHeight) : std::string();
  };
  differences.add("time_size", size(first), size(second));
  differences.add("fps", fmt::format("{}", first.fps), fmt::format("{}", second.fps));
  const auto mode = [](const Case& c) { return c.dynamic ? "dynamic" : "static"; };
  differences.add("mode", mode(first), mode(second));
  differences.add("frames", fmt::format("{}", first.frames), fmt::format("{}", second.frames));
  differences.add("warmup", fmt::format("{}", first.warmup), fmt::format("{}", second.warmup));
  const ReferenceSettings &ours = first.reference, &theirs = second.reference;
  differences.add("spp", fmt::format("{}", ours.spp), fmt::format("{}", theirs.spp));
  differences.add("noise", fmt::format("{}", ours.noise), fmt::format("{}", theirs.noise));
  differences.add("bounces", fmt::format("{}", ours.bounces), fmt::format("{}", theirs.bounces));
  differences.add("interfaces", fmt::format("{}", ours.interfaces), fmt::format("{}", theirs.interfaces));
}

/// The files of one scene, and the modules of techniques that both sides have: other scenes have other files.
void addVersions(Differences& differences, const Row& first, const Row& second) {
  const Provenance &ours = first.provenance, &theirs = second.provenance;
  differences.add("program", ours.program, theirs.program);
  const auto files = [](const Case& c) { return std::tie(c.scene, c.environment, c.grid, c.defaultLights); };
  if (files(first.what) == files(second.what)) differences.add("scene files", ours.scene, theirs.scene);
  for (const Provenance::Module& own : ours.modules) {
    const auto other = std::ranges::find(theirs.modules, own.technique, &Provenance::Module::technique);
    if (other != theirs.modules.end()) differences.add("module " + own.technique, own.hash, other->hash);
  }
}

void addPlace(Differences& differences, const Row& first, const Row& second) {
  differences.add("renderer", first.cost.renderer, second.cost.renderer);
  differences.add("driver", first.cost.driver, second.cost.driver);
  differences.add("machine", first.cost.machine, second.cost.machine);
}

void addParameters(Differences& differences, const Row& first, const Row& second) {
  const Parameters own = parametersOf(first), other = parametersOf(second);
  const bool combined = first.what.technique.find(',') != std::string::npos;  // short names may occur twice
  const auto shown = [combined](const std::string& name) { return combined ? name : shortName(name); };
  const auto valueIn = [](const Parameters& parameters, const std::string& name) {
    const auto found = parameters.find(name);
    return found == parameters.end() ? std::string("default") : found->second;
  };
  for (const auto& [name, value] : own) {
    if (declares(second, name))
      differences.add(shown(name), value, valueIn(other, name));
    else if (const auto found = namesake(name, first, other); found != other.end())
      differences.add(shown(name), value, found->second);
  }
  for (const auto& [name, value] : other)
    if (declares(first, name) && !own.contains(name)) differences.add(shown(name), "default", value);
}

}  // namespace

std::string differingSettings(const Row& first, const Row& second) {
  Differences differences;
  addQuestion(differences, first.what, second.what);
  addPlace(differences, first, second);
  addVersions(differences, first, second);
  addParameters(differences, first, second);
  return differences.text();
}

}  // namespace limn::bench
