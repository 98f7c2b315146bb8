#include "apps/view/view_state.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/question/question_fields.h"
#include "core/question/render_command.h"

namespace limn::app {
namespace {

/// The shortest text that reads as the same numbers.
std::string worldText(const glm::vec3& v, const glm::dvec3& origin) {
  if (origin == glm::dvec3(0)) return fmt::format("{},{},{}", v.x, v.y, v.z);
  const glm::dvec3 world = origin + glm::dvec3(v);
  return fmt::format("{},{},{}", world.x, world.y, world.z);
}

/// TOML basic string.
std::string tomlText(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      result += c;
  }
  return result + "\"";
}

/// Parameters that are not at their defaults: name and printed value.
std::vector<std::pair<std::string, std::string>> changed(const render::TechniqueUse& use) {
  const auto now = use.parameters.printed();
  const auto before = ParameterValues(use.plugin->info->name, use.plugin->info->parameters).printed();
  std::vector<std::pair<std::string, std::string>> result;
  for (size_t i = 0; i < now.size(); ++i)
    if (now[i].second != before[i].second) result.push_back(now[i]);
  return result;
}

std::string techniqueNames(const std::vector<render::TechniqueUse>& uses) {
  std::string names;
  for (const render::TechniqueUse& use : uses)
    names += (names.empty() ? "" : ",") + std::string(use.plugin->info->name);
  return names;
}

}  // namespace

void setCamera(SceneQuestion& options, const Orbit& orbit, const glm::dvec3& origin) {
  options.eye = worldText(orbit.eye(), origin);
  options.target = worldText(orbit.target(), origin);
}

void dropRivals(std::vector<render::TechniqueUse>& techniques, const TechniquePlugin& added) {
  const TermSet claimed = refusedBeside(added.info->terms);
  const auto rivals = [&](const render::TechniqueUse& use) {
    return use.plugin != &added && (use.plugin->info->terms & claimed) != 0;
  };
  std::erase_if(techniques, rivals);
}

std::string renderCommand(const ViewState& state, const std::filesystem::path& out) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const render::TechniqueUse& use : state.techniques)
    for (const auto& [name, value] : changed(use))
      settings.emplace_back(fmt::format("{}.{}", use.plugin->info->name, name), value);
  std::string line = limn::renderCommand(state.scene, techniqueNames(state.techniques), settings);
  if (state.tone.exposureEv != 0)
    line += commandOption("--exposure", fmt::format("{}", state.tone.exposureEv));
  if (state.tone.curve != ToneCurve::none)
    line += commandOption("--tonemap", kToneCurves[static_cast<size_t>(state.tone.curve)]);
  return line + commandOption("--out", out.string());
}

namespace {

/// The field's value as a suite has it.
std::string tomlValue(const QuestionField& field, const SceneQuestion& question) {
  std::vector<std::string> values = printed(field, question);
  switch (field.kind) {
    case QuestionKind::real:
    case QuestionKind::optionalReal:
    case QuestionKind::integer:
      return values.front();
    case QuestionKind::text:
    case QuestionKind::choice:
    case QuestionKind::coefficient:
    case QuestionKind::size:
      return tomlText(values.front());
    case QuestionKind::texts:
      break;
  }
  for (std::string& value : values) value = tomlText(value);
  return fmt::format("[{}]", fmt::join(values, ", "));
}

/// All but what the suite says itself.
std::string sceneTable(const SceneQuestion& question) {
  std::string text;
  for (const QuestionField& field : questionFields())
    if (!isDefault(field, question) && field.kind != QuestionKind::size &&
        field.key != std::string_view("term"))
      text += fmt::format("{} = {}\n", keyInSuite(field), tomlValue(field, question));
  return text;
}

std::string techniqueTable(const std::vector<render::TechniqueUse>& uses) {
  std::string text = fmt::format("\n[[techniques]]\ntechnique = {}\n", tomlText(techniqueNames(uses)));
  std::string values;
  for (const render::TechniqueUse& use : uses)
    for (const auto& [name, value] : changed(use)) {
      const std::string key = uses.size() > 1 ? fmt::format("\"{}.{}\"", use.plugin->info->name, name) : name;
      values += fmt::format("{}{} = [{}]", values.empty() ? "" : ", ", key, tomlText(value));
    }
  if (!values.empty()) text += fmt::format("parameters = {{{}}}\n", values);
  return text;
}

}  // namespace

std::string benchSuite(const ViewState& state) {
  const SceneQuestion& question = state.scene;
  const Term term = parseTerm(question.term);
  const int bounces = render::bouncesOf(term, state.techniques);
  const int interfaces = render::interfacesOf(term, state.techniques);
  std::string text = fmt::format(
      "# Saved by limn-view: `limn bench` on this file measures what it showed.\nname = \"view\"\nsizes = "
      "[{}]\nterm = {}\n",
      tomlValue(questionField("size"), question), tomlText(question.term));
  text += fmt::format("reference = {{noise = 0.02, spp = 4096{}{}}}\npictures = true\n\n[[scenes]]\n",
                      bounces > 0 ? fmt::format(", bounces = {}", bounces) : "",
                      interfaces > 0 ? fmt::format(", interfaces = {}", interfaces) : "");
  text += sceneTable(question);
  if (!state.techniques.empty()) text += techniqueTable(state.techniques);
  return text;
}

}  // namespace limn::app
