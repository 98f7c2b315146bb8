// Scene, camera, time and environment.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "apps/limn/tone_flags.h"
#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"
#include "core/question/question_fields.h"
#include "core/question/term.h"
#include "core/scene_io/load.h"

namespace limn::app {
namespace {

namespace fs = std::filesystem;

/// Returns true where another term was chosen.
bool termChooser(std::string& term) {
  if (!ImGui::BeginCombo("##shows", term.c_str())) return false;
  const std::string before = term;
  for (const TermInfo& info : kTerms) {
    if (!contains(kPicturedTerms, info.term)) continue;
    if (ImGui::Selectable(info.name, before == info.name)) term = info.name;
    tip(info.help);
  }
  ImGui::EndCombo();
  return term != before;
}

}  // namespace

void ViewerWindow::cameraChooser() {
  const std::vector<scene::CameraPose>& cameras = facts_->scene->cameras;
  std::string title = state_.scene.camera;
  if (title.empty()) title = facts_->scene->camera.name;
  if (!state_.scene.eye.empty()) title = "free";
  if (title.empty()) title = "frames the scene";
  if (!ImGui::BeginCombo("##camera", title.c_str())) return;
  const SceneFacts& shown = *facts_->scene;
  const auto choose = [&](const SceneQuestion& viewpoint, const Orbit& orbit) {
    for (const char* key : {"camera", "eye", "target"})
      copyField(questionField(key), state_.scene, viewpoint);
    orbit_ = orbit;
    moved();
  };
  if (ImGui::Selectable("as opened")) {
    Orbit orbit(original_->camera, original_->bounds);
    orbit.recount(original_->origin, shown.origin);
    choose(original_->options, orbit);
  }
  for (const scene::CameraPose& camera : cameras) {
    SceneQuestion named;
    named.camera = camera.name;
    if (ImGui::Selectable(camera.name.c_str())) choose(named, Orbit(camera, shown.bounds));
  }
  ImGui::EndCombo();
}

void ViewerWindow::timePanel() {
  nameCell("time", "Of the animation, seconds; space plays and pauses");
  if (ImGui::Button(playing_ ? "Pause" : "Play", {scaled(56), 0})) {
    playing_ = !playing_;
    moved();
  }
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  const double seconds = facts_->scene->seconds > 0 ? facts_->scene->seconds : 10;
  auto time = static_cast<float>(state_.scene.time);
  if (ImGui::SliderFloat("##time", &time, 0, static_cast<float>(seconds), "%.2f s")) {
    state_.scene.time = accepted(questionField("time"), time);
    moved();
  }
}

void ViewerWindow::exposureRow() {
  nameCell(
      "exposure",
      "Light is multiplied by 2^EV before it is shown; auto: the geometric mean of the picture's luminance "
      "becomes middle grey");
  if (ImGui::Checkbox("auto", &state_.automaticExposure)) {
    if (!state_.automaticExposure) state_.tone.exposureEv = facts_->exposureEv;
    moved();
  }
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  ImGui::BeginDisabled(state_.automaticExposure);
  float ev = state_.automaticExposure ? facts_->exposureEv : state_.tone.exposureEv;
  if (ImGui::SliderFloat("##exposure", &ev, -10, 10, "%.2f EV")) {
    // What is typed may lie beyond the slider, but not beyond --exposure.
    state_.tone.exposureEv = std::clamp(ev, -kMostExposureEv, kMostExposureEv);
    moved();
  }
  ImGui::EndDisabled();
}

void ViewerWindow::samplesRow() {
  nameCell("samples", "In each pixel (--aa); taken when the picture stands still, and in what is saved");
  const auto title = [](int aa) { return aa == 1 ? std::string("1") : fmt::format("{0} x {0}", aa); };
  if (!ImGui::BeginCombo("##samples", title(state_.scene.aa).c_str())) return;
  for (const int aa : {1, 2, 3, 4, 8}) {
    if (!ImGui::Selectable(title(aa).c_str(), aa == state_.scene.aa)) continue;
    state_.scene.aa = aa;
    moved();
  }
  ImGui::EndCombo();
}

void ViewerWindow::floorRow() {
  nameCell("floor", questionField("floor").doc);
  SceneQuestion wanted = awaited();
  bool floor = wanted.floor == "on";
  if (!ImGui::Checkbox("##floor", &floor)) return;
  wanted.floor = floor ? "on" : "off";
  open(wanted);
}

/// An entry for a file that was opened before; true where it is chosen.
bool ViewerWindow::recentScene(const fs::path& file) {
  ImGui::PushID(file.c_str());
  const bool chosen = ImGui::Selectable(file.filename().c_str());
  ImGui::PopID();
  tip(file.string());
  if (chosen) openFile(file);
  return chosen;
}

/// An entry for one of limn's own, which is opened where it is chosen.
void ViewerWindow::ownScene(const std::string& name) {
  const bool chosen = ImGui::Selectable(name.c_str());
  if (const auto about = aboutScenes_.find(name); about != aboutScenes_.end()) tip(about->second);
  if (chosen) openFile(name);
}

/// What was opened before, and limn's own scenes.
void ViewerWindow::sceneChooser() {
  constexpr int kArrow =
      ImGuiComboFlags_NoPreview | ImGuiComboFlags_PopupAlignLeft | ImGuiComboFlags_HeightLarge;
  if (!ImGui::BeginCombo("##scenes", "", kArrow)) return;
  for (const fs::path& file : recentScenes_)
    if (recentScene(file)) break;
  if (!recentScenes_.empty() && !ownScenes_.empty()) ImGui::Separator();
  for (const std::string& name : ownScenes_) ownScene(name);
  ImGui::EndCombo();
}

void ViewerWindow::scenePanel() {
  if (!beginRows("scene")) return;
  nameCell("file",
           "A glTF file or one of limn's scenes by name; enter opens it, and so does a file dropped on "
           "the window. F4 reads it again");
  ImGui::SetNextItemWidth(-scaled(60));
  if (ImGui::InputText("##file", &sceneText_, ImGuiInputTextFlags_EnterReturnsTrue) && !sceneText_.empty())
    openFile(sceneText_);
  ImGui::SameLine();
  if (ImGui::Button("...", {scaled(28), 0})) browse();
  tip("Chooses a file (Ctrl+O)");
  ImGui::SameLine();
  sceneChooser();
  if (facts_->scene) {
    nameCell("camera", "Of the scene; turning and flying makes it free");
    cameraChooser();
    nameCell("shows", "The whole light, or one part of it; visibility is that of one light");
    if (termChooser(state_.scene.term)) moved();
    exposureRow();
    nameCell(
        "tone curve",
        "none clamps and keeps values comparable, neutral keeps base colours, agx keeps detail in what is "
        "very bright");
    auto curve = static_cast<int>(state_.tone.curve);
    if (ImGui::Combo("##tone curve", &curve, kToneCurves.data(), static_cast<int>(kToneCurves.size()))) {
      state_.tone.curve = static_cast<ToneCurve>(curve);
      moved();
    }
    samplesRow();
    floorRow();
    if (facts_->scene->animated) timePanel();
  }
  endRows();
}

/// How lights stand for the environment, if they do.
void ViewerWindow::environmentLightRows(SceneQuestion& wanted) {
  if (!wanted.environment.empty() || (facts_->scene && facts_->scene->ownEnvironment)) {
    nameCell("as lights",
             "Area lights at infinity stand for it, so that every technique shadows it: how much "
             "of a light's energy a row of texels must add for it to grow; smaller: fewer lights");
    auto threshold = static_cast<float>(wanted.environmentLights);
    ImGui::SliderFloat("##threshold", &threshold, 0, 0.1f, threshold > 0 ? "%.3f" : "no",
                       ImGuiSliderFlags_AlwaysClamp);
    environmentThreshold_ = ImGui::IsItemActive() ? threshold : environmentThreshold_;
    if (ImGui::IsItemDeactivatedAfterEdit())
      wanted.environmentLights = environmentThreshold_ < 1e-3f ? 0 : environmentThreshold_;
  }
  if (wanted.environmentLights > 0) {
    const QuestionField& combine = questionField("environment_combine");
    nameCell("combined by", combine.doc);
    const std::string now = wanted.environmentCombine;
    if (ImGui::BeginCombo("##combine", now.c_str())) {
      for (const char* way : combine.choices)
        if (ImGui::Selectable(way, now == way)) wanted.environmentCombine = way;
      ImGui::EndCombo();
    }
  }
}

void ViewerWindow::environmentPanel() {
  const SceneQuestion before = awaited();
  SceneQuestion wanted = before;
  if (!beginRows("environment")) return;
  nameCell("map",
           "Equirectangular .hdr or .exr: those beside the present one, and limn's own. One that is "
           "dropped on the window is taken, too");
  const fs::path now = before.environment;
  const bool lit = facts_->scene && facts_->scene->environment;
  const std::string title = !now.empty() ? now.filename().string() : lit ? "by default" : "none";
  if (ImGui::BeginCombo("##map", title.c_str())) {
    const auto offer = [&](const std::string& entry, const fs::path& file) {
      if (ImGui::Selectable(entry.c_str(), file == now)) wanted.environment = file.string();
    };
    offer("by default", {});  // the scene's own or that of the default lights, where it has one
    for (const char* own : {"sky", "studio"}) offer(own, own);
    const fs::path folder = now.parent_path();  // empty: the working folder, as in names without one
    for (const fs::path& name : listFolder(folder).files)
      if (scene::isEnvironmentFile(name)) offer(name.string(), folder / name);
    ImGui::EndCombo();
  }
  bool turned = false;
  if (lit) {
    nameCell("rotation", "About the vertical axis");
    auto rotation = static_cast<float>(state_.scene.environmentRotation);
    turned |= ImGui::SliderFloat("##rotation", &rotation, -180, 180, "%.0f degrees");
    nameCell("scale", "Factor on its radiance");
    auto scale = static_cast<float>(state_.scene.environmentScale);
    turned |= ImGui::SliderFloat("##scale", &scale, 0, 16, "%.3g", ImGuiSliderFlags_Logarithmic);
    if (turned) {
      state_.scene.environmentRotation = accepted(questionField("environment_rotation"), rotation);
      state_.scene.environmentScale = accepted(questionField("environment_scale"), scale);
      moved();
    }
  }
  environmentLightRows(wanted);
  endRows();
  if (wanted != before) {
    // The map is given up, and the scene may have none of its own.
    if (wanted.environment.empty() && !before.environment.empty()) wanted.environmentLights = 0;
    open(wanted);
  }
}

}  // namespace limn::app
