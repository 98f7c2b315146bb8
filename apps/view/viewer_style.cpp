#include "apps/view/viewer_style.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace limn::app {

namespace {

float scale = 1;  // of everything; there is one window

/// What file names are written in beyond Latin-1: Latin with its accents, Greek, Cyrillic, punctuation.
constexpr ImWchar kFurtherLetters[] = {0x100,  0x24f,  0x300,  0x36f,  0x370, 0x52f,
                                       0x1e00, 0x1eff, 0x2010, 0x2027, 0};

/// The font of Debian's fonts-dejavu-core, sharp at any scale; ImGui's own of 13 pixels where there is none.
void setFont() {
  constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  constexpr float kPixels = 13;
  ImFontConfig font;
  font.SizePixels = scaled(kPixels);
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  if (!std::ifstream(kFont)) {  // ImGui ends the program where it cannot be read
    fonts.AddFontDefault(&font);
    return;
  }
  fonts.AddFontFromFileTTF(kFont, font.SizePixels, &font);
  // Five times as many letters, which are rare: without several samples to a pixel they take a third.
  font.MergeMode = true;
  font.OversampleH = 1;
  fonts.AddFontFromFileTTF(kFont, font.SizePixels, &font, kFurtherLetters);
}

void wrappedIn(const ImVec4& colour, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  wrapped(text);
  ImGui::PopStyleColor();
}

}  // namespace

float scaled(float pixels) {
  return std::round(scale * pixels);
}

void setStyle(float wanted) {
  scale = wanted;
  setFont();
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowPadding = {10, 8};
  style.FramePadding = {6, 3};
  style.ItemSpacing = {6, 5};
  style.CellPadding = {4, 2};
  style.IndentSpacing = 12;
  style.ScrollbarSize = 11;
  style.FrameRounding = style.GrabRounding = style.PopupRounding = style.ScrollbarRounding = 3;
  style.WindowBorderSize = 0;
  style.GrabMinSize = 8;
  const ImVec4 quiet(0.20f, 0.23f, 0.27f, 1), livelier(0.26f, 0.33f, 0.42f, 1),
      active(0.29f, 0.47f, 0.68f, 1);
  for (const auto& [colour, value] : {std::pair{ImGuiCol_WindowBg, ImVec4(0.11f, 0.12f, 0.13f, 1)},
                                      {ImGuiCol_FrameBg, quiet},
                                      {ImGuiCol_FrameBgHovered, livelier},
                                      {ImGuiCol_FrameBgActive, livelier},
                                      {ImGuiCol_Button, quiet},
                                      {ImGuiCol_ButtonHovered, livelier},
                                      {ImGuiCol_ButtonActive, active},
                                      {ImGuiCol_Header, quiet},
                                      {ImGuiCol_HeaderHovered, livelier},
                                      {ImGuiCol_HeaderActive, active},
                                      {ImGuiCol_SliderGrab, ImVec4(0.23f, 0.38f, 0.56f, 1)},
                                      {ImGuiCol_PlotHistogram, active},
                                      {ImGuiCol_SliderGrabActive, active},
                                      {ImGuiCol_TitleBgActive, ImVec4(0.16f, 0.20f, 0.26f, 1)},
                                      {ImGuiCol_PopupBg, ImVec4(0.13f, 0.14f, 0.16f, 1)}})
    style.Colors[colour] = value;
  style.ScaleAllSizes(scale);
}

void wrapped(const std::string& text) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
}

void remark(const std::string& text) {
  wrappedIn(ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled), text);
}

void complaint(const std::string& text) {
  wrappedIn(kProblemColour, text);
}

void tip(const std::string& text) {
  if (text.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(30 * ImGui::GetFontSize());
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool beginRows(const char* name) {
  if (!ImGui::BeginTable(name, 2, ImGuiTableFlags_SizingStretchProp)) return false;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, scaled(90));
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
  return true;
}

void endRows() {
  ImGui::EndTable();
}

int tableColumns(float room, float column) {
  constexpr float kMost = 64;  // ImGui ends the program at a table with more
  return static_cast<int>(std::clamp(room / column, 1.f, kMost));
}

void nameCell(const char* name, const std::string& explanation) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(name);
  tip(explanation);
  ImGui::TableNextColumn();
  ImGui::SetNextItemWidth(-1);
}

void* textureId(const gpu::Texture& texture) {
  return reinterpret_cast<void*>(static_cast<intptr_t>(texture.id()));
}

}  // namespace limn::app
