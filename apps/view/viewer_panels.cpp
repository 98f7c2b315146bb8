// The panels left of the picture, those that are no longer than a screen; the others have files of their own.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <limits>

#include "apps/view/parameter_widgets.h"
#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/metric_table.h"
#include "core/question/term.h"

namespace limn::app {
namespace {

constexpr const char* kBesides[] = {"nothing", "the truth", "other techniques"};

std::string termsOf(const TechniqueInfo& info) {
  return fmt::format("{}", fmt::join(termNames(info.terms), ", "));
}

/// Says which terms leave room for one technique, and which for several.
std::string ruleOfTerms() {
  std::vector<std::string> alone;
  for (const TermInfo& info : kTerms)
    if (info.exclusive && (alone.empty() || alone.back() != info.exclusive))
      alone.emplace_back(info.exclusive);
  constexpr TermSet together =
      termsWhere([](const TermInfo& info) { return info.answerable && !info.exclusive; });
  return fmt::format("One technique each for {}; answers of several to {} add up", joined(alone),
                     joined(termNames(together)));
}

void helpPanel() {
  constexpr const char* keys[][2] = {{"left drag", "turn around the scene"},
                                     {"shift, left drag", "look around"},
                                     {"right drag", "move sideways"},
                                     {"wheel", "nearer, farther"},
                                     {"W A S D Q E", "fly"},
                                     {"space", "play, pause"},
                                     {"F2", "the next technique of the same kind"},
                                     {"F3", "compare with nothing, the truth, others"},
                                     {"F4", "read the scene's file again"},
                                     {"ctrl O", "choose a file to open"},
                                     {"ctrl Z, ctrl shift Z", "undo, redo"},
                                     {"F5 F6 F7", "save picture, suite; copy command"},
                                     {"F8", "look at the frame's next texture"},
                                     {"F9", "difference instead of the right part"},
                                     {"F10", "save the sequence"},
                                     {"escape", "close the inspector, dismiss a note"},
                                     {"page down, up", "next, previous step of the guide"},
                                     {"ctrl Q", "close"}};
  if (!ImGui::BeginTable("keys", 2)) return;
  ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthFixed, scaled(150));
  ImGui::TableSetupColumn("does", ImGuiTableColumnFlags_WidthStretch);
  for (const auto& [key, does] : keys) {
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", key);
    ImGui::TableNextColumn();
    wrapped(does);
  }
  ImGui::EndTable();
}

}  // namespace

void ViewerWindow::panels() {
  ImGui::SetNextWindowPos({0, 0});
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float height = std::max(window.y, 1.f), most = std::numeric_limits<float>::max();
  ImGui::SetNextWindowSize({panelWidth_, height});
  ImGui::SetNextWindowSizeConstraints({scaled(kPanelWidth) / 2, height}, {most, height});
  ImGui::Begin("limn", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  panelWidth_ = ImGui::GetWindowWidth();  // its edge can be dragged
  if (!options_.steps.empty()) guidePanel();
  const auto section = [&](const char* title, const char* option) {
    const bool open = std::ranges::find(options_.panels, option) != options_.panels.end();
    ImGui::SetNextItemOpen(open, ImGuiCond_Once);
    return ImGui::CollapsingHeader(title);
  };
  if (section("Scene", "scene")) scenePanel();
  if (section("Techniques", "techniques")) {
    ImGui::PushID("techniques");
    techniquePanel(state_.techniques);
    ImGui::PopID();
  }
  lightPanelOpen_ = section("Lights", "lights");
  if (lightPanelOpen_) lightPanel();
  if (section("Environment", "environment")) environmentPanel();
  if (section("Compare", "compare")) comparePanel();
  if (section("Budget", "budget") && facts_->scene) budgetPanel();
  framePanelOpen_ = section("Frame", "frame");
  if (framePanelOpen_) framePanel();
  if (section("Save", "save") && facts_->scene) savePanel();
  if (section("Keys", "keys")) helpPanel();
  ImGui::End();
}

/// Stays at the present step where the techniques of the other one are refused.
void ViewerWindow::chooseStep(size_t step) {
  try {
    state_.techniques = options_.steps[step].techniques.resolve(registry_);
    step_ = step;
    moved();
  } catch (const Error& error) {
    say(error.what(), true);
  }
}

void ViewerWindow::guidePanel() {
  const ViewerStep& step = options_.steps[step_];
  ImGui::TextDisabled("%s", fmt::format("{} of {}", step_ + 1, options_.steps.size()).c_str());
  ImGui::SameLine();
  wrapped(step.title);
  wrapped(step.sentence);
  ImGui::BeginDisabled(step_ == 0);
  if (ImGui::Button("Back")) chooseStep(step_ - 1);
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(step_ + 1 == options_.steps.size());
  if (ImGui::Button("Next")) chooseStep(step_ + 1);
  ImGui::EndDisabled();
  ImGui::Separator();
}

void ViewerWindow::techniquePanel(std::vector<render::TechniqueUse>& uses) {
  bool changed = false;
  for (size_t i = 0; i < uses.size(); ++i) {
    const TechniqueInfo& info = *uses[i].plugin->info;
    ImGui::PushID(info.name);
    ImGui::SetNextItemOpen(true, ImGuiCond_Once);
    const bool open = ImGui::TreeNodeEx(nameOf(uses[i]).c_str(), ImGuiTreeNodeFlags_AllowItemOverlap);
    tip(fmt::format("{}\nAnswers: {}\n{}", info.title, termsOf(info), info.source));
    ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(52));
    const bool keep = !ImGui::SmallButton("remove");
    if (open) {
      changed |= parameterWidgets(uses[i].parameters, ParameterValues(info.name, info.parameters));
      ImGui::TreePop();
    }
    ImGui::PopID();
    if (keep) continue;
    uses.erase(uses.begin() + static_cast<std::ptrdiff_t>(i));
    changed = true;
    break;
  }
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##add", "add or replace ...", ImGuiComboFlags_HeightLargest)) {
    for (const TechniquePlugin* plugin : registry_.all()) {
      const bool used =
          std::ranges::any_of(uses, [&](const render::TechniqueUse& use) { return use.plugin == plugin; });
      if (used) continue;
      const bool chosen = ImGui::Selectable(plugin->info->name);
      tip(plugin->info->title);
      ImGui::SameLine(scaled(250));
      ImGui::TextDisabled("%s", termsOf(*plugin->info).c_str());
      if (!chosen) continue;
      uses.push_back({plugin, ParameterValues(plugin->info->name, plugin->info->parameters)});
      dropRivals(uses, *plugin);
      changed = true;
    }
    ImGui::EndCombo();
  }
  tip(ruleOfTerms());
  if (changed) moved();
}

