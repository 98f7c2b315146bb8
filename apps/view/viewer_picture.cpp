// The viewer's picture: one technique, two side by side along a line that can be dragged, or their
// difference.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/view/difference.h"
#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"

namespace limn::app {
namespace {

constexpr float kSplitPixels = 6;  // of the line between two pictures, before scaled()

/// The columns from `from` to `to` (parts of the width) of a picture that fills the area.
void drawColumns(const gpu::Texture& texture, glm::vec2 corner, glm::vec2 size, float from, float to) {
  ImGui::GetWindowDrawList()->AddImage(textureId(texture), im(corner + size * glm::vec2(from, 0)),
                                       im(corner + size * glm::vec2(to, 1)), {from, 0}, {to, 1});
}

/// White text that is readable on any picture.
void label(glm::vec2 place, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(im(place - glm::vec2(5, 2)), im(place + glm::vec2(size.x + 5, size.y + 2)), 0xa0000000,
                     3);
  draw.AddText(im(place), 0xffffffff, text.c_str());
}

std::string caption(const std::vector<render::TechniqueUse>& uses) {
  return uses.empty() ? "unshadowed" : namesOf(uses, ", ");
}

}  // namespace

void ViewerWindow::drawColourBar(glm::vec2 corner, float width) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  constexpr int cells = 64;
  const float height = scaled(18), margin = scaled(6);
  draw.AddRectFilled(im(corner - margin), im(corner + glm::vec2(width + margin, 2 * height + 2)), 0xa0000000,
                     3);
  for (int i = 0; i < cells; ++i) {
    const glm::vec3 c = differenceColour(2 * (static_cast<float>(i) + 0.5f) / cells - 1);
    const float left = width * static_cast<float>(i) / cells,
                right = width * static_cast<float>(i + 1) / cells;
    draw.AddRectFilled(im(corner + glm::vec2(left, 0)), im(corner + glm::vec2(right, height)),
                       ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, 1}));
  }
  const DifferenceScale scale;
  const auto number = [&](float part, const std::string& text) {
    const float wide = ImGui::CalcTextSize(text.c_str()).x;
    const float most = std::max(width - wide, 0.f);  // of a narrow picture there is no room for it
    draw.AddText(im(corner + glm::vec2(std::clamp(part * width - wide / 2, 0.f, most), height)), 0xffffffff,
                 text.c_str());
  };
  number(0, fmt::format("-{:g} too dark", scale.most));
  number(0.5f, fmt::format("within {:g}", scale.least));
  number(1, fmt::format("too bright {:g}", scale.most));
}

void ViewerWindow::handleMouse() {
  if (!facts_->scene) return;
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 drag(io.MouseDelta.x, io.MouseDelta.y);
  bool changed = false;
  // An animation may have moved the scene's camera: the hand takes it from where it is seen.
  if (state_.scene.eye.empty() && sameViewpoint(state_.scene, facts_->asked))
    orbit_ = Orbit(facts_->camera, facts_->scene->bounds);
  if (ImGui::IsItemActive() && (drag.x != 0 || drag.y != 0)) {
    const glm::vec2 part = drag / glm::vec2(area_);
    if (io.MouseDown[0] && io.KeyShift)
      orbit_.look(3 * part.x, -3 * part.y);
    else if (io.MouseDown[0])
      orbit_.turn(0.01f * drag.x, 0.01f * drag.y);
    else
      orbit_.pan(-part.x, part.y);
    changed = true;
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    orbit_.approach(std::pow(0.9f, io.MouseWheel));
    changed = true;
  }
  if (!io.WantTextInput && !io.KeyCtrl && !browsing_) {
    const float step = 0.6f * std::min(io.DeltaTime, 0.1f);
    const auto held = [&](char key) { return ImGui::IsKeyDown(key) ? step : 0.f; };
    const glm::vec3 flight(held('D') - held('A'), held('E') - held('Q'), held('W') - held('S'));
    if (flight != glm::vec3(0)) {
      orbit_.fly(flight.x, flight.y, flight.z);
      changed = true;
    }
  }
  if (!changed) return;
  setCamera(state_.scene, orbit_, facts_->scene->origin);
  moved();
}

