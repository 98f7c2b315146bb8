// The inspector: a texture of a pass, any layer, level and channel, with the value under the mouse.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"

namespace limn::app {
namespace {

constexpr const char* kChannels[] = {"R", "G", "B", "A", "RGB"};

const char* targetName(GLenum target) {
  switch (target) {
    case GL_TEXTURE_2D_ARRAY:
      return "2D array";
    case GL_TEXTURE_CUBE_MAP:
      return "cube map";
    case GL_TEXTURE_CUBE_MAP_ARRAY:
      return "cube maps";
    case GL_TEXTURE_3D:
      return "3D";
    default:
      return "2D";
  }
}

const char* layerName(GLenum target, int layer) {
  constexpr const char* faces[] = {"+x", "-x", "+y", "-y", "+z", "-z"};
  const bool cube = target == GL_TEXTURE_CUBE_MAP || target == GL_TEXTURE_CUBE_MAP_ARRAY;
  return cube ? faces[layer % 6] : "";
}

std::string valueText(const render::InspectedValues& values, int x, int y) {
  std::string text;
  const bool integer =
      values.kind == gpu::FormatClass::unsignedInteger || values.kind == gpu::FormatClass::signedInteger;
  for (int c = 0; c < values.components; ++c) {
    const double value = values.at(x, y, c);
    text += fmt::format("{}{}", c > 0 ? "  " : "",
                        integer ? fmt::format("{:.0f}", value) : fmt::format("{:.6g}", value));
  }
  return text;
}

/// `shown`: how the picture there is shows the texture; null: there is none.
void rangeRow(InspectionOrder& wanted, const render::InspectionView* shown) {
  nameCell("range",
           "Values shown black and white; automatic: the least and the greatest there are, when the "
           "picture stands still");
  const bool wasAutomatic = wanted.automatic;
  ImGui::Checkbox("automatic", &wanted.automatic);
  ImGui::SameLine();
  if (wanted.automatic && shown != nullptr) {
    ImGui::TextDisabled("%.5g to %.5g", static_cast<double>(shown->low), static_cast<double>(shown->high));
    return;
  }
  if (wasAutomatic && shown != nullptr) {
    wanted.view.low = shown->low;
    wanted.view.high = shown->high;
  }
  float range[2] = {wanted.view.low, wanted.view.high};
  const float step = std::max(std::abs(range[1] - range[0]) * 0.005f, 1e-6f);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::DragFloat2("##range", range, step, 0, 0, "%.5g")) {
    wanted.view.low = range[0];
    wanted.view.high = range[1];
  }
}

}  // namespace

