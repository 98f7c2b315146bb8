// The dialog that walks through folders to a scene or an environment.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"

namespace limn::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTitle = "Open a scene or an environment";

}  // namespace

void ViewerWindow::browse(const fs::path& folder) {
  browsing_ = listFolder(folder);
  dismissed_ = false;
  folderText_ = browsing_->folder.string();
}

/// Where the scene that is shown lies, unless it is one of limn's; the working folder otherwise.
void ViewerWindow::browse() {
  const fs::path scene = state_.scene.scene;
  browse(scene.has_parent_path() ? scene.parent_path() : fs::path());
}

/// The folders, then the files; what is chosen is walked into or opened.
void ViewerWindow::browsedEntries() {
  fs::path into, chosen;
  if (browsing_->folder.has_relative_path() &&
      ImGui::Selectable("..", false, ImGuiSelectableFlags_DontClosePopups))
    into = browsing_->folder.parent_path();
  for (const fs::path& name : browsing_->folders)
    if (ImGui::Selectable((name.string() + "/").c_str(), false, ImGuiSelectableFlags_DontClosePopups))
      into = browsing_->folder / name;
  for (const fs::path& name : browsing_->files)
    if (ImGui::Selectable(name.c_str())) chosen = browsing_->folder / name;
  if (!browsing_->problem.empty())
    complaint(browsing_->problem);
  else if (browsing_->folders.empty() && browsing_->files.empty())
    remark("No .gltf, .glb, .hdr or .exr here");
  if (!into.empty()) browse(into);
  if (chosen.empty()) return;
  openFile(chosen);
  browsing_.reset();
}

void ViewerWindow::openDialog() {
  if (!browsing_) return;
  if (!ImGui::IsPopupOpen(kTitle)) ImGui::OpenPopup(kTitle);
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(scaled(560), 0.9f * window.x), std::min(scaled(480), 0.9f * window.y)});
  bool open = true;
  if (!ImGui::BeginPopupModal(
          kTitle, &open,
          ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings))
    return;
  ImGui::SetNextItemWidth(-1);
  if (ImGui::InputText("##folder", &folderText_, ImGuiInputTextFlags_EnterReturnsTrue))
    browse(fs::path(folderText_));
  tip("Enter goes to the folder");
  ImGui::BeginChild("entries");
  browsedEntries();
  ImGui::EndChild();
  if (!open || dismissed_) browsing_.reset();
  if (!browsing_) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

}  // namespace limn::app
