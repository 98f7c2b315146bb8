// Lights in the picture: marks to choose one by, and the chosen one's handles.
#include <imgui.h>

#include <algorithm>

#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"

namespace limn::app {
namespace {

constexpr float kMarkPixels = 7;                                         // before scaled(), as all pixels
constexpr ImU32 kAxisColours[3] = {0xff5a5af0, 0xff5ad05a, 0xfff0965a};  // red, green, blue
constexpr ImU32 kHeldColour = 0xff40e0ff, kMarkColour = 0xff80e8ff;

bool isDirectional(const LightFacts& light) {
  return light.light.type == glsl::light_directional;
}

/// Where a light's handles are: directional ones have no place, theirs is the scene's middle.
glm::vec3 placeOf(const LightFacts& light, const SceneFacts& scene) {
  return isDirectional(light) ? scene.bounds.centre() : light.light.position;
}

void drawOutline(const ScreenCamera& screen, const glm::vec3& centre, const GizmoHandle& handle, bool held) {
  std::vector<ImVec2> pixels;
  for (const glm::vec3& corner : outlineOf(screen, centre, handle)) {
    const auto pixel = screen.pixel(corner);
    if (!pixel) return;
    pixels.push_back(im(*pixel));
  }
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImU32 colour = held ? kHeldColour : kAxisColours[handle.axis];
  const int count = static_cast<int>(pixels.size());
  if (handle.kind == GizmoHandle::Kind::plane) {
    draw.AddConvexPolyFilled(pixels.data(), count, (colour & 0x00ffffff) | 0x60000000);
    draw.AddPolyline(pixels.data(), count, colour, ImDrawFlags_Closed, screen.handleScale);
  } else if (handle.kind == GizmoHandle::Kind::ring) {
    draw.AddPolyline(pixels.data(), count, colour, ImDrawFlags_Closed, 2.5f * screen.handleScale);
  } else {
    draw.AddLine(pixels[0], pixels[1], colour, 2.5f * screen.handleScale);
    draw.AddCircleFilled(pixels[1], 4.5f * screen.handleScale, colour);
  }
}

/// The rectangle that a light is, and which way it shines.
void drawShape(const ScreenCamera& screen, const LightFacts& light, const glm::vec3& centre) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto line = [&](const glm::vec3& a, const glm::vec3& b) {
    const auto from = screen.pixel(a), to = screen.pixel(b);
    if (from && to) draw.AddLine(im(*from), im(*to), kMarkColour, 1.5f * screen.handleScale);
  };
  const glsl::Light& l = light.light;
  if (l.type == glsl::light_rectangle) {
    const glm::vec3 u = 0.5f * l.length_u * l.axis_u, v = 0.5f * l.length_v * l.axis_v;
    const glm::vec3 corners[4] = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
    for (int i = 0; i < 4; ++i) line(corners[i], corners[(i + 1) % 4]);
  }
  if (l.type != glsl::light_point)
    line(centre, centre + screen.metres(45 * screen.handleScale, centre) * l.direction);
}

}  // namespace

ScreenCamera ViewerWindow::screen() const {
  return {facts_->camera, corner_, glm::vec2(area_), scaled(100) / 100};
}

void ViewerWindow::chooseLight(int light) {
  chosenLight_ = light;
  chosenName_ = light < 0 ? std::string() : facts_->lights[static_cast<size_t>(light)].name;
  drag_.reset();
}

/// Finds the chosen light in the newest facts: those behind a mesh that an animation has skewed, which is no
/// rectangle then, have other numbers there.
void ViewerWindow::findChosenLight() {
  const auto found = std::ranges::find(facts_->lights, chosenName_, &LightFacts::name);
  const bool gone = chosenName_.empty() || found == facts_->lights.end();
  chosenLight_ = gone ? scene::kNone : static_cast<int>(found - facts_->lights.begin());
  if (!gone || !drag_) return;
  drag_.reset();
  markHeld_ = true;  // until it is let go, the hand turns no camera
}

void ViewerWindow::editLight(const LightFacts& light, const session::LightEdit& edit) {
  lightEdits_[light.name] = edit;
  if (edit == session::LightEdit{}) lightEdits_.erase(light.name);
  state_.scene.lightSettings = session::printed(lightEdits_);
  moved();
}

void ViewerWindow::drawLights() {
  if (!facts_->scene || !facts_->picture.image) return;
  const ScreenCamera camera = screen();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(im(corner_), im(corner_ + glm::vec2(area_)), true);
  for (int i = 0; i < static_cast<int>(facts_->lights.size()); ++i) {
    const LightFacts& light = facts_->lights[static_cast<size_t>(i)];
    const bool chosen = i == chosenLight_;
    if (!light.editable || (isDirectional(light) && !chosen)) continue;
    const glm::vec3 centre = placeOf(light, *facts_->scene);
    const auto pixel = camera.pixel(centre);
    if (!pixel) continue;
    draw.AddCircle(im(*pixel), scaled(kMarkPixels), kMarkColour, 0,
                   (chosen ? 3.f : 1.5f) * camera.handleScale);
    if (!chosen) continue;
    drawShape(camera, light, centre);
    const GizmoMode mode = isDirectional(light) ? GizmoMode::turn : gizmoMode_;
    for (const GizmoHandle& handle : handlesOf(mode))
      drawOutline(camera, centre, handle, drag_ && drag_->handle == handle);
  }
  draw.PopClipRect();
}

bool ViewerWindow::dragLight() {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 mouse(io.MousePos.x, io.MousePos.y);
  const auto count = static_cast<int>(facts_->lights.size());
  markHeld_ = markHeld_ && io.MouseDown[0];
  if (markHeld_) return true;  // a hand that shakes turns no camera
  if (!lightPanelOpen_ || !facts_->scene || chosenLight_ >= count) return false;
  const ScreenCamera camera = screen();
  if (drag_) {
    const LightFacts& light = facts_->lights[static_cast<size_t>(chosenLight_)];
    const GizmoPose pose = dragged(camera, *drag_, mouse);
    const auto found = lightEdits_.find(light.name);
    session::LightEdit now = light.now;
    if (light.light.type == glsl::light_point) now.rotation.reset();  // it shines the same in all directions
    if (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)
      editLight(light, placedBy(drag_->handle, pose, now,
                                found == lightEdits_.end() ? session::LightEdit{} : found->second,
                                facts_->scene->origin, facts_->scene->bounds.radius()));
    if (!io.MouseDown[0]) drag_.reset();  // the last movement may come with the release
    return true;
  }
  if (!ImGui::IsItemHovered() || !ImGui::IsMouseClicked(0)) return false;
  if (chosenLight_ >= 0) {
    const LightFacts& light = facts_->lights[static_cast<size_t>(chosenLight_)];
    const GizmoMode mode = isDirectional(light) ? GizmoMode::turn : gizmoMode_;
    const glm::vec3 centre = placeOf(light, *facts_->scene);
    if (const auto handle = light.editable ? handleAt(camera, centre, mode, mouse) : std::nullopt) {
      drag_ =
          GizmoDrag{*handle, {centre, session::rotationOf(light.now.rotation.value_or(glm::vec3(0)))}, mouse};
      return true;
    }
  }
  for (int i = 0; i < count; ++i) {
    const LightFacts& light = facts_->lights[static_cast<size_t>(i)];
    const auto pixel = camera.pixel(light.light.position);
    if (!light.editable || isDirectional(light) || !pixel ||
        glm::distance(*pixel, mouse) > scaled(kMarkPixels))
      continue;
    chooseLight(i);
    markHeld_ = true;
    return true;
  }
  return false;
}

}  // namespace limn::app
