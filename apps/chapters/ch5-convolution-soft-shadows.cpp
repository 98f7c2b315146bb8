// Chapter 5: convolution soft shadow maps.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"ch5_figures", "ch5"};
  constexpr ChapterSetting settings[] = {
      {"CSSM, M = 4, summed-area table", "cssm", "cssm.filter=sat"},
      {"CSSM, M = 4, mip maps", "cssm", "cssm.filter=mip"},
      {"CSSM, M = 16", "cssm", "cssm.order=16"},
      {"PCSS, 32 + 64 samples", "pcss", ""},
      {"Bitmask soft shadows", "bitmask_soft_shadows", ""},
      {"Back-projection", "backprojection", ""},
      {"16 shadow maps on the light", "sampled_area_light", "sampled_area_light.samples=16"},
  };
  return limn::app::runChapter({.name = "ch5-convolution-soft-shadows",
                                .title = "Convolution soft shadow maps",
                                .scene = "statue",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
