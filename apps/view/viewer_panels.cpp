// The viewer's panels, left of the picture.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/view/parameter_widgets.h"
#include "apps/view/viewer_window.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/scene/camera.h"

namespace limn::app {
namespace {

constexpr const char* outputs[] = {"final", "visibility", "direct", "indirect", "caustic", "media"};
constexpr const char* besides[] = {"nothing", "other techniques", "the truth"};

std::string termsOf(const TechniqueInfo& info) {
  std::string text;
  for (const Term term :
       {Term::visibility, Term::direct, Term::indirect, Term::caustic, Term::media, Term::environment})
    if (contains(info.terms, term)) text += (text.empty() ? "" : ", ") + std::string(name(term));
  return text;
}

void wrapped(const std::string& text) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
}

void helpPanel() {
  constexpr const char* keys[][2] = {{"left drag", "turn around the scene"},
                                     {"shift, left drag", "look around"},
                                     {"right drag", "move sideways"},
                                     {"wheel", "nearer, farther"},
                                     {"W A S D Q E", "fly"},
                                     {"space", "play, pause"},
                                     {"F2", "the next technique of the same kind"},
                                     {"F3", "compare with nothing, others, the truth"},
                                     {"F4", "open the scene anew"},
                                     {"F5 F6 F7", "save picture, suite; copy command"},
                                     {"page down, up", "next, previous step of the guide"},
                                     {"ctrl Q", "close"}};
  if (!ImGui::BeginTable("keys", 2)) return;
  for (const auto& [key, does] : keys) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(key);
    ImGui::TableNextColumn();
    wrapped(does);
  }
  ImGui::EndTable();
}

}  // namespace

void ViewerWindow::panels() {
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({panelWidth, ImGui::GetIO().DisplaySize.y});
  ImGui::Begin("limn", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings);
  if (!options_.steps.empty()) guidePanel();
  framesPanelOpen_ = false;
  if (ImGui::CollapsingHeader("Scene", ImGuiTreeNodeFlags_DefaultOpen)) scenePanel();
  if (ImGui::CollapsingHeader("Techniques", ImGuiTreeNodeFlags_DefaultOpen)) {
    ImGui::PushID("techniques");
    techniquePanel(state_.techniques);
    ImGui::PopID();
  }
  if (ImGui::CollapsingHeader("Lights")) lightPanel();
  if (ImGui::CollapsingHeader("Compare")) comparePanel();
  if (ImGui::CollapsingHeader("Frame")) framePanel();
  if (ImGui::CollapsingHeader("Save")) savePanel();
  if (ImGui::CollapsingHeader("Keys")) helpPanel();
  ImGui::End();
}

void ViewerWindow::chooseStep(size_t step) {
  step_ = step;
  state_.techniques = resolve(options_.steps[step].techniques);
  moved();
}

void ViewerWindow::guidePanel() {
  const ViewerStep& step = options_.steps[step_];
  wrapped(fmt::format("{} of {}: {}", step_ + 1, options_.steps.size(), step.title));
  wrapped(step.sentence);
  const bool first = step_ == 0, last = step_ + 1 == options_.steps.size();
  ImGui::BeginDisabled(first);
  if (ImGui::Button("Back")) chooseStep(step_ - 1);
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(last);
  if (ImGui::Button("Next")) chooseStep(step_ + 1);
  ImGui::EndDisabled();
  ImGui::Separator();
}

std::string ViewerWindow::cameraTitle() const {
  if (!state_.scene.eye.empty()) return "free";
  return state_.scene.camera.empty() ? camera_.name : state_.scene.camera;
}

