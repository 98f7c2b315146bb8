// The viewer's picture: one technique, two side by side along a line that can be dragged, or their
// difference.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/view/difference.h"
#include "apps/view/viewer_window.h"

namespace limn::app {
namespace {

constexpr float statusHeight = 28, barHeight = 18;  // pixels

ImVec2 im(glm::vec2 v) {
  return {v.x, v.y};
}

ImTextureID id(const gpu::Texture& texture) {
  return reinterpret_cast<ImTextureID>(static_cast<intptr_t>(texture.id()));
}

}  // namespace

/// The columns from `from` to `to` (parts of the width) of a picture that fills the area.
void ViewerWindow::drawPicture(const gpu::Texture& texture, glm::vec2 corner, glm::vec2 size, float from,
                               float to, bool bottomFirst) const {
  const float top = bottomFirst ? 1.f : 0.f;
  ImGui::GetWindowDrawList()->AddImage(id(texture), im(corner + size * glm::vec2(from, 0)),
                                       im(corner + size * glm::vec2(to, 1)), {from, top}, {to, 1 - top});
}

void ViewerWindow::drawColourBar(glm::vec2 corner, float width) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  constexpr int cells = 64;
  for (int i = 0; i < cells; ++i) {
    const glm::vec3 c = differenceColour(2 * (static_cast<float>(i) + 0.5f) / cells - 1);
    const float left = width * static_cast<float>(i) / cells,
                right = width * static_cast<float>(i + 1) / cells;
    draw.AddRectFilled(im(corner + glm::vec2(left, 0)), im(corner + glm::vec2(right, barHeight)),
                       ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, 1}));
  }
  const DifferenceScale scale;
  const auto label = [&](float part, const std::string& text) {
    const float wide = ImGui::CalcTextSize(text.c_str()).x;
    draw.AddText(im(corner + glm::vec2(std::clamp(part * width - wide / 2, 0.f, width - wide), barHeight)),
                 0xffffffff, text.c_str());
  };
  label(0, fmt::format("-{:g} too dark", scale.most));
  label(0.5f, fmt::format("within {:g}", scale.least));
  label(1, fmt::format("too bright {:g}", scale.most));
}

void ViewerWindow::handleMouse() {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 drag(io.MouseDelta.x, io.MouseDelta.y);
  bool changed = false;
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
  if (!io.WantTextInput && !io.KeyCtrl) {
    const float step = 0.6f * io.DeltaTime;
    const auto held = [&](char key) { return ImGui::IsKeyDown(key) ? step : 0.f; };
    const glm::vec3 flight(held('D') - held('A'), held('E') - held('Q'), held('W') - held('S'));
    if (flight != glm::vec3(0)) {
      orbit_.fly(flight.x, flight.y, flight.z);
      changed = true;
    }
  }
  if (!changed) return;
  setCamera(state_.scene, orbit_);
  camera_ = chooseCamera(state_.scene, picture_->renderer().pose());
  moved();
}

/// The technique that claims what only one may is replaced by the next one that does.
void ViewerWindow::nextTechnique() {
  const TermSet alone = Term::visibility | Term::direct;
  std::vector<const TechniquePlugin*> candidates;
  for (const TechniquePlugin* plugin : registry_.all())
    if ((plugin->info->terms & alone) != 0) candidates.push_back(plugin);
  size_t next = 0;
  for (const render::TechniqueUse& use : state_.techniques)
    for (size_t i = 0; i < candidates.size(); ++i)
      if (use.plugin == candidates[i]) next = (i + 1) % candidates.size();
  const auto inUse = [&](const render::TechniqueUse& use) { return use.plugin == candidates[next]; };
  if (candidates.empty() || std::ranges::any_of(state_.techniques, inUse)) return;
  const TechniquePlugin& plugin = *candidates[next];
  state_.techniques.insert(state_.techniques.begin(),
                           {&plugin, ParameterValues(plugin.info->name, plugin.info->parameters)});
  dropRivals(state_.techniques, plugin);
  moved();
}

