// The widgets of parameters, drawn without a window.
#include "apps/view/parameter_widgets.h"

#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <algorithm>
#include <limits>
#include <string>

#include "apps/view/viewer_style.h"

namespace limn::app {
namespace {

class ParameterWidgets : public ::testing::Test {
 protected:
  ParameterWidgets() {
    ImGui::CreateContext();
    setStyle(1);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {1000, 760};
  }
  ~ParameterWidgets() override { ImGui::DestroyContext(); }
  void SetUp() override { ASSERT_TRUE(ImGui::GetIO().Fonts->Build()); }

  /// Draws the widgets in two frames with the mouse there, since the first one still has it where it was;
  /// returns whether anything has changed.
  static bool draw(ParameterValues& values, const ParameterValues& defaults, ImVec2 mouse,
                   bool down = false) {
    ImGui::GetIO().MousePos = mouse;
    ImGui::GetIO().MouseDown[0] = down;
    bool changed = false;
    for (int frame = 0; frame < 2; ++frame) {
      ImGui::NewFrame();
      ImGui::SetNextWindowPos({0, 0});
      ImGui::SetNextWindowSize({400, 300});
      ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
      changed |= parameterWidgets(values, defaults);
      ImGui::End();
      ImGui::Render();
    }
    return changed;
  }
};

const ImVec2 kOnTheName(20, 20), kOnTheSlider(300, 20), kNowhere(900, 700);  // of the first parameter

/// What a parameter does takes up to 300 letters, which no monitor has room for in one line.
TEST_F(ParameterWidgets, TooltipsHaveLinesThatFitIntoTheWindow) {
  std::string doc;
  for (int word = 0; word < 30; ++word) doc += "milkwhite ";
  const Parameter parameters[] = {real("sigma", 1, {0.1, 16}, "texels", doc.c_str())};
  const ParameterValues defaults("blur", parameters);
  ParameterValues values = defaults;
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(draw(values, defaults, kOnTheName));
  float widest = 0;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (std::string(window->Name).starts_with("##Tooltip")) widest = std::max(widest, window->Size.x);
  EXPECT_GT(widest, 100) << "it is shown";
  EXPECT_LT(widest, 600);
}

/// Sliders round to the four digits that they show, here beyond both ends, which would be refused.
TEST_F(ParameterWidgets, EndsOfSlidersAreValuesThatAreAccepted) {
  const Parameter parameters[] = {real("angle", 1, {0.12344, 3.14159265358979}, "radians", "An angle")};
  const ParameterValues defaults("turn", parameters);
  ParameterValues values = defaults;
  const auto dragTo = [&](float x) {
    draw(values, defaults, kOnTheSlider);
    EXPECT_TRUE(draw(values, defaults, kOnTheSlider, true));
    draw(values, defaults, {x, kOnTheSlider.y}, true);
    draw(values, defaults, {x, kOnTheSlider.y});
    return values.printed().front().second;
  };
  EXPECT_EQ(dragTo(900), "3.14159265358979");
  EXPECT_EQ(dragTo(0), "0.12344");
}

/// ImGui ends the program at a slider over more than half of the numbers.
TEST_F(ParameterWidgets, AnyRangeThatModulesMayDeclareIsShown) {
  constexpr double most = std::numeric_limits<int>::max();
  const Parameter parameters[] = {integer("seed", 1, {-most - 1, most}, "", "Of random numbers"),
                                  real("scale", 1, {-1e300, 1e300}, "", "A factor")};
  const ParameterValues defaults("noise", parameters);
  ParameterValues values = defaults;
  EXPECT_FALSE(draw(values, defaults, kNowhere));
  EXPECT_EQ(values.printed(), defaults.printed());
}

/// ImGui takes what follows a sign for per cent as a format.
TEST_F(ParameterWidgets, UnitsAreShownAsTheyAre) {
  const Parameter parameters[] = {real("share", 5, {0, 100}, "%", "Of the pixels"),
                                  integer("rays", 7, {0, 100}, "% of all", "That are followed")};
  const ParameterValues defaults("some", parameters);
  ParameterValues values = defaults;
  draw(values, defaults, kNowhere);
  ImGui::NewFrame();
  ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
  ImGui::LogToBuffer();
  parameterWidgets(values, defaults);
  const std::string shown = ImGui::GetCurrentContext()->LogBuffer.c_str();
  ImGui::LogFinish();
  ImGui::End();
  ImGui::Render();
  EXPECT_NE(shown.find("5 %"), std::string::npos) << shown;
  EXPECT_NE(shown.find("7 % of all"), std::string::npos) << shown;
}

}  // namespace
}  // namespace limn::app
