// The widgets of parameters, drawn without a window.
#include "apps/view/parameter_widgets.h"

#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <algorithm>
#include <string>

#include "apps/view/viewer_style.h"

namespace limn::app {
namespace {

/// What a parameter does takes up to 300 letters, which no monitor has room for in one line.
TEST(ParameterWidgets, TooltipsHaveLinesThatFitIntoTheWindow) {
  std::string doc;
  for (int word = 0; word < 30; ++word) doc += "milkwhite ";
  const Parameter parameters[] = {real("sigma", 1, {0.1, 16}, "texels", doc.c_str())};
  const ParameterValues defaults("blur", parameters);
  ParameterValues values = defaults;
  ImGui::CreateContext();
  setStyle(1);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = {1000, 760};
  io.MousePos = {20, 20};  // on the name
  ASSERT_TRUE(io.Fonts->Build());
  for (int frame = 0; frame < 4; ++frame) {
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({400, 300});
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
    EXPECT_FALSE(parameterWidgets(values, defaults));
    ImGui::End();
    ImGui::Render();
  }
  float widest = 0;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (std::string(window->Name).starts_with("##Tooltip")) widest = std::max(widest, window->Size.x);
  EXPECT_GT(widest, 100) << "it is shown";
  EXPECT_LT(widest, 600);
  ImGui::DestroyContext();
}

}  // namespace
}  // namespace limn::app
