// Subtractive shadows: the environment's light without shadows, less what is hidden of few samples.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"subtractive_figures", "subtractive", "subtractive_time",
                                    "subtractive_grid", "subtractive_lights"};
  constexpr ChapterSetting settings[] = {
      {"U: without shadows", "", "",
       "All that the sky would give, from filtered maps. Look at --scene nine_spheres, nine_spheres_glossy, "
       "nine_spheres_metal, balls_sky and arcade_dark, too."},
      {"S: what is hidden, by blocks", "subtractive_shadows",
       "subtractive_shadows.combine=subtract subtractive_shadows.demodulate=false "
       "subtractive_shadows.unshadowed=prefiltered subtractive_shadows.show=shadow_buffer",
       "One pixel in 16 has shadows of its own: what 25 samples lack there is the shadow buffer."},
      {"S': what is hidden, by pixels", "subtractive_shadows",
       "subtractive_shadows.combine=subtract subtractive_shadows.demodulate=false "
       "subtractive_shadows.unshadowed=prefiltered subtractive_shadows.show=hidden",
       "Pixels take it from the blocks around them whose surfaces are near and alike: it ends at edges."},
      {"U - S': 1/16", "subtractive_shadows",
       "subtractive_shadows.combine=subtract subtractive_shadows.demodulate=false "
       "subtractive_shadows.unshadowed=prefiltered",
       "As published, but with filtered maps for U: S holds the surface's colours, so that the table's and "
       "the floor's are blurred. Play the animation: every three seconds another of four materials is in "
       "front."},
      {"A: what is seen of 25 samples", "subtractive_shadows",
       "subtractive_shadows.combine=add subtractive_shadows.block=1",
       "Added up, as the baseline does: highlights are single dots, and shadows have 25 edges."},
      {"U less the hidden light", "subtractive_shadows",
       "subtractive_shadows.combine=subtract subtractive_shadows.block=1",
       "The sky's own highlights come back. Too much may be subtracted: metals have dark spots."},
      {"Shadows without colours", "subtractive_shadows", "subtractive_shadows.combine=subtract",
       "What blocks share is divided by the albedo first: textures stay sharp."},
      {"The share that is seen", "subtractive_shadows", "subtractive_shadows.combine=ratio",
       "U A / U_N instead of a difference: never below 0 and never above U."},
      {"Diffuse part and lobe apart", "subtractive_shadows", "", "Each has a share of its own: the default."},
      {"U from the source's cache", "subtractive_shadows", "subtractive_shadows.unshadowed=cache",
       "What materials reflect by normal, seen from the middle of the picture: wrong highlights elsewhere."},
      {"U from filtered maps", "subtractive_shadows", "subtractive_shadows.unshadowed=prefiltered",
       "Highlights in the maps of few widths, instead of the 32 samples of each lobe that are the default."},
      {"Eight lights", "subtractive_shadows", "subtractive_shadows.lights=8",
       "Shadows are eight hard ones; the light stays right."},
      {"256 lights", "subtractive_shadows", "subtractive_shadows.lights=256 subtractive_shadows.block=8",
       "Smooth shadows; blocks of 8 x 8 pixels pay for them, and lose what is narrow."},
      {"Regions of the sky", "subtractive_shadows",
       "subtractive_shadows.sampling=regions subtractive_shadows.block=1",
       "Samples that stand for all light around them."},
      {"Kept at 40 ms", "subtractive_shadows",
       "subtractive_shadows.lights=64 subtractive_shadows.frame_time=40",
       "Lights become fewer, then blocks larger, until a frame takes no longer; play the animation."},
      {"25 samples", "sampled_environment_light", "sampled_environment_light.samples=25",
       "As many maps, all pixels, added up."},
      {"500 samples", "sampled_environment_light", "sampled_environment_light.samples=500",
       "What all of them converge to."},
  };
  return limn::app::runChapter({.name = "subtractive",
                                .title = "Subtractive shadows",
                                .scene = "robot_brdfs",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