/// Texture, level, layer, channel and range.
void ViewerWindow::inspectorChoices(const frame::PassReport& pass) {
  InspectionOrder& wanted = *inspection_;
  const InspectionOrder before = wanted;
  const frame::AccessReport& shown = pass.accesses[wanted.texture.access];
  const gpu::TextureDesc desc = gpu::resolved(*shown.texture);
  const gpu::FormatInfo format = gpu::formatInfo(desc.format);
  // A parameter may have given the texture another format, without that channel.
  if (wanted.view.channel < 4 ? wanted.view.channel >= format.components : format.components < 3)
    wanted.view.channel = 0;
  const auto title = [](const frame::AccessReport& access) {
    return fmt::format("{} {}", access.write ? "writes" : "reads", access.resource);
  };
  nameCell("texture", shown.why);
  if (ImGui::BeginCombo("##texture", title(shown).c_str())) {
    for (size_t i = 0; i < pass.accesses.size(); ++i) {
      if (!pass.accesses[i].texture) continue;
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::Selectable(title(pass.accesses[i]).c_str(), i == wanted.texture.access)) inspect(pass, i);
      tip(pass.accesses[i].why);
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  if (desc.levels > 1) {
    nameCell("level", "Of the mip chain; 0 is the full size");
    ImGui::SliderInt("##level", &wanted.view.level, 0, desc.levels - 1, "%d", ImGuiSliderFlags_AlwaysClamp);
  }
  const int layers = facts_->inspected ? std::max(facts_->inspected->layers, 1) : desc.layers;
  if (layers > 1) {
    nameCell("layer", "Array layer, face of a cube map or slice of a 3D texture");
    ImGui::SliderInt("##layer", &wanted.view.layer, 0, layers - 1,
                     fmt::format("%d {}", layerName(desc.target, wanted.view.layer)).c_str(),
                     ImGuiSliderFlags_AlwaysClamp);
  }
  const bool depth = format.kind == gpu::FormatClass::depth || format.kind == gpu::FormatClass::depthStencil;
  if (format.components > 1 && !depth) {
    nameCell("channel", "One as grey, or the first three as colours");
    for (int c = 0; c < 5; ++c) {
      if (c < 4 ? c >= format.components : format.components < 3) continue;
      if (c > 0) ImGui::SameLine();
      if (ImGui::RadioButton(kChannels[c], wanted.view.channel == c)) wanted.view.channel = c;
    }
  }
  rangeRow(wanted, facts_->inspected ? &facts_->inspected->view : nullptr);
  if (!(wanted == before)) moved();
}

void ViewerWindow::inspectedPicture(const InspectedFacts& facts) {
  if (!facts.problem.empty() || !facts.image) {
    complaint(facts.problem);
    return;
  }
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const glm::vec2 size(facts.size), place(room.x, room.y - ImGui::GetTextLineHeightWithSpacing());
  const float scale = std::max(std::min(place.x / size.x, place.y / size.y), 1e-3f);
  const glm::vec2 whole(facts.desc.width, facts.desc.height);
  const glm::vec2 part = size / whole;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Image(textureId(textures_->of(facts.image, GL_NEAREST)), {scale * size.x, scale * size.y},
               {0, 1 - part.y}, {part.x, 1}, {1, 1, 1, 1}, {1, 1, 1, 0.2f});
  const bool hovered = ImGui::IsItemHovered();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  std::string text = facts.values ? "" : "values are read when the picture stands still";
  if (facts.values && hovered) {
    const int x = std::clamp(static_cast<int>((mouse.x - corner.x) / scale), 0, facts.size.x - 1);
    const int y =
        facts.size.y - 1 - std::clamp(static_cast<int>((mouse.y - corner.y) / scale), 0, facts.size.y - 1);
    text = fmt::format("({}, {})  {}", x, y, valueText(*facts.values, x, y));
  } else if (facts.values) {
    const int channel = facts.view.channel < 4 ? facts.view.channel : 0;
    const render::InspectedValues::Range range = facts.values->range(channel);
    text = fmt::format("{}{:.5g} to {:.5g}, mean {:.5g}{}",
                       facts.values->components > 1 ? kChannels[channel] + std::string(": ") : "", range.low,
                       range.high, range.mean,
                       range.notFinite > 0 ? fmt::format("; {} not finite (magenta)", range.notFinite) : "");
  }
  ImGui::TextUnformatted(text.c_str());
}

void ViewerWindow::inspectorWindow() {
  if (!facts_->frame || !inspection_) return;
  const auto& passes = facts_->frame->passes;
  const auto pass = std::ranges::find_if(passes, [&](const frame::PassReport& p) {
    return p.technique == inspection_->texture.technique && p.name == inspection_->texture.pass;
  });
  const float width = std::min(scaled(460), static_cast<float>(area_.x) - 20);
  ImGui::SetNextWindowPos({corner_.x + static_cast<float>(area_.x) - width - 10, corner_.y + scaled(34)},
                          ImGuiCond_Appearing);
  ImGui::SetNextWindowSize({width, std::max(static_cast<float>(area_.y) - 60, 80.f)}, ImGuiCond_Appearing);
  ImGui::SetNextWindowBgAlpha(0.96f);
  bool open = true;
  const std::string title =
      fmt::format("{}: {}###inspector", inspection_->texture.technique, inspection_->texture.pass);
  ImGui::Begin(title.c_str(), &open, ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse);
  const bool known = pass != passes.end() && inspection_->texture.access < pass->accesses.size() &&
                     pass->accesses[inspection_->texture.access].texture;
  if (known) {
    const gpu::TextureDesc desc = gpu::resolved(*pass->accesses[inspection_->texture.access].texture);
    ImGui::TextDisabled("%s", fmt::format("{}, {}, {} x {}{}{}, {:.2f} MiB", targetName(desc.target),
                                          gpu::formatInfo(desc.format).name, desc.width, desc.height,
                                          desc.layers > 1 ? fmt::format(" x {}", desc.layers) : "",
                                          desc.levels > 1 ? fmt::format(", {} levels", desc.levels) : "",
                                          static_cast<double>(gpu::textureBytes(desc)) / (1 << 20))
                                  .c_str());
    if (beginRows("choices")) {
      inspectorChoices(*pass);
      endRows();
    }
    if (facts_->inspected) inspectedPicture(*facts_->inspected);
  } else {
    wrapped("The frame has no such pass now.");
  }
  ImGui::End();
  if (!open) inspection_.reset();
}

}  // namespace limn::app
