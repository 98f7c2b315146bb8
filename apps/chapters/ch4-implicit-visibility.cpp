// Chapter 4: global illumination using implicit visibility.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"ch4_figures", "ch4"};
  constexpr ChapterSetting settings[] = {
      {"6 x 16 x 16 bins", "implicit_visibility", "implicit_visibility.outlines=vertex",
       "Shadows and one bounce from the links alone: nobody asks for visibility."},
      {"6 x 12 x 12 bins", "implicit_visibility",
       "implicit_visibility.outlines=vertex implicit_visibility.bins=12",
       "The published compromise between speed and shadows."},
      {"6 x 8 x 8 bins", "implicit_visibility",
       "implicit_visibility.outlines=vertex implicit_visibility.bins=8",
       "Bins of eleven degrees: watch the shadow lose its shape."},
      {"Outlines per pixel", "implicit_visibility", "",
       "The default of limn: pixels test the triangles that may hide the light, and bounces stay as they "
       "were."},
      {"Two bounces", "implicit_visibility", "implicit_visibility.bounces=2",
       "The floor's colours twice reflected."},
      {"Every pair of elements", "implicit_visibility", "implicit_visibility.structure=flat",
       "The same picture without the hierarchy, for more time the more elements there are."},
      {"Links made on the GPU", "implicit_visibility", "implicit_visibility.links=gpu",
       "Each surface element goes down the hierarchy by itself; elsewhere the CPU does, for several "
       "together."},
      {"As published", "implicit_visibility",
       "implicit_visibility.outlines=vertex implicit_visibility.fill=centre implicit_visibility.opening=1",
       "An element fills the bin of its centre: holes let light through."},
      {"Per pixel", "implicit_visibility", "implicit_visibility.display=pixel",
       "The BRDF of every pixel over the bins around it."},
      {"Glossy interreflection", "implicit_visibility",
       "implicit_visibility.display=pixel implicit_visibility.glossy_bins=6",
       "Elements send light into bins of directions; look at --scene glossy_sphere."},
  };
  return limn::app::runChapter({.name = "ch4-implicit-visibility",
                                .title = "Global illumination using implicit visibility",
                                .scene = "monster",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
