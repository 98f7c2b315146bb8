// Chapter 8: volume caustics in single-scattering media.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"ch8_figures", "ch8"};
  constexpr const char* whole = "hard_shadow_map,airlight,surface_caustics,volume_caustics";
  constexpr ChapterSetting settings[] = {
      {"All parts", whole, ""},
      {"Airlight", "hard_shadow_map,airlight", ""},
      {"Volume caustics", "hard_shadow_map,volume_caustics", ""},
      {"Surface caustics", "hard_shadow_map,surface_caustics", ""},
      {"Reflection alone", whole, "volume_caustics.paths=reflection surface_caustics.paths=reflection"},
      {"Refraction alone", whole, "volume_caustics.paths=refraction surface_caustics.paths=refraction"},
      {"Lines alone, as published", whole, "volume_caustics.beams=false"},
      {"Without a physical model", "hard_shadow_map,airlight,krueger_caustics", ""},
  };
  return limn::app::runChapter({.name = "ch8-volume-caustics",
                                .title = "Volume caustics",
                                .scene = "glass_sphere",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
