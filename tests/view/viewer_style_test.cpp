// The font of the viewer.
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

}  // namespace
}  // namespace limn::app
