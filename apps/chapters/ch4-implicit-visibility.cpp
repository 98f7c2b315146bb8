// Chapter 4: global illumination using implicit visibility.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"ch4_figures", "ch4"};
  constexpr ChapterSetting settings[] = {
      {"6 x 16 x 16 bins", "implicit_visibility", ""},
      {"6 x 12 x 12 bins", "implicit_visibility", "implicit_visibility.bins=12"},
      {"6 x 8 x 8 bins", "implicit_visibility", "implicit_visibility.bins=8"},
      {"Two bounces", "implicit_visibility", "implicit_visibility.bounces=2"},
      {"Every pair of elements", "implicit_visibility", "implicit_visibility.structure=flat"},
      {"As published", "implicit_visibility",
       "implicit_visibility.fill=centre implicit_visibility.opening=1"},
      {"Per pixel", "implicit_visibility", "implicit_visibility.display=pixel"},
  };
  return limn::app::runChapter({.name = "ch4-implicit-visibility",
                                .title = "Global illumination using implicit visibility",
                                .scene = "monster",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
