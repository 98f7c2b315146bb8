// Subsurface scattering: light that leaves translucent bodies beside where it entered.
#include "apps/chapters/support/chapter.h"

int main(int argc, char** argv) {
  using limn::app::ChapterSetting;
  constexpr const char* suites[] = {"subsurface"};
  constexpr ChapterSetting settings[] = {
      {"Where it entered", "hard_shadow_map", "",
       "The local limit: each place reflects its own light, and stone looks like plaster. Look at --scene "
       "translucent_edge, translucent_spheres, translucent_head, translucent_checker, translucent_ear and "
       "milk, "
       "too."},
      {"Points from the dipole's profile", "hard_shadow_map,subsurface_scattering", "",
       "Sixteen points around each pixel, drawn by how much light comes from there; their weights are "
       "divided "
       "by their sum."},
      {"As published", "hard_shadow_map,subsurface_scattering",
       "subsurface_scattering.normalise=count subsurface_scattering.mixing=own subsurface_scattering.block=1",
       "A mean over the points that meet the body, the same ones at each pixel: rims are too bright."},
      {"The integral itself", "hard_shadow_map,subsurface_scattering", "subsurface_scattering.normalise=none",
       "Nothing is lost or made up, but rims are speckled: few points stand for much area there."},
      {"Four points", "hard_shadow_map,subsurface_scattering", "subsurface_scattering.samples=4",
       "Sixteen pixels that draw different points share them; the blur between them stops at edges."},
      {"64 points", "hard_shadow_map,subsurface_scattering", "subsurface_scattering.samples=64",
       "Close to the integral, for four times the price of sixteen."},
      {"Two planes", "hard_shadow_map,subsurface_scattering", "subsurface_scattering.planes=both",
       "Points in the plane that faces the camera, too: better where the body is small or seen at its rim."},
      {"Normalised diffusion", "hard_shadow_map,subsurface_scattering",
       "subsurface_scattering.profile=normalised_diffusion",
       "The profile of a random walk instead of the dipole's: light stays nearer to where it entered."},
      {"Light from behind", "hard_shadow_map,subsurface_scattering", "subsurface_scattering.light_views=1",
       "Light also enters where the lights look and the camera does not: look at translucent_ear."},
      {"A separable kernel", "hard_shadow_map,separable_subsurface", "",
       "Two blurs of the picture, along rows and columns, stand for the profile."},
      {"In a texture of the surface", "hard_shadow_map,texture_space_subsurface", "",
       "The whole surface is lit in a texture, and six Gaussians spread the light there."},
      {"Points on the whole surface", "hard_shadow_map,hierarchical_subsurface", "",
       "A hierarchy of points on the body: light comes through thin parts from where the camera does not "
       "see, as "
       "in translucent_ear."},
  };
  return limn::app::runChapter({.name = "subsurface",
                                .title = "Light below the surface",
                                .scene = "marble_statue",
                                .suites = suites,
                                .settings = settings},
                               argc, argv);
}