void ViewerWindow::press(const KeyPress& pressed) {
  const int key = pressed.key;
  if (pressed.control) {
    if (opensAnotherFile()) return;  // nothing is undone beyond it
    const bool back = key == GLFW_KEY_Z && !pressed.shift;
    if (back || key == GLFW_KEY_Z || key == GLFW_KEY_Y) {
      history_.note(present());
      restore(back ? history_.undo() : history_.redo());
    }
    return;
  }
  if (key == GLFW_KEY_SPACE && facts_->scene && facts_->scene->animated) {
    playing_ = !playing_;
    moved();
  }
  if (key == GLFW_KEY_F2) {
    useNextTechnique(state_.techniques, registry_);
    moved();
  }
  if (key == GLFW_KEY_F3) compareWith(static_cast<Beside>((static_cast<int>(beside_) + 1) % 3));
  if (key == GLFW_KEY_F4) open(awaited());
  if (key == GLFW_KEY_F5) save();
  if (key == GLFW_KEY_F6) saveSuite();
  if (key == GLFW_KEY_F7) copyCommand();
  if (key == GLFW_KEY_F8) inspectNext();
  if (key == GLFW_KEY_F9) showDifference_ = !showDifference_;
  if (key == GLFW_KEY_F10) saveSequence();
  if (key == GLFW_KEY_ESCAPE) {
    inspection_.reset();
    message_.clear();
  }
  if (key == GLFW_KEY_PAGE_DOWN && step_ + 1 < options_.steps.size()) chooseStep(step_ + 1);
  if (key == GLFW_KEY_PAGE_UP && step_ > 0) chooseStep(step_ - 1);
}

/// What is pressed while the first scene is being opened waits for it. A text field takes all but function
/// keys.
void ViewerWindow::handleKeys() {
  const auto typed = [](const KeyPress& pressed) {
    return pressed.key < GLFW_KEY_F1 || pressed.key > GLFW_KEY_F25;
  };
  if (ImGui::GetIO().WantTextInput) std::erase_if(pressed_, typed);
  if (!facts_->scene) {
    if (std::ranges::find(pressed_, GLFW_KEY_ESCAPE, &KeyPress::key) != pressed_.end()) message_.clear();
    if (!opening_) pressed_.clear();
    return;
  }
  for (const KeyPress& pressed : pressed_) press(pressed);
  pressed_.clear();
}

void ViewerWindow::drawPictures(glm::vec2 corner, glm::vec2 size) {
  const PictureFacts& facts = *facts_;
  std::shared_ptr<const Image8> right;
  if (beside_ == Beside::techniques) right = facts.other.image;
  if (beside_ == Beside::reference) right = facts.truth;
  const bool difference = showDifference_ && facts.metrics && facts.difference && beside_ != Beside::nothing;
  if (difference) right = facts.difference;
  const float line = right ? split_ : 1;
  if (facts.picture.image) drawColumns(textures_->of(facts.picture.image, GL_LINEAR), corner, size, 0, line);
  if (!right) return;
  const GLenum filter = right == facts.other.image ? GL_LINEAR : GL_NEAREST;
  drawColumns(textures_->of(right, filter), corner, size, line, 1);
  const float x = corner.x + line * size.x;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddLine({x - 1, corner.y}, {x - 1, corner.y + size.y}, 0x80000000, 3);
  draw.AddLine({x, corner.y}, {x, corner.y + size.y}, 0xffffffff);
  const std::string other = difference                      ? "difference"
                            : beside_ == Beside::techniques ? caption(otherTechniques_)
                                                            : "truth";
  const std::string mine = caption(state_.techniques);
  label({x - ImGui::CalcTextSize(mine.c_str()).x - 12, corner.y + 8}, mine);
  label({x + 12, corner.y + 8}, other);
  if (difference)
    drawColourBar(corner + glm::vec2(scaled(14), size.y - scaled(46)),
                  std::min(size.x - scaled(28), scaled(420)));
}

