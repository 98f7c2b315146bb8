// Bumps: height maps that shadow and light themselves.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"bumps", "bumps_bounce"};
  constexpr ChapterSetting settings[] = {
      {"Bumps alone", "pcss", "",
       "Normals of the height map, without shadows of its bumps; look at --scene bump_sphere, egg_crate and "
       "groove, too."},
      {"Shadows by ellipses", "pcss,bump_horizon", "",
       "What a texel sees is an ellipse, from the moments of its horizon."},
      {"As published", "pcss,bump_horizon", "bump_horizon.shape=published",
       "Ellipses fitted to 256 random directions, of the nearest texel."},
      {"Horizon maps", "pcss,bump_horizon", "bump_horizon.shape=horizon_map bump_horizon.azimuths=16",
       "Sixteen elevations a texel: more memory, and corners that ellipses round off."},
      {"March", "pcss,bump_horizon", "bump_horizon.shape=march bump_horizon.steps=64",
       "Steps through the heights themselves."},
      {"Light from bump to bump", "pcss,bump_horizon,bump_interreflection", "",
       "Joints of the wall are lit by their sides."},
      {"Four bounces", "pcss,bump_horizon,bump_interreflection", "bump_interreflection.bounces=4",
       "The same, with light that went on."},
      {"Published directions", "pcss,bump_horizon,bump_interreflection",
       "bump_interreflection.directions=published",
       "Directions above the base alone miss the nearest walls."},
  };
  return limn::app::runChapter({.name = "bumps",
                                .title = "Bump maps that shadow and light themselves",
                                .scene = "bump_wall",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
