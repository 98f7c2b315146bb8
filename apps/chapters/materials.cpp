// Materials: reflection models beyond metallic-roughness.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"materials"};
  constexpr ChapterSetting settings[] = {
      {"Exact models", "hard_shadow_map", "",
       "Torrance and Sparrow's model of copper and aluminium; look at --scene disk_and_sphere, "
       "fresnel_spheres, glossy_torus, teapot_groove and measured_spheres, too."},
      {"Two tables", "hard_shadow_map,factored_brdf", "",
       "Two lookups replace the formula: the picture should not change."},
      {"Published coordinates", "hard_shadow_map,factored_brdf", "factored_brdf.coordinates=published",
       "Tables over cosines are too coarse where a lobe is narrow: look at the aluminium."},
      {"As published", "hard_shadow_map,factored_brdf",
       "factored_brdf.coordinates=published factored_brdf.format=byte",
       "8 bits and masking clamped to 1: grazing views are too dark."},
      {"Four curves", "hard_shadow_map,factored_brdf", "factored_brdf.fit=dfg",
       "A product of functions of n.h, h.l, n.l and n.v, fitted to the values: 1 kB a material."},
      {"Homomorphic, over directions", "hard_shadow_map,factored_brdf", "factored_brdf.fit=pqp_disc",
       "p(l) q(h) p(v), which follows the grooves of teapot_groove, as dfg_disc and svd do and no other "
       "fit."},
      {"Singular values", "hard_shadow_map,factored_brdf", "factored_brdf.fit=svd factored_brdf.terms=4",
       "Four products of functions of half vector and difference: highlights are too wide."},
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