void ViewerWindow::compareWith(Beside what) {
  beside_ = what;
  if (what == Beside::techniques && otherTechniques_.empty()) {
    otherTechniques_ = state_.techniques;
    useNextTechnique(otherTechniques_, registry_);
    history_.fillOthers(otherTechniques_);
  }
  moved();
}

void ViewerWindow::comparePanel() {
  const PictureFacts& facts = *facts_;
  if (beginRows("compare")) {
    nameCell("with", "What the right part of the picture shows; F3 goes through them");
    int beside = static_cast<int>(beside_);
    if (ImGui::Combo("##with", &beside, kBesides, IM_ARRAYSIZE(kBesides)))
      compareWith(static_cast<Beside>(beside));
    if (beside_ != Beside::nothing) {
      nameCell("right part",
               "The picture itself, or left minus right in luminance: blue too dark, red too "
               "bright, logarithmic (F9)");
      if (ImGui::RadioButton("picture", !showDifference_)) showDifference_ = false;
      ImGui::SameLine();
      if (ImGui::RadioButton("difference", showDifference_)) showDifference_ = true;
    }
    endRows();
  }
  if (beside_ == Beside::nothing) return;
  if (beside_ == Beside::reference) {
    const ReferenceWorker::State& state = facts.reference;
    if (state.spp > 0)
      wrapped(fmt::format("{} samples per pixel, noise {:.2g} % of the mean{}", state.spp, 100 * state.noise,
                          state.fromDisk ? ", from disk" : ""));
    for (const std::string& problem : {state.problem, state.unkept})
      if (!problem.empty()) complaint(problem);
    if (state.running)
      ImGui::ProgressBar(static_cast<float>(state.fraction), {-1, 0},
                         fmt::format("refining, {:.0f} %", 100 * state.fraction).c_str());
  }
  if (facts.metrics && ImGui::BeginTable("metrics", 4)) {
    for (const MetricInfo& info : kQualityMetrics) {
      ImGui::TableNextColumn();
      ImGui::TextDisabled("%s", std::string(info.head).c_str());
      tip(fmt::format("{}; x is the left part, r the right one", info.help));
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(
          fmt::format("{}{}{}", shownText(info, *facts.metrics), info.unit.empty() ? "" : " ", info.unit)
              .c_str());
    }
    ImGui::EndTable();
  }
  if (!facts.metrics && !facts.whyNoMetrics.empty()) ImGui::TextDisabled("%s", facts.whyNoMetrics.c_str());
  if (beside_ == Beside::techniques) {
    ImGui::PushID("other");
    techniquePanel(otherTechniques_);
    ImGui::PopID();
  }
}

}  // namespace limn::app
