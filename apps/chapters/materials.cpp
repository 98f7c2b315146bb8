// Materials: reflection models beyond metallic-roughness.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"materials"};
  constexpr ChapterSetting settings[] = {
      {"Exact models", "hard_shadow_map", "",
       "Torrance and Sparrow's model of copper and aluminium; look at --scene disk_and_sphere, "
       "fresnel_spheres "
       "and glossy_torus, too."},
      {"Without shadows", "", "", "What the lights reflect where nothing hides them."},
      {"Soft shadows", "pcss", "", "The rectangle casts soft shadows; highlights stay as they were."},
      {"16 shadow maps on the light", "sampled_area_light", "sampled_area_light.samples=16",
       "The same from sixteen points on the rectangle."},
  };
  return limn::app::runChapter({.name = "materials",
                                .title = "Reflection models",
                                .scene = "torus_metal",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
