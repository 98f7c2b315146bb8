// Chapter 7: variance soft shadow maps.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"ch7_figures", "ch7"};
  constexpr ChapterSetting settings[] = {
      {"VSSM", "vssm", "",
       "Blocker depth and visibility from two moments; kernels are cut into equal parts, and the light into "
       "2 x 2 parts with a map each."},
      {"VSSM, one map", "vssm", "vssm.views=1",
       "The light as a whole, as published: quicker, but what its centre does not see hides nothing of it."},
      {"VSSM, adaptive subdivision", "vssm", "vssm.subdivision=adaptive",
       "A quad-tree cuts only where the moments cannot answer."},
      {"PCSS, 32 + 64 samples", "pcss", "", "The same estimate by sampling: noise in wide penumbrae."},
      {"VSM from a summed-area table", "savsm", "", "Without subdivision non-planar kernels are lit."},
      {"Back-projection", "backprojection", "", "Each texel of the map hides a part of the light."},
      {"16 shadow maps on the light", "sampled_area_light", "sampled_area_light.samples=16",
       "Sixteen hard shadows of 512 texels: raise the number to approach the truth."},
  };
  return limn::app::runChapter({.name = "ch7-variance-soft-shadows",
                                .title = "Variance soft shadow maps",
                                .scene = "plant",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
