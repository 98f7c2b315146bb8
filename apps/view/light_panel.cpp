// Lights: which shine, where, how large and how bright.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"
#include "core/question/question_fields.h"

namespace limn::app {
namespace {

constexpr float kMostInSetting = 1e9f;                               // of a number of --set-light
constexpr ImGuiSliderFlags kClamped = ImGuiSliderFlags_AlwaysClamp;  // what is typed, too

bool isMesh(const LightFacts& light) {
  return (light.light.flags & glsl::light_flag_geometry) != 0;
}

const char* kindOf(const LightFacts& light) {
  switch (light.light.type) {
    case glsl::light_point:
      return "point";
    case glsl::light_spot:
      return "spot";
    case glsl::light_directional:
      return (light.light.flags & glsl::light_flag_environment) != 0 ? "environment" : "directional";
    default:
      return isMesh(light) ? "mesh" : "rectangle";
  }
}

/// A number of metres with the digits that show a thousandth of the scene, to which ImGui rounds what is
/// dragged.
std::string lengthFormat(float radius) {
  const int digits = 3 - static_cast<int>(std::floor(std::log10(std::max(radius, 1e-6f))));
  return fmt::format("%.{}f", std::clamp(digits, 3, 9));
}

/// Rows of the editor; true if the edit changed.
bool lightSize(const LightFacts& light, float radius, session::LightEdit& edit) {
  const bool directional = light.light.type == glsl::light_directional;
  nameCell(
      directional ? "angle, rad" : "size, m",
      directional ? "Angular diameter" : "Sides; a light that had none becomes a rectangle that faces -z");
  const float least = directional ? 1e-4f : leastSide(radius);
  glm::vec2 size = edit.size.value_or(*light.now.size);
  const bool resized = directional
                           ? ImGui::DragFloat("##size", &size.x, 0.001f, least, 1, "%.4f", kClamped)
                           : ImGui::DragFloat2("##size", &size.x, 0.002f * radius, least, kMostInSetting,
                                               lengthFormat(radius).c_str(), kClamped);
  if (!resized) return false;
  const bool square = directional || (!edit.size && *light.now.size == glm::vec2(0));
  edit.size =
      glm::max(square ? glm::vec2(std::max(size.x, directional ? 0.f : size.y)) : size, glm::vec2(least));
  return true;
}

bool lightColour(const LightFacts& light, session::LightEdit& edit) {
  const bool directional = light.light.type == glsl::light_directional;
  bool changed = false;
  nameCell("colour", "Linear Rec. 709");
  glm::vec3 colour = edit.colour.value_or(*light.now.colour);
  if (ImGui::ColorEdit3("##colour", &colour.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR)) {
    edit.colour = glm::clamp(colour, 0.f, kMostInSetting);
    changed = true;
  }
  nameCell("intensity", directional
                            ? "Irradiance of a surface that faces the light"
                            : "Radiant intensity; that of a rectangle or mesh does not change with its size");
  float intensity = edit.intensity.value_or(*light.now.intensity);
  if (ImGui::DragFloat("##intensity", &intensity, std::max(0.01f * intensity, 1e-3f), 0, kMostInSetting,
                       directional ? "%.4g W/m2" : "%.4g W/sr", kClamped)) {
    edit.intensity = intensity;
    changed = true;
  }
  return changed;
}

}  // namespace

void ViewerWindow::lightPanel() {
  const std::vector<LightFacts>& lights = facts_->lights;
  if (beginRows("lights")) {
    nameCell("shining", "All lights, or only one; visibility shows one");
    const std::string shown = state_.scene.light.empty() ? "all" : state_.scene.light;
    if (ImGui::BeginCombo("##shining", shown.c_str())) {
      if (ImGui::Selectable("all")) state_.scene.light.clear(), moved();
      for (const LightFacts& light : lights)
        if (ImGui::Selectable(light.name.c_str())) state_.scene.light = light.name, moved();
      ImGui::EndCombo();
    }
    nameCell("all sizes",
             "Side of every area light, metres; angular diameter of directional lights, radians. 0: "
             "as in the scene");
    auto size = static_cast<float>(state_.scene.lightSize);
    if (ImGui::SliderFloat("##size", &size, 0, 10, size > 0 ? "%.3f m" : "as in the scene",
                           ImGuiSliderFlags_Logarithmic)) {
      state_.scene.lightSize = size > 0 ? accepted(questionField("light_size"), size) : 0;
      moved();
    }
    endRows();
  }
  if (lights.empty()) {
    ImGui::TextDisabled(facts_->scene ? "the scene has no light" : "no scene is open");
    return;
  }
  if (std::exchange(lightsNew_, false)) {
    const auto edited = [&](const LightFacts& light) { return lightEdits_.contains(light.name); };
    const auto found = std::ranges::find_if(lights, edited);
    if (found != lights.end()) chooseLight(static_cast<int>(found - lights.begin()));
  }
  const float row = ImGui::GetTextLineHeightWithSpacing();
  const auto rows = static_cast<float>(std::min<size_t>(lights.size(), 6));
  ImGui::BeginChild("list", {0, rows * row + scaled(14)}, true);
  for (int i = 0; i < static_cast<int>(lights.size()); ++i) {
    const LightFacts& light = lights[static_cast<size_t>(i)];
    ImGui::PushID(i);
    const std::string title = light.name + (lightEdits_.contains(light.name) ? " *" : "");
    if (ImGui::Selectable(title.c_str(), i == chosenLight_))
      chooseLight(i == chosenLight_ ? scene::kNone : i);
    tip("Choose it to move, turn and change it; its handles are in the picture. *: changed");
    ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(90));
    ImGui::TextDisabled("%s", kindOf(light));
    ImGui::PopID();
  }
  ImGui::EndChild();
  if (chosenLight_ >= 0 && chosenLight_ < static_cast<int>(lights.size()))
    lightEditor(lights[static_cast<size_t>(chosenLight_)]);
}

