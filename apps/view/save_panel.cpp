// What is written: pictures, sequences, suites, commands.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"
#include "core/base/error.h"
#include "core/base/file.h"

namespace limn::app {

/// The picture, whole, together with the command that renders it.
void ViewerWindow::save() {
  if (area_.x < 1 || area_.y < 1) return;  // there is no room for a picture
  SaveOrder wanted{
      .picture = order(), .file = saveText_, .command = renderCommand(state_, saveText_), .frames = {}};
  wanted.picture.moving = false;
  wanted.picture.size = area_;  // also where the window is minimised and shows none
  thread_->save(std::move(wanted));
}

void ViewerWindow::saveSequence() {
  if (area_.x < 1 || area_.y < 1) return;
  try {
    SaveOrder wanted{.picture = order(),
                     .file = saveText_,
                     .command = {},
                     .frames = parseFrames(framesText_),
                     .fps = static_cast<double>(fps_)};
    if (!wanted.frames) throw Error("frames: a:b is wanted, the first and the last frame");
    wanted.command = sequenceCommand(state_, saveText_, *wanted.frames, wanted.fps);
    wanted.picture.moving = wanted.picture.timed = false;
    wanted.picture.size = area_;
    wanted.picture.beside = Beside::nothing;
    wanted.picture.inspect.reset();
    playing_ = false;
    thread_->save(std::move(wanted));
  } catch (const Error& error) {
    say(error.what(), true);
  }
}

void ViewerWindow::saveSuite() {
  std::filesystem::path file = saveText_;
  file.replace_extension(".toml");
  try {
    if (file.has_parent_path()) createFolder(file.parent_path());
    writeTextFile(file, benchSuite(state_));
    say("wrote " + file.string());
  } catch (const Error& error) {
    say(error.what(), true);
  }
}

void ViewerWindow::copyCommand() {
  ImGui::SetClipboardText(renderCommand(state_, saveText_).c_str());
  say("the command is on the clipboard");
}

void ViewerWindow::savePanel() {
  if (beginRows("save")) {
    nameCell("file", ".png as shown, or .exr linear");
    ImGui::InputText("##save", &saveText_);
    nameCell("frames", "First and last frame of a sequence, a:b, written as file.0000.png and so on");
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::SetNextItemWidth(0.45f * width);
    ImGui::InputText("##frames", &framesText_);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    ImGui::DragFloat("##fps", &fps_, 0.1f, 0.1f, 1000, "%.4g per second", ImGuiSliderFlags_AlwaysClamp);
    endRows();
  }
  if (ImGui::Button("Picture")) save();
  tip("As it is, at its full size, with the command that renders it inside (F5)");
  ImGui::SameLine();
  if (ImGui::Button("Sequence")) saveSequence();
  tip("The frames of the animation, the same pixels as limn render --frames gives (F10)");
  ImGui::SameLine();
  if (ImGui::Button("Suite")) saveSuite();
  tip("For limn bench: this scene, these techniques and settings (F6)");
  ImGui::SameLine();
  if (ImGui::Button("Command")) copyCommand();
  tip("The command below goes to the clipboard (F7)");
  if (facts_->saving) {
    ImGui::ProgressBar(static_cast<float>(facts_->jobFraction), {-scaled(60), 0}, facts_->job.c_str());
    ImGui::SameLine();
    if (ImGui::Button("Stop")) thread_->cancelSaving();
  }
  remark(renderCommand(state_, saveText_));
}

}  // namespace limn::app
