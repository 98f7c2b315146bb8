// What the window shows before a scene is opened: how to open one.
#include <imgui.h>

#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"

namespace limn::app {

void ViewerWindow::startPage() {
  ImGui::SetCursorScreenPos({corner_.x + scaled(24), corner_.y + scaled(20)});
  ImGui::BeginChild("start",
                    {static_cast<float>(area_.x) - scaled(48), static_cast<float>(area_.y) - scaled(24)});
  if (ImGui::Button("Open a file")) browse();
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  wrapped("(Ctrl+O), or drop a .gltf or .glb file on this window.");
  wrapped("Models in other formats: limn import MODEL --out model.glb");
  ImGui::BeginDisabled(!facts_->job.empty());  // one is being opened
  if (!recentScenes_.empty()) {
    ImGui::Spacing();
    wrapped("Or take what was opened before:");
    for (const std::filesystem::path& file : recentScenes_)
      if (recentScene(file)) break;
  }
  ImGui::Spacing();
  wrapped(ownScenes_.empty() ? "limn's own scenes are not installed." : "Or take one of limn's own scenes:");
  const int columns = tableColumns(ImGui::GetContentRegionAvail().x, scaled(200));
  if (!ownScenes_.empty() && ImGui::BeginTable("scenes", columns)) {
    for (const std::string& name : ownScenes_) {
      ImGui::TableNextColumn();
      ownScene(name);
    }
    ImGui::EndTable();
  }
  ImGui::EndDisabled();
  ImGui::EndChild();
}

}  // namespace limn::app