void ViewerWindow::lightEditor(const LightFacts& light) {
  if (!light.editable) {
    wrapped(
        "This light is part of the environment or of a mesh that cannot be changed alone (several lights, "
        "textured, instanced or deformed).");
    return;
  }
  const bool directional = light.light.type == glsl::light_directional;
  const float radius = facts_->scene ? facts_->scene->bounds.radius() : 1;
  const auto found = lightEdits_.find(light.name);
  session::LightEdit edit = found == lightEdits_.end() ? session::LightEdit{} : found->second;
  const session::LightEdit& now = light.now;
  bool placed = false;
  if (!beginRows("editor")) return;
  if (!directional) {
    nameCell("handles", "In the picture: drag an axis or a plane to move the light, a ring to turn it");
    if (ImGui::RadioButton("move", gizmoMode_ == GizmoMode::move)) gizmoMode_ = GizmoMode::move;
    ImGui::SameLine();
    if (ImGui::RadioButton("turn", gizmoMode_ == GizmoMode::turn)) gizmoMode_ = GizmoMode::turn;
    nameCell("position, m", "In the world; drag the numbers, or double-click to type");
    glm::dvec3 position = edit.position.value_or(*now.position);
    const double least = -kMostInSetting, most = kMostInSetting;
    if (ImGui::DragScalarN("##position", ImGuiDataType_Double, &position.x, 3, 0.003f * radius, &least, &most,
                           lengthFormat(radius).c_str(), kClamped)) {
      edit.position = position;
      placed = true;
    }
  }
  if (light.light.type != glsl::light_point) {
    nameCell("rotation",
             "Pitch, yaw and roll in degrees of a light that shines along -z: rolled about z, "
             "pitched about x, turned about y");
    glm::vec3 rotation = edit.rotation.value_or(*now.rotation);
    if (ImGui::DragFloat3("##rotation", &rotation.x, 0.5f, -360, 360, "%.1f", kClamped)) {
      edit.rotation = rotation;
      placed = true;
    }
  }
  const bool resized = now.size && lightSize(light, radius, edit);
  const bool coloured = now.colour && lightColour(light, edit);
  endRows();
  placed |= resized && isMesh(light);
  const bool changed = placed || resized || coloured;
  // A light that was moved keeps both, so that the command places it the same whatever animations do.
  if (placed) {
    if (!directional && !edit.position) edit.position = now.position;
    if (light.light.type != glsl::light_point && !edit.rotation) edit.rotation = now.rotation;
  }
  if (changed) editLight(light, edit);
  if (!now.size) wrapped("Several nodes share its mesh, so that it can be moved and turned only.");
  if (found != lightEdits_.end() && !changed && ImGui::Button("As in the scene")) editLight(light, {});
}

}  // namespace limn::app