void ViewerWindow::scenePanel() {
  SceneOptions wanted = state_.scene;
  ImGui::InputText("file", sceneText_, sizeof sceneText_);
  ImGui::InputText("environment", environmentText_, sizeof environmentText_);
  if (ImGui::Button("Open")) {
    wanted = SceneOptions();
    wanted.scene = sceneText_;
    wanted.environment = environmentText_;
    wanted.size = state_.scene.size;
    tryOpen(wanted);
  }
  ImGui::SameLine();
  ImGui::TextDisabled("or drop a file on the window");

  const scene::Pose& pose = picture_->renderer().pose();
  if (!pose.cameras.empty() && ImGui::BeginCombo("camera", cameraTitle().c_str())) {
    for (const scene::CameraPose& camera : pose.cameras) {
      if (!ImGui::Selectable(camera.name.c_str())) continue;
      state_.scene.camera = camera.name;
      state_.scene.eye.clear();
      state_.scene.target.clear();
      camera_ = chooseCamera(state_.scene, pose);
      orbit_ = Orbit(camera_, pose.bounds);
      moved();
    }
    ImGui::EndCombo();
  }
  int output = static_cast<int>(state_.output);
  if (ImGui::Combo("shows", &output, outputs, IM_ARRAYSIZE(outputs))) {
    state_.output = static_cast<render::Output>(output);
    moved();
  }
  if (ImGui::SliderFloat("exposure, EV", &state_.exposure, -10, 10, "%.2f")) moved();
  if (!view_->scene.animations.empty() || !view_->scene.dynamic.empty()) {
    if (ImGui::Button(playing_ ? "Pause" : "Play")) {
      playing_ = !playing_;
      moved();
    }
    ImGui::SameLine();
    auto time = static_cast<float>(state_.scene.time);
    if (ImGui::SliderFloat("time, s", &time, 0, 10, "%.2f")) {
      state_.scene.time = time;
      moved();
    }
  }
}

void ViewerWindow::techniquePanel(std::vector<render::TechniqueUse>& uses) {
  bool changed = false;
  for (size_t i = 0; i < uses.size(); ++i) {
    const TechniqueInfo& info = *uses[i].plugin->info;
    ImGui::PushID(info.name);
    bool keep = true;
    if (ImGui::TreeNodeEx(info.name, ImGuiTreeNodeFlags_DefaultOpen)) {
      ImGui::TextDisabled("%s: %s", termsOf(info).c_str(), info.source);
      changed |= parameterWidgets(uses[i].parameters, ParameterValues(info.name, info.parameters));
      keep = !ImGui::Button("Remove");
      ImGui::TreePop();
    }
    ImGui::PopID();
    if (keep) continue;
    uses.erase(uses.begin() + static_cast<std::ptrdiff_t>(i));
    changed = true;
    break;
  }
  if (ImGui::BeginCombo("##add", "add or replace ...")) {
    for (const TechniquePlugin* plugin : registry_.all()) {
      const bool used =
          std::ranges::any_of(uses, [&](const render::TechniqueUse& use) { return use.plugin == plugin; });
      if (!used && ImGui::Selectable(plugin->info->name)) {
        uses.push_back({plugin, ParameterValues(plugin->info->name, plugin->info->parameters)});
        dropRivals(uses, *plugin);
        changed = true;
      }
      if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s\n%s", plugin->info->title, termsOf(*plugin->info).c_str());
    }
    ImGui::EndCombo();
  }
  if (changed) moved();
}

void ViewerWindow::lightPanel() {
  const std::vector<std::string>& names = picture_->renderer().pose().lightNames;
  const char* shown = view_->light == scene::none ? "all" : names[static_cast<size_t>(view_->light)].c_str();
  if (ImGui::BeginCombo("light", shown)) {
    for (int i = -1; i < static_cast<int>(names.size()); ++i) {
      if (!ImGui::Selectable(i < 0 ? "all" : names[static_cast<size_t>(i)].c_str())) continue;
      reference_.forget();
      view_->light = i;
      state_.scene.light = i < 0 ? "" : names[static_cast<size_t>(i)];
      moved();
    }
    ImGui::EndCombo();
  }
  auto size = static_cast<float>(state_.scene.lightSize);
  if (ImGui::SliderFloat("light size", &size, 0, 10, size > 0 ? "%.3f m" : "as in the scene",
                         ImGuiSliderFlags_Logarithmic)) {
    try {
      reference_.forget();
      if (size > 0) resizeLights(view_->scene, size);
      state_.scene.lightSize = size;
      if (!(size > 0)) tryOpen(state_.scene);
      moved();
    } catch (const Error& error) {
      message_ = error.what();
    }
  }
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("width and height of area lights, m; angular diameter of directional ones, radians");
}

void ViewerWindow::compareWith(Beside what) {
  beside_ = what;
  if (what == Beside::techniques && otherTechniques_.empty()) otherTechniques_ = state_.techniques;
  moved();
}

