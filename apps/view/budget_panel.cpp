// The best technique and parameters for a time, from what limn tune or limn bench measured.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"
#include "core/base/error.h"
#include "core/bench/results_file.h"
#include "core/session/technique_choice.h"

namespace limn::app {

void ViewerWindow::readBudget() {
  measured_.clear();
  measuredChosen_ = 0;
  try {
    const std::filesystem::path file = std::filesystem::path(budgetText_) / "results.jsonl";
    measured_ = measuredQuestions(bench::readRows(file), state_.scene.scene);
    if (measured_.empty()) say(file.string() + " has no row of this scene");
  } catch (const Error& error) {
    say(error.what(), true);
  }
}

/// A setting that was measured, and the button that takes it.
void ViewerWindow::budgetSetting(const char* rank, const MeasuredSetting& setting) {
  ImGui::PushID(rank);
  ImGui::TextDisabled("%s", rank);
  wrapped(setting.text());
  ImGui::TextUnformatted(fmt::format("RMSE {:.4g}, {:.4g} ms", setting.rmse, setting.ms).c_str());
  ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(44));
  if (ImGui::SmallButton("take")) {
    try {
      state_.techniques = session::choiceOf(setting.technique, setting.parameters).resolve(registry_);
      moved();
    } catch (const Error& error) {
      say(error.what(), true);
    }
  }
  ImGui::PopID();
}

void ViewerWindow::budgetPanel() {
  if (beginRows("budget")) {
    nameCell(
        "measured in",
        "The folder of limn tune or limn bench, whose results.jsonl says what settings cost in this scene");
    const float button = scaled(52);
    ImGui::SetNextItemWidth(-button);
    bool read =
        ImGui::InputText("##folder", budgetText_, sizeof budgetText_, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    read |= ImGui::Button("Read", {-1, 0});
    if (read) readBudget();
    if (measured_.size() > 1) {
      nameCell("of", "Camera, light, term and size; times of one size do not hold for another");
      const auto text = [&](size_t i) {
        return fmt::format("{} ({} settings)", measured_[i].text, measured_[i].settings.size());
      };
      if (ImGui::BeginCombo("##question", text(measuredChosen_).c_str())) {
        for (size_t i = 0; i < measured_.size(); ++i) {
          ImGui::PushID(static_cast<int>(i));
          if (ImGui::Selectable(text(i).c_str(), i == measuredChosen_)) measuredChosen_ = i;
          ImGui::PopID();
        }
        ImGui::EndCombo();
      }
    }
    nameCell("at most", "Milliseconds that a frame may take");
    ImGui::SliderFloat("##ms", &budgetMs_, 0.1f, 1000, "%.3g ms", ImGuiSliderFlags_Logarithmic);
    endRows();
  }
  if (measured_.empty()) {
    const std::string command = tuneCommand(state_.scene, static_cast<double>(budgetMs_), budgetText_);
    wrapped("This measures settings into the folder, in a terminal:");
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    wrapped(command);
    ImGui::PopStyleColor();
    if (ImGui::Button("Copy")) {
      ImGui::SetClipboardText(command.c_str());
      say("the command is on the clipboard");
    }
    return;
  }
  const MeasuredQuestion& question = measured_[measuredChosen_];
  const BudgetAnswer answer = bestWithin(question, static_cast<double>(budgetMs_));
  if (answer.best)
    budgetSetting("best", *answer.best);
  else
    wrapped(fmt::format("None of {} settings is that quick; the quickest takes {:.3g} ms.",
                        question.settings.size(),
                        std::ranges::min_element(question.settings, {}, &MeasuredSetting::ms)->ms));
  if (answer.runnerUp) budgetSetting("runner-up", *answer.runnerUp);
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  wrapped(fmt::format("{}, on {}", question.text, question.renderer));
  ImGui::PopStyleColor();
}

}  // namespace limn::app
