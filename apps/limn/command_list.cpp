// limn list: what techniques, scenes, environments and suites there are.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "core/bench/suite.h"
#include "core/session/find.h"
#include "core/technique/registry.h"

namespace limn::app {
namespace {

const char* typeName(ParameterType type) {
  switch (type) {
    case ParameterType::boolean:
      return "boolean";
    case ParameterType::integer:
      return "integer";
    case ParameterType::real:
      return "real";
    case ParameterType::choice:
      return "choice";
  }
  return "";
}

std::string defaultText(const Parameter& p) {
  return ParameterValues("", {&p, 1}).printed().front().second;
}

nlohmann::ordered_json parameterJson(const Parameter& p) {
  nlohmann::ordered_json json{{"name", p.name}, {"type", typeName(p.type)}, {"default", defaultText(p)}};
  if (p.type == ParameterType::choice)
    json["choices"] = std::vector<std::string>(p.choices, p.choices + p.choiceCount);
  else if (p.type != ParameterType::boolean)
    json["range"] = {p.range.low, p.range.high};
  json["unit"] = p.unit;
  json["doc"] = p.doc;
  json["trades_error_for_time"] = p.tradesErrorForTime;
  return json;
}

void printJson(const TechniqueRegistry& registry) {
  nlohmann::ordered_json techniques = nlohmann::ordered_json::array();
  for (const TechniquePlugin* plugin : registry.all()) {
    const TechniqueInfo& info = *plugin->info;
    nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
    for (const Parameter& p : info.parameters) parameters.push_back(parameterJson(p));
    techniques.push_back({{"name", info.name},
                          {"title", info.title},
                          {"source", info.source},
                          {"terms", termNames(info.terms)},
                          {"parameters", parameters}});
  }
  nlohmann::ordered_json refused = nlohmann::ordered_json::array();
  for (const auto& refusal : registry.refused())
    refused.push_back({{"name", refusal.name}, {"reason", refusal.reason}});
  printAsJson({{"techniques", techniques}, {"refused", refused}});
}

std::string rangeText(const Parameter& p) {
  if (p.type == ParameterType::boolean) return "true|false";
  if (p.type == ParameterType::choice)
    return fmt::format("{}", fmt::join(p.choices, p.choices + p.choiceCount, "|"));
  return fmt::format("{}..{}", p.range.low, p.range.high);
}

void printText(const TechniqueRegistry& registry) {
  for (const TechniquePlugin* plugin : registry.all()) {
    const TechniqueInfo& info = *plugin->info;
    fmt::print("{}: {}\n  answers: {}\n  source: {}\n", info.name, info.title,
               fmt::join(termNames(info.terms), ", "), info.source);
    for (const Parameter& p : info.parameters)
      fmt::print("    {:<22} {:<12} {:<22} {}{}\n", p.name, defaultText(p),
                 fmt::format("{}{}{}", rangeText(p), *p.unit ? " " : "", p.unit), p.doc,
                 p.tradesErrorForTime ? " [quality]" : "");
    fmt::print("\n");
  }
  for (const auto& refusal : registry.refused())
    fmt::print(stderr, "limn: technique {} was refused: {}\n", refusal.name, refusal.reason);
}

struct ListArguments {
  std::string what = "techniques";
  bool json = false;
};

/// What is said of each suite.
std::map<std::string, std::string> aboutSuites() {
  std::map<std::string, std::string> about;
  for (const std::string& name : session::suiteNames())
    about[name] = bench::readSuite(session::findSuite(name)).about;
  return about;
}

/// What comes with limn beside its techniques: its names and what they are for.
struct ListedKind {
  std::vector<std::string> (*names)();
  std::map<std::string, std::string> (*about)();
};
const std::map<std::string, ListedKind> kListedKinds{
    {"scenes", {session::sceneNames, session::aboutScenes}},
    {"environments", {session::environmentNames, session::aboutEnvironments}},
    {"suites", {session::suiteNames, aboutSuites}}};

void printKind(const std::string& what, const ListedKind& kind, bool json) {
  std::map<std::string, std::string> about = kind.about();
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  for (const std::string& name : kind.names()) {
    entries.push_back({{"name", name}, {"about", about[name]}});
    if (!json) fmt::print("{}{}{}\n", name, about[name].empty() ? "" : ": ", about[name]);
  }
  if (json) printAsJson({{what, entries}});
}

int runList(const ListArguments& options) {
  if (const auto kind = kListedKinds.find(options.what); kind != kListedKinds.end()) {
    printKind(kind->first, kind->second, options.json);
    return 0;
  }
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders(), warn);
  options.json ? printJson(registry) : printText(registry);
  return 0;
}

}  // namespace

Action addListCommand(CLI::App& command) {
  auto options = std::make_shared<ListArguments>();
  command
      .add_option("what", options->what,
                  "techniques with their parameters, or limn's own scenes, environments or suites, and what "
                  "each is for")
      ->check(CLI::IsMember({"techniques", "scenes", "environments", "suites"}))
      ->capture_default_str();
  command.add_flag("--json", options->json, "Print JSON");
  return [options] { return runList(*options); };
}

}  // namespace limn::app