void ViewerWindow::comparePanel() {
  int beside = static_cast<int>(beside_);
  if (ImGui::Combo("with", &beside, besides, IM_ARRAYSIZE(besides))) compareWith(static_cast<Beside>(beside));
  if (beside_ == Beside::nothing) return;
  ImGui::SliderFloat("split", &split_, 0, 1, "%.2f");
  ImGui::Checkbox("difference", &showDifference_);
  if (beside_ == Beside::reference) {
    const ReferenceWorker::State state = reference_.state();
    if (!state.problem.empty())
      wrapped(state.problem);
    else if (state.spp > 0)
      wrapped(fmt::format("{} samples per pixel, noise {:.2g} %", state.spp, 100 * state.noise));
    if (reference_.running()) ImGui::ProgressBar(static_cast<float>(state.fraction), {-1, 0}, "refining");
  }
  if (metrics_) {
    wrapped(
        fmt::format("RMSE {:.5g}   relative MSE {:.4g}\nbias {:+.4g}   99.9 % {:.4g}\nPSNR {:.4g}   FLIP "
                    "{:.4g}   structured {:.4g}",
                    metrics_->rmse, metrics_->rel_mse, metrics_->bias, metrics_->p999, metrics_->psnr,
                    metrics_->flip, metrics_->structured));
  }
  if (beside_ == Beside::techniques) {
    ImGui::PushID("other");
    techniquePanel(otherTechniques_);
    ImGui::PopID();
  }
}

void ViewerWindow::framePanel() {
  framesPanelOpen_ = true;
  const auto& times = picture_->times();
  double longest = 0, sum = 0;
  for (const frame::PassTime& t : times) {
    longest = std::max(longest, t.milliseconds);
    sum += t.milliseconds;
  }
  wrapped(fmt::format("{} passes ran, {:.2f} ms; {:.1f} MiB", times.size(), sum,
                      static_cast<double>(picture_->renderer().memoryBytes()) / (1 << 20)));
  for (const frame::PassReport& pass : picture_->passes()) {
    const auto time = std::ranges::find_if(times, [&](const frame::PassTime& t) {
      return t.name == pass.name && t.technique == pass.technique;
    });
    const bool ran = pass.state == frame::PassState::run && time != times.end();
    if (ran) {
      ImGui::ProgressBar(longest > 0 ? static_cast<float>(time->milliseconds / longest) : 0, {90, 0},
                         fmt::format("{:.2f} ms", time->milliseconds).c_str());
    } else {
      ImGui::BeginDisabled();
      ImGui::ProgressBar(0, {90, 0}, std::string(frame::name(pass.state)).c_str());
      ImGui::EndDisabled();
    }
    ImGui::SameLine();
    ImGui::TextUnformatted(fmt::format("{}: {}", pass.technique, pass.name).c_str());
    if (ImGui::IsItemHovered()) {
      std::string tip = fmt::format("{}{:.1f} KiB", pass.reason.empty() ? "" : pass.reason + "\n",
                                    static_cast<double>(pass.bytes) / 1024);
      for (const std::string& read : pass.reads) tip += "\nreads " + read;
      for (const std::string& write : pass.writes) tip += "\nwrites " + write;
      ImGui::SetTooltip("%s", tip.c_str());
    }
  }
}

/// Writes the picture together with the command that renders it.
void ViewerWindow::save() {
  savePending_ = false;
  const std::filesystem::path file = saveText_;
  try {
    if (picture_->display() == nullptr) throw Error("there is no picture to save");
    Image image = picture_->read();
    image.metadata()["command"] = renderCommand(state_, file);
    if (file.has_parent_path()) createFolder(file.parent_path());
    writeImage(file, image, state_.exposure);
    message_ = "wrote " + file.string();
  } catch (const Error& error) {
    message_ = error.what();
  }
}

void ViewerWindow::saveSuite() {
  std::filesystem::path file = saveText_;
  file.replace_extension(".toml");
  try {
    if (file.has_parent_path()) createFolder(file.parent_path());
    writeTextFile(file, benchSuite(state_));
    message_ = "wrote " + file.string();
  } catch (const Error& error) {
    message_ = error.what();
  }
}

void ViewerWindow::copyCommand() {
  ImGui::SetClipboardText(renderCommand(state_, saveText_).c_str());
  message_ = "the command is on the clipboard";
}

void ViewerWindow::savePanel() {
  ImGui::InputText("file##save", saveText_, sizeof saveText_);
  if (ImGui::Button("Picture (F5)")) savePending_ = true;
  ImGui::SameLine();
  if (ImGui::Button("Suite (F6)")) saveSuite();
  ImGui::SameLine();
  if (ImGui::Button("Command (F7)")) copyCommand();
  wrapped(renderCommand(state_, saveText_));
}

}  // namespace limn::app
