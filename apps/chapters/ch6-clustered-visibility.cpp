// Chapter 6: indirect light with clustered visibility.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"ch6_figures", "ch6"};
  constexpr ChapterSetting settings[] = {
      {"30 virtual area lights", "clustered_visibility", "clustered_visibility.vals=30"},
      {"10 virtual area lights", "clustered_visibility", "clustered_visibility.vals=10"},
      {"5 virtual area lights", "clustered_visibility", "clustered_visibility.vals=5"},
      {"2 virtual area lights", "clustered_visibility", "clustered_visibility.vals=2"},
      {"Clusters in colours", "clustered_visibility", "clustered_visibility.show=clusters"},
      {"A map for each virtual light", "instant_radiosity", ""},
      {"No visibility", "reflective_shadow_map", ""},
  };
  return limn::app::runChapter({.name = "ch6-clustered-visibility",
                                .title = "Indirect light with clustered visibility",
                                .scene = "cornell_horse",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
