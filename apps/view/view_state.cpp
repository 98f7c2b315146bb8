#include "apps/view/view_state.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/limn/tone_flags.h"
#include "core/bench/suite_text.h"
#include "core/question/render_command.h"

namespace limn::app {
namespace {

/// The shortest text that reads as the same numbers.
std::string worldText(const glm::vec3& v, const glm::dvec3& origin) {
  if (origin == glm::dvec3(0)) return fmt::format("{},{},{}", v.x, v.y, v.z);
  const glm::dvec3 world = origin + glm::dvec3(v);
  return fmt::format("{},{},{}", world.x, world.y, world.z);
}

/// Parameters that are not at their defaults: "technique.parameter" and printed value.
std::vector<std::pair<std::string, std::string>> changed(const std::vector<render::TechniqueUse>& uses) {
  std::vector<std::pair<std::string, std::string>> result;
  for (const render::TechniqueUse& use : uses) {
    const auto now = use.parameters.printed();
    const auto before = ParameterValues(use.plugin->info->name, use.plugin->info->parameters).printed();
    for (size_t i = 0; i < now.size(); ++i)
      if (now[i].second != before[i].second)
        result.emplace_back(fmt::format("{}.{}", use.plugin->info->name, now[i].first), now[i].second);
  }
  return result;
}

}  // namespace

double accepted(const QuestionField& field, double value) {
  return std::clamp(value, field.range.low, field.range.high);
}

bool sameViewpoint(const SceneQuestion& a, const SceneQuestion& b) {
  return a.camera == b.camera && a.eye == b.eye && a.target == b.target;
}

void setCamera(SceneQuestion& options, const Orbit& orbit, const glm::dvec3& origin) {
  options.eye = worldText(orbit.eye(), origin);
  options.target = worldText(orbit.target(), origin);
}

void dropRivals(std::vector<render::TechniqueUse>& techniques, const TechniquePlugin& added) {
  const TermSet claimed = refusedBeside(added.info->terms);
  const auto rivals = [&](const render::TechniqueUse& use) {
    return use.plugin != &added && (termsOf(use) & claimed) != 0;
  };
  std::erase_if(techniques, rivals);
}

void useNextTechnique(std::vector<render::TechniqueUse>& techniques, const TechniqueRegistry& registry) {
  const TermSet alone = exclusiveWith(termSet(Term::direct));
  std::vector<const TechniquePlugin*> candidates;
  const auto claims = [&](const render::TechniqueUse& use) { return (termsOf(use) & alone) != 0; };
  for (const TechniquePlugin* plugin : registry.all()) {
    const auto forOthers = [&](const render::TechniqueUse& use) {
      return use.plugin == plugin && !claims(use);
    };
    if ((plugin->info->terms & alone) != 0 && std::ranges::none_of(techniques, forOthers))
      candidates.push_back(plugin);
  }
  size_t next = 0;
  for (const render::TechniqueUse& use : techniques)
    for (size_t i = 0; i < candidates.size(); ++i)
      if (use.plugin == candidates[i]) next = (i + 1) % candidates.size();
  const auto inUse = [&](const render::TechniqueUse& use) { return use.plugin == candidates[next]; };
  if (candidates.empty() || std::ranges::any_of(techniques, inUse)) return;
  const TechniquePlugin& plugin = *candidates[next];
  techniques.insert(techniques.begin(),
                    {&plugin, ParameterValues(plugin.info->name, plugin.info->parameters)});
  dropRivals(techniques, plugin);
}

void takeMeasured(std::vector<render::TechniqueUse>& techniques, std::vector<render::TechniqueUse> measured,
                  Term term) {
  TermSet replaced = term == Term::final ? kAnswerableTerms : exclusiveWith(termSet(term)) | term;
  for (const render::TechniqueUse& taken : measured) replaced |= refusedBeside(termsOf(taken));
  std::erase_if(techniques, [&](const render::TechniqueUse& use) {
    return (termsOf(use) & replaced) != 0 ||
           std::ranges::any_of(measured, [&](const auto& taken) { return taken.plugin == use.plugin; });
  });
  techniques.insert(techniques.begin(), measured.begin(), measured.end());
}

std::string renderCommand(const ViewState& state, const std::filesystem::path& out) {
  std::string line = limn::renderCommand(state.scene, namesOf(state.techniques), changed(state.techniques));
  if (state.automaticExposure)
    line += commandOption("--exposure", kAutomaticExposure);
  else if (state.tone.exposureEv != 0)
    line += commandOption("--exposure", fmt::format("{}", state.tone.exposureEv));
  if (state.tone.curve != ToneCurve::none)
    line += commandOption("--tonemap", kToneCurves[static_cast<size_t>(state.tone.curve)]);
  line += commandOption("--shaders", state.shaders.string());
  return line + commandOption("--out", out.string());
}

std::string sequenceCommand(const ViewState& state, const std::filesystem::path& out,
                            const FrameRange& frames, double fps) {
  ViewState timeless = state;
  timeless.scene.time = SceneQuestion().time;  // --frames sets it
  return renderCommand(timeless, out) +
         commandOption("--frames", fmt::format("{}:{}", frames.first, frames.last)) +
         commandOption("--fps", fmt::format("{}", fps));
}

SceneQuestion carriedOver(const SceneQuestion& now, const SceneQuestion& opened, bool sameFile) {
  SceneQuestion question = sameFile ? now : opened;
  if (sameFile) {
    copyFields(QuestionEffect::scene, question, opened);
  } else {
    for (const char* key : {"size", "aa", "term"}) copyField(questionField(key), question, now);
  }
  return question;
}

std::string benchSuite(const ViewState& state) {
  const SceneQuestion& question = state.scene;
  const Term term = parseTerm(question.term);
  const int bounces = render::bouncesOf(term, state.techniques);
  const int interfaces = render::interfacesOf(term, state.techniques);
  std::string text = fmt::format(
      "# Saved by limn-view: `limn bench` on this file measures what it showed.\nname = \"view\"\n{}"
      "reference = {{noise = 0.02, spp = 4096{}{}}}\npictures = true\n\n{}",
      bench::subjectToml(question), bounces > 0 ? fmt::format(", bounces = {}", bounces) : "",
      interfaces > 0 ? fmt::format(", interfaces = {}", interfaces) : "", bench::sceneToml(question));
  if (!state.techniques.empty())
    text += "\n" + bench::techniqueToml(namesOf(state.techniques), changed(state.techniques));
  return text;
}

}  // namespace limn::app
