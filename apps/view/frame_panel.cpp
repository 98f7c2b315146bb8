// The frame graph: every pass with its time, its memory, its textures, or why it was left out.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/view/viewer_style.h"
#include "apps/view/viewer_window.h"

namespace limn::app {
namespace {

std::string bytesText(int64_t bytes) {
  const auto kib = static_cast<double>(bytes) / 1024;
  return kib < 1024 ? fmt::format("{:.0f} KiB", kib) : fmt::format("{:.1f} MiB", kib / 1024);
}

std::string describe(const frame::PassReport& pass) {
  std::string text = pass.reason;
  const auto line = [&](const std::string& more) { text += (text.empty() ? "" : "\n") + more; };
  if (pass.bytes > 0) line(bytesText(pass.bytes) + " of its own");
  if (pass.triangles > 0) line(fmt::format("{} triangles drawn", pass.triangles));
  for (const frame::AccessReport& access : pass.accesses)
    line((access.write ? "writes " : "reads ") + access.text());
  return text;
}

/// The first texture that a pass writes, or else reads.
std::optional<size_t> firstTexture(const frame::PassReport& pass) {
  std::optional<size_t> found;
  for (size_t i = pass.accesses.size(); i-- > 0;) {
    const frame::AccessReport& access = pass.accesses[i];
    const bool better = !found || access.write || !pass.accesses[*found].write;
    if (access.texture && better) found = i;
  }
  return found;
}

bool isInspector(const frame::PassReport& pass) {
  return pass.technique == render::TextureInspector::passOwner;
}

}  // namespace

void ViewerWindow::inspect(const frame::PassReport& pass, size_t access) {
  InspectionOrder wanted;
  wanted.texture = {pass.technique, pass.name, access};
  const gpu::TextureDesc& desc = *pass.accesses[access].texture;
  const gpu::FormatInfo format = gpu::formatInfo(desc.format);
  wanted.view.channel = format.kind == gpu::FormatClass::colour && format.components >= 3 ? 4 : 0;
  inspection_ = wanted;
  moved();
}

/// Goes through the textures that the frame's passes write.
void ViewerWindow::inspectNext() {
  if (!facts_->frame) return;
  std::vector<std::pair<const frame::PassReport*, size_t>> textures;
  size_t next = 0;
  for (const frame::PassReport& pass : facts_->frame->passes) {
    if (pass.state == frame::PassState::leftOut || isInspector(pass)) continue;
    for (size_t i = 0; i < pass.accesses.size(); ++i) {
      if (!pass.accesses[i].write || !pass.accesses[i].texture) continue;
      textures.emplace_back(&pass, i);
      if (inspection_ && inspection_->texture == render::Inspection{pass.technique, pass.name, i})
        next = textures.size();
    }
  }
  if (textures.empty()) return;
  const auto& [pass, access] = textures[next % textures.size()];
  inspect(*pass, access);
}

void ViewerWindow::passRow(const frame::PassReport& pass, const frame::PassTime* time, double longest) {
  const bool ran = pass.state == frame::PassState::run && time != nullptr;
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const float part = ran && longest > 0 ? static_cast<float>(time->milliseconds / longest) : 0;
  const std::string text = ran ? fmt::format("{:.2f} ms", time->milliseconds)
                           : pass.state == frame::PassState::cached  ? "kept"
                           : pass.state == frame::PassState::leftOut ? "left out"
                                                                     : "";
  const ImVec2 place = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(place, {place.x + width, place.y + height}, 0x30ffffff, 2);
  if (part > 0) draw.AddRectFilled(place, {place.x + part * width, place.y + height}, 0xffb07840, 2);
  ImGui::SetCursorScreenPos({place.x + 4, place.y});
  ran ? ImGui::TextUnformatted(text.c_str()) : ImGui::TextDisabled("%s", text.c_str());
  ImGui::TableNextColumn();
  const std::optional<size_t> texture = firstTexture(pass);
  const bool chosen = inspection_ && inspection_->texture.technique == pass.technique &&
                      inspection_->texture.pass == pass.name;
  ImGui::BeginDisabled(pass.state == frame::PassState::leftOut || !texture || isInspector(pass));
  const std::string title = pass.technique == "core" ? pass.name : pass.technique + ": " + pass.name;
  ImGui::PushID(title.c_str());
  if (ImGui::Selectable(title.c_str(), chosen) && texture) inspect(pass, *texture);
  ImGui::PopID();
  ImGui::EndDisabled();
  tip(describe(pass));
}

void ViewerWindow::framePanel() {
  if (!facts_->frame) {
    ImGui::TextDisabled("measured with the next picture");
    return;
  }
  const FrameFacts& frame = *facts_->frame;
  double longest = 0, sum = 0;
  for (const frame::PassTime& t : frame.times) {
    longest = std::max(longest, t.milliseconds);
    sum += t.milliseconds;
  }
  ImGui::TextUnformatted(
      fmt::format("{} passes, {:.2f} ms; {}", frame.times.size(), sum, bytesText(frame.memoryBytes)).c_str());
  tip("Passes that ran in the last frame. Click one to look at its textures");
  if (!ImGui::BeginTable("passes", 2)) return;
  ImGui::TableSetupColumn("time", ImGuiTableColumnFlags_WidthFixed, scaled(84));
  ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch);
  for (const frame::PassReport& pass : frame.passes) {
    const auto time = std::ranges::find_if(frame.times, [&](const frame::PassTime& t) {
      return t.name == pass.name && t.technique == pass.technique;
    });
    passRow(pass, time == frame.times.end() ? nullptr : &*time, longest);
  }
  ImGui::EndTable();
}

}  // namespace limn::app
