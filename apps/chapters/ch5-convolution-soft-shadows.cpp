// Chapter 5: convolution soft shadow maps.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"ch5_figures", "ch5"};
  constexpr ChapterSetting settings[] = {
      {"CSSM, M = 4, summed-area table", "cssm", "cssm.filter=sat",
       "Four terms of the Fourier series, kernels of any size from summed-area tables."},
      {"CSSM, M = 4, mip maps", "cssm", "cssm.filter=mip",
       "The same terms from mip maps: less memory, squarer penumbrae."},
      {"CSSM, M = 16", "cssm", "cssm.order=16",
       "More terms: sharper contact, less light through thin things."},
      {"PCSS, 32 + 64 samples", "pcss", "", "The same estimate by sampling: noise in wide penumbrae."},
      {"Bitmask soft shadows", "bitmask_soft_shadows", "", "Occluders that overlap are counted once."},
      {"Back-projection", "backprojection", "",
       "Each texel of the map hides a part of the light; overlaps count twice."},
      {"16 shadow maps on the light", "sampled_area_light", "sampled_area_light.samples=16",
       "Sixteen hard shadows of 512 texels: raise the number to approach the truth."},
  };
  return limn::app::runChapter({.name = "ch5-convolution-soft-shadows",
                                .title = "Convolution soft shadow maps",
                                .scene = "statue",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
