// Chapter 8: volume caustics in single-scattering media.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"ch8_figures", "ch8", "ch8_smoke"};
  constexpr const char* whole = "hard_shadow_map,airlight,surface_caustics,volume_caustics";
  constexpr ChapterSetting settings[] = {
      {"All parts", whole, "", "Airlight, volume caustics and surface caustics add up."},
      {"Airlight", "hard_shadow_map,airlight", "",
       "Light scattered once on its way from the lamp, with the shadow in it."},
      {"Volume caustics", "hard_shadow_map,volume_caustics", "",
       "Every texel of the light's map is one line through the medium."},
      {"Surface caustics", "hard_shadow_map,surface_caustics", "",
       "The same rays where they end on a surface."},
      {"Reflection alone", whole, "volume_caustics.paths=reflection surface_caustics.paths=reflection",
       "Only light that specular objects reflect."},
      {"Refraction alone", whole, "volume_caustics.paths=refraction surface_caustics.paths=refraction",
       "Only light that went in and out of them."},
      {"Lines alone, as published", whole, "volume_caustics.beams=false",
       "Near lines keep the width of a pixel."},
      {"Without a physical model", "hard_shadow_map,airlight,krueger_caustics", "",
       "All fragments of all lines have one weight, as before the thesis."},
  };
  return limn::app::runChapter({.name = "ch8-volume-caustics",
                                .title = "Volume caustics",
                                .scene = "glass_sphere",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