void ViewerWindow::statusLine(glm::vec2 corner, float width) const {
  const PictureFacts& facts = *facts_;
  std::string text;
  if (facts.picture.image)
    text = fmt::format("{} x {}{}   {:.1f} ms", facts.picture.size.x, facts.picture.size.y,
                       facts.picture.whole ? "" : " (reduced)", facts.picture.ms);
  if (facts.metrics)
    text += fmt::format("   RMSE {:.4g}   bias {:+.3g}   FLIP {:.3g}", facts.metrics->rmse,
                        facts.metrics->bias, facts.metrics->flip);
  if (facts.toCompile > 0) text += fmt::format("   compiling {} of {}", facts.compiled + 1, facts.toCompile);
  if (!facts.job.empty()) text += "   " + facts.job;
  ImGui::SetCursorScreenPos(im(corner));
  std::string shown = text;
  while (!shown.empty() && ImGui::CalcTextSize((shown + "...").c_str()).x > width) shown.pop_back();
  const bool cut = ImGui::CalcTextSize(text.c_str()).x > width;
  ImGui::TextUnformatted(cut ? (shown + "...").c_str() : text.c_str());
  if (cut) tip(text);
}

/// The last message, above the picture's lower edge, as high as it takes.
void ViewerWindow::messageBox(glm::vec2 lowest, float width) {
  const float padding = scaled(6), room = width - 2 * padding;
  if (message_.empty() || room < padding) return;
  const ImVec2 size = ImGui::CalcTextSize(message_.c_str(), nullptr, false, room);
  const glm::vec2 corner = lowest - glm::vec2(0, size.y + 2 * padding);
  ImGui::GetWindowDrawList()->AddRectFilled(im(corner), im(corner + glm::vec2(size.x, size.y) + 2 * padding),
                                            0xc8000000, scaled(3));
  ImGui::SetCursorScreenPos(im(corner + padding));
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + room);
  ImGui::TextColored(messageIsProblem_ ? kProblemColour : ImVec4(1, 1, 1, 1), "%s", message_.c_str());
  ImGui::PopTextWrapPos();
}

void ViewerWindow::pictureArea() {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float statusHeight = scaled(kStatusHeight);
  ImGui::SetNextWindowPos({panelWidth_, 0});
  ImGui::SetNextWindowSize({std::max(window.x - panelWidth_, 1.f), std::max(window.y, 1.f)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin("picture", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
  ImGui::PopStyleVar();
  const ImVec2 place = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const glm::vec2 size(room.x, room.y - statusHeight);
  corner_ = {place.x, place.y};
  const glm::ivec2 area = glm::max(glm::ivec2(size), glm::ivec2(0));
  if (area != area_) moved();
  area_ = area;
  if (area_.x > 0 && area_.y > 0) {
    state_.scene.width = area_.x;
    state_.scene.height = area_.y;
  }
  handleKeys();
  if (area_.x > 0 && area_.y > 0) {
    ImGui::InvisibleButton("hands", im(size),
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    if (!dragLight() && !dragSplit()) handleMouse();
    drawPictures(corner_, size);
    if (lightPanelOpen_) drawLights();
    const PictureFacts& facts = *facts_;
    std::string problem = facts.picture.problem;
    for (const std::string& other : {facts.other.problem, facts.shaderProblem})
      if (!other.empty()) problem += (problem.empty() ? "" : "\n") + other;
    if (!problem.empty()) {
      ImGui::SetCursorScreenPos(im(corner_ + scaled(12)));
      ImGui::PushTextWrapPos(size.x - scaled(12));
      ImGui::TextColored(kProblemColour, "%s", problem.c_str());
      ImGui::PopTextWrapPos();
    }
    if (state_.scene.scene.empty()) startPage();
    messageBox(corner_ + glm::vec2(scaled(8), size.y - scaled(8)), size.x - scaled(16));
  }
  statusLine({place.x + scaled(10), place.y + room.y - statusHeight + scaled(7)}, size.x - scaled(20));
  ImGui::End();
}

/// The line between two pictures; true while the mouse has it.
bool ViewerWindow::dragSplit() {
  if (beside_ == Beside::nothing || area_.x < 1) return false;
  const ImGuiIO& io = ImGui::GetIO();
  const float x = corner_.x + split_ * static_cast<float>(area_.x);
  const bool near = ImGui::IsItemHovered() && std::abs(io.MousePos.x - x) < scaled(kSplitPixels);
  if (near || splitDragged_) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (near && ImGui::IsMouseClicked(0)) splitDragged_ = true;
  if (!io.MouseDown[0]) splitDragged_ = false;
  if (splitDragged_) split_ = std::clamp((io.MousePos.x - corner_.x) / static_cast<float>(area_.x), 0.f, 1.f);
  return splitDragged_;
}

}  // namespace limn::app