void ViewerWindow::press(int key, bool control) {
  if (key == GLFW_KEY_SPACE) {
    playing_ = !playing_;
    moved();
  }
  if (key == GLFW_KEY_F2) nextTechnique();
  if (key == GLFW_KEY_F3) compareWith(static_cast<Beside>((static_cast<int>(beside_) + 1) % 3));
  if (key == GLFW_KEY_F4) tryOpen(state_.scene);
  if (key == GLFW_KEY_F5) savePending_ = true;
  if (key == GLFW_KEY_F6) saveSuite();
  if (key == GLFW_KEY_F7) copyCommand();
  if (key == GLFW_KEY_PAGE_DOWN && step_ + 1 < options_.steps.size()) chooseStep(step_ + 1);
  if (key == GLFW_KEY_PAGE_UP && step_ > 0) chooseStep(step_ - 1);
  if (key == GLFW_KEY_Q && control) glfwSetWindowShouldClose(context_->window(), GLFW_TRUE);
}

void ViewerWindow::handleKeys() {
  if (!ImGui::GetIO().WantTextInput)
    for (const auto& [key, control] : pressed_) press(key, control);
  pressed_.clear();
}

void ViewerWindow::pictureArea() {
  handleKeys();
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({panelWidth, 0});
  ImGui::SetNextWindowSize({std::max(window.x - panelWidth, 1.f), window.y});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin("picture", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
  ImGui::PopStyleVar();
  const ImVec2 place = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const glm::vec2 corner(place.x, place.y), size(room.x, room.y - statusHeight);
  area_ = glm::max(glm::ivec2(size), glm::ivec2(0));
  if (area_.x > 0 && area_.y > 0) state_.scene.size = fmt::format("{}x{}", area_.x, area_.y);
  if (area_.x > 0 && area_.y > 0) {
    ImGui::InvisibleButton("hands", im(size),
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    handleMouse();
    const gpu::Texture* left = picture_->display();
    const gpu::Texture* right = nullptr;
    bool bottomFirst = true;
    if (beside_ == Beside::techniques && other_) right = other_->display();
    if (beside_ == Beside::reference && truth_ && truthTexture_.id() != 0) {
      right = &truthTexture_;
      bottomFirst = false;
    }
    if (showDifference_ && metrics_ && right != nullptr) {
      right = &differenceTexture_;
      bottomFirst = false;
    }
    const float line = right != nullptr ? split_ : 1;
    if (left != nullptr) drawPicture(*left, corner, size, 0, line, true);
    if (right != nullptr) {
      drawPicture(*right, corner, size, line, 1, bottomFirst);
      const float x = corner.x + line * size.x;
      ImGui::GetWindowDrawList()->AddLine({x, corner.y}, {x, corner.y + size.y}, 0xffffffff);
      if (showDifference_ && metrics_)
        drawColourBar(corner + glm::vec2(8, size.y - 44), std::min(size.x - 16, 420.f));
    }
    const std::string& problem =
        !picture_->problem().empty() || !other_ ? picture_->problem() : other_->problem();
    if (!problem.empty()) {
      ImGui::SetCursorScreenPos(im(corner + glm::vec2(8)));
      ImGui::PushTextWrapPos(size.x - 8);
      ImGui::TextColored({1, 0.5f, 0.4f, 1}, "%s", problem.c_str());
      ImGui::PopTextWrapPos();
    }
  }
  ImGui::SetCursorScreenPos({place.x + 8, place.y + room.y - statusHeight + 6});
  std::string status =
      fmt::format("{} x {}  {:.1f} ms", picture_->size().x, picture_->size().y, picture_->frameMs());
  if (metrics_)
    status += fmt::format("   RMSE {:.4g}  bias {:+.3g}  FLIP {:.3g}", metrics_->rmse, metrics_->bias,
                          metrics_->flip);
  if (!message_.empty()) status += "   " + message_;
  ImGui::TextUnformatted(status.c_str());
  ImGui::End();
}

}  // namespace limn::app
