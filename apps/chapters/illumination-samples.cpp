// Illumination samples: light that bounces over glossy surfaces, kept as trees of directions.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"illumination_samples"};
  constexpr ChapterSetting settings[] = {
      {"Direct light", "pcss", "",
       "What the lamps light. Look at --scene three_lights, glossy_room, glossy_globe and glossy_furnace, "
       "too."},
      {"Illumination samples", "pcss,illumination_samples", "",
       "One bounce, from trees of directions: walk, and only the last passes run again (the inspector shows "
       "them)."},
      {"A tree of directions", "pcss,illumination_samples", "illumination_samples.show=tree",
       "What the element in the middle of the picture reflects, on a disc in the corner: walk, and look at "
       "another."},
      {"Gathered at pixels", "pcss,illumination_samples", "illumination_samples.display=gather",
       "The samples themselves, reflected at each pixel: highlights are round, and walking costs more."},
      {"At vertices, as published", "pcss,illumination_samples",
       "illumination_samples.display=vertex illumination_samples.criterion=relative "
       "illumination_samples.direction_error=0.5 illumination_samples.min_level=1 "
       "illumination_samples.max_level=5",
       "Cells of directions split while light varies by a half, and are looked up at vertices."},
      {"Points for samples", "pcss,illumination_samples",
       "illumination_samples.display=gather illumination_samples.widen=0 illumination_samples.receiver=off",
       "Without the extent of what sent the light: large senders become dots in the steel."},
      {"One level of cells", "pcss,illumination_samples",
       "illumination_samples.basis=uniform illumination_samples.max_level=3",
       "145 corners for every element: lobes are cut off, and light is lost."},
      {"Three bounces", "pcss,illumination_samples", "illumination_samples.bounces=3",
       "Trees send light on, so that a bounce more is a round of links more."},
      {"Coarse and quick", "pcss,illumination_samples",
       "illumination_samples.link_error=0.03 illumination_samples.direction_error=0.4",
       "A third of the time."},
      {"Implicit visibility", "pcss,implicit_visibility:indirect", "implicit_visibility.glossy_bins=6",
       "Fast enough for what moves: each vertex gathers from bins around it."},
      {"Virtual point lights", "pcss,instant_radiosity", "",
       "Points reflect in satin as dots, or not at all where they are clamped."},
  };
  return limn::app::runChapter({.name = "illumination-samples",
                                .title = "Illumination samples",
                                .scene = "soda_corner",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
