// Chapter 7: variance soft shadow maps.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"ch7_figures", "ch7"};
  constexpr ChapterSetting settings[] = {
      {"VSSM", "vssm", ""},
      {"VSSM, uniform subdivision", "vssm", "vssm.subdivision=uniform"},
      {"VSSM, adaptive subdivision", "vssm", "vssm.subdivision=adaptive"},
      {"PCSS, 32 + 64 samples", "pcss", ""},
      {"VSM from a summed-area table", "savsm", ""},
      {"Back-projection", "backprojection", ""},
      {"16 shadow maps on the light", "sampled_area_light", "sampled_area_light.samples=16"},
  };
  return limn::app::runChapter({.name = "ch7-variance-soft-shadows",
                                .title = "Variance soft shadow maps",
                                .scene = "plant",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
