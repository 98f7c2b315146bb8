// The font of the viewer, and how wide its tables are.
#include "apps/view/viewer_style.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace limn::app {
namespace {

/// File names are shown in more than Latin-1, from a texture that is still small.
TEST(ViewerStyle, TheFontHasTheLettersOfFileNames) {
  if (!std::filesystem::exists("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"))
    GTEST_SKIP() << "needs fonts-dejavu-core";
  ImGui::CreateContext();
  setStyle(1);
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  ASSERT_TRUE(fonts.Build());
  for (const ImWchar letter :
       {u'A', u'\u00e9', u'\u0142', u'\u0301', u'\u03bb', u'\u0436', u'\u1ec7', u'\u2013'})
    EXPECT_NE(fonts.Fonts[0]->FindGlyphNoFallback(letter), nullptr) << std::hex << letter;
  EXPECT_LE(fonts.TexWidth * fonts.TexHeight, 512 * 512);
  ImGui::DestroyContext();
}

/// In a window across several monitors, with small text, there is room for more than ImGui has.
TEST(ViewerStyle, TablesHaveAsManyColumnsAsThereMayBe) {
  EXPECT_EQ(tableColumns(50, 200), 1);
  EXPECT_EQ(tableColumns(-8, 200), 1);
  EXPECT_EQ(tableColumns(599, 200), 2);
  EXPECT_EQ(tableColumns(15360, 100), 64);
}

}  // namespace
}  // namespace limn::app
