// The best technique and parameters for a time, from what limn tune or limn bench measured; limn tune can be
// started here.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <chrono>

#include "apps/limn/options.h"
#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"
#include "core/base/error.h"
#include "core/base/failure.h"
#include "core/bench/results_file.h"
#include "core/question/question_fields.h"
#include "core/session/technique_choice.h"

namespace limn::app {

/// Reads the folder in the background; `question` is the one that is shown first.
void ViewerWindow::readBudget(const SceneQuestion& question) {
  if (reading_.valid()) return;
  measured_.clear();
  measuredChosen_ = 0;
  readOf_ = question;
  readUnasked_ = false;
  reading_ = std::async(std::launch::async, [folder = std::filesystem::path(budgetText_), question] {
    const std::filesystem::path file = folder / "results.jsonl";
    auto measured = measuredQuestions(bench::readRows(file), question.scene);
    if (measured.empty()) throw Error(file.string() + " has no row of this scene");
    return measured;
  });
}

/// Reads the folder when the panel is first shown for a scene.
void ViewerWindow::readBudgetUnasked() {
  if (budgetOf_ == state_.scene.scene || reading_.valid()) return;
  budgetOf_ = state_.scene.scene;
  std::error_code unknown;
  if (!std::filesystem::exists(std::filesystem::path(budgetText_) / "results.jsonl", unknown)) return;
  readBudget(TuneOrder::questionOf(state_.scene));
  readUnasked_ = true;
}

TuneOrder ViewerWindow::tuneOrder() const {
  return {.question = TuneOrder::questionOf(state_.scene),
          .ms = static_cast<double>(budgetMs_),
          .techniques = tuneTechniques_,
          .steps = tuneSteps_,
          .metric = tuneMetric_,
          .maskedShare = static_cast<double>(tuneMaskedPercent_) / 100,
          .folder = budgetText_,
          .device = options_.device};
}

void ViewerWindow::startTune() {
  tune_.reset();
  tuneProblem_.clear();
  tuned_ = tuneOrder();
  try {
    tune_ = std::make_unique<TuneSearch>(programBeside("limn").string(), tuneArguments(tuned_));
  } catch (const Error& error) {
    tuneProblem_ = error.what();
  }
}

/// Takes in what the search and the thread that reads have done.
void ViewerWindow::budgetNews() {
  // A search that ends while the folder is read would not be read itself: it ends after that.
  if (tune_ && !reading_.valid() && !tune_->poll()) {
    tuneProblem_ = tune_->problem();
    const bool cancelled = tune_->cancelled(), shown = sameScene(tuned_.question.scene, state_.scene.scene);
    tune_.reset();
    if (tuneProblem_.empty()) {
      say(cancelled ? fmt::format("stopped; Search goes on in {}", tuned_.folder)
                    : fmt::format("searched {}, into {}", tuned_.question.scene, tuned_.folder));
      sayInTerminal(message_);
    } else {
      sayInTerminal(tuneProblem_);
    }
    if (!cancelled && shown) {
      budgetText_ = tuned_.folder;
      readBudget(tuned_.question);
    }
  }
  if (!reading_.valid() || reading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  try {
    std::vector<MeasuredQuestion> measured = reading_.get();
    if (!sameScene(readOf_.scene, state_.scene.scene)) return;
    measured_ = std::move(measured);
    measuredChosen_ = placeOf(readOf_, measured_);
  } catch (const std::exception&) {
    if (tuneProblem_.empty() && !readUnasked_) say(currentFailure(), true);
  }
}

/// A setting that was measured for the term, and the button that takes it.
void ViewerWindow::budgetSetting(const char* rank, const MeasuredSetting& setting, Term term) {
  ImGui::PushID(rank);
  ImGui::TextDisabled("%s", rank);
  wrapped(setting.text());
  ImGui::TextUnformatted(
      fmt::format("{} {}, {:.4g} ms", tuneMetric_->label, shownText(*tuneMetric_, setting.error), setting.ms)
          .c_str());
  ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(44));
  if (ImGui::SmallButton("take")) {
    try {
      takeMeasured(state_.techniques,
                   session::choiceOf(setting.technique, setting.parameters).resolve(registry_), term);
      moved();
    } catch (const Error& error) {
      say(error.what(), true);
    }
  }
  tip("In place of the techniques that answer the same term");
  ImGui::PopID();
}

void ViewerWindow::budgetRows() {
  if (!beginRows("budget")) return;
  nameCell(
      "folder",
      "Of limn tune or limn bench: its results.jsonl says what settings cost in this scene; a search writes "
      "into it");
  const float button = scaled(52);
  ImGui::SetNextItemWidth(-button);
  bool read = ImGui::InputText("##folder", &budgetText_, ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  read |= ImGui::Button("Read", {-1, 0});
  if (read) {
    tuneProblem_.clear();
    readBudget(TuneOrder::questionOf(state_.scene));
  }
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
  ImGui::SliderFloat("##ms", &budgetMs_, 0.1f, 1000, "%.4g ms", ImGuiSliderFlags_Logarithmic);
  nameCell("among",
           "Techniques that a search chooses from, separated by commas; empty: all that answer the term");
  ImGui::InputTextWithHint("##among", "all that answer the term", &tuneTechniques_);
  nameCell("steps", "How many steps from each parameter's default a search tries in each direction");
  ImGui::SliderInt("##steps", &tuneSteps_, 0, 4, "%d", ImGuiSliderFlags_AlwaysClamp);
  nameCell("best by", tuneMetric_->help.data());
  if (ImGui::BeginCombo("##metric", tuneMetric_->label.data())) {
    for (const MetricInfo& metric : kQualityMetrics) {
      if (ImGui::Selectable(metric.label.data(), &metric == tuneMetric_)) tuneMetric_ = &metric;
      tip(metric.help.data());
    }
    ImGui::EndCombo();
  }
  nameCell(
      "left out",
      "Per cent of the pixels that may differ in coverage, instance or depth from the reference; a search "
      "does not count them");
  ImGui::SliderFloat("##masked", &tuneMaskedPercent_, 0, 100, "at most %.3g %%",
                     ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
  endRows();
}

/// The search: how it is started, how far it is, how it failed.
void ViewerWindow::tunePanel() {
  if (tune_) {
    ImGui::BeginDisabled(tune_->cancelled());
    if (ImGui::Button("Cancel")) tune_->cancel();
    ImGui::EndDisabled();
    tip("What has been measured is kept; the same search goes on from there");
    remark(fmt::format("searching {}", subjectText(tuned_.question, QuestionWording::label)));
    remark(tune_->progress().empty() ? "it begins" : tune_->progress());
    return;
  }
  const TuneOrder order = tuneOrder();
  if (ImGui::Button("Search")) startTune();
  tip(tuneCommand(order));
  ImGui::SameLine();
  if (ImGui::Button("Copy")) {
    ImGui::SetClipboardText(tuneCommand(order).c_str());
    say("the command is on the clipboard");
  }
  tip("The command that searches the same in a terminal");
  if (!tuneProblem_.empty()) complaint(tuneProblem_);
  std::string what = "Measures " + subjectText(order.question, QuestionWording::label) + " as it is now";
  if (order.question.term != state_.scene.term)
    what += fmt::format("; of {} only what shadows change", state_.scene.term);
  if (!options_.shaders.empty())
    what += fmt::format("; with limn's own shaders, not those of {}", options_.shaders.string());
  remark(what + ".");
}

/// What was measured says this.
void ViewerWindow::budgetAnswer() {
  const MeasuredQuestion& question = measured_[measuredChosen_];
  const BudgetAnswer answer = bestWithin(question, static_cast<double>(budgetMs_), *tuneMetric_);
  if (answer.best)
    budgetSetting("best", *answer.best, question.term);
  else
    wrapped(fmt::format("None of {} settings is that quick; the quickest takes {:.3g} ms.",
                        question.settings.size(),
                        std::ranges::min_element(question.settings, {}, &MeasuredSetting::ms)->ms));
  if (answer.runnerUp) budgetSetting("runner-up", *answer.runnerUp, question.term);
  remark(fmt::format("{}, on {}", question.text, question.renderer));
}

void ViewerWindow::budgetPanel() {
  readBudgetUnasked();
  budgetRows();
  tunePanel();
  if (!measured_.empty()) budgetAnswer();
}

}  // namespace limn::app
