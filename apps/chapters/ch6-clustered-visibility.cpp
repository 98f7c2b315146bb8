// Chapter 6: indirect light with clustered visibility.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"ch6_figures", "ch6"};
  constexpr ChapterSetting settings[] = {
      {"30 virtual area lights", "clustered_visibility", "clustered_visibility.vals=30",
       "A thousand virtual lights share the soft shadows of thirty area lights."},
      {"10 virtual area lights", "clustered_visibility", "clustered_visibility.vals=10",
       "Fewer, larger area lights: softer shadows, less time."},
      {"5 virtual area lights", "clustered_visibility", "clustered_visibility.vals=5",
       "Watch the contact shadows of the hooves fade."},
      {"2 virtual area lights", "clustered_visibility", "clustered_visibility.vals=2",
       "Two area lights for all of the light in the room."},
      {"Clusters in colours", "clustered_visibility", "clustered_visibility.show=clusters",
       "Which virtual lights k-means put together."},
      {"A map for each virtual light", "instant_radiosity", "",
       "Brute force, every light in every pixel: the other steps interleave 8 x 8 pixels."},
      {"Coarse maps of points", "imperfect_shadow_maps", "", "The other way to afford a thousand shadows."},
      {"No visibility", "reflective_shadow_map", "", "What the shadows of indirect light add."},
  };
  return limn::app::runChapter({.name = "ch6-clustered-visibility",
                                .title = "Indirect light with clustered visibility",
                                .scene = "cornell_horse",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
