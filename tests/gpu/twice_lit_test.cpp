// Indirect light in scenes with translucent surfaces, which are lit twice: what virtual point lights have
// made once serves both times.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene/camera.h"
#include "tests/gpu/render_test.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

/// Looks at scenes with translucent surfaces, which are lit twice: for what their boundaries reflect, and for
/// what enters them.
class TwiceLitTest : public RenderTest {
 protected:
  /// How many passes of that name the technique ran in the last frame, whatever number they have.
  static int passes(const render::Renderer& renderer, std::string_view technique, std::string_view name) {
    return static_cast<int>(std::ranges::count_if(renderer.explain(), [&](const frame::PassReport& pass) {
      return pass.technique == technique && pass.state == frame::PassState::run &&
             pass.name.substr(0, pass.name.find_last_not_of(" 0123456789") + 1) == name;
    }));
  }
  /// Of what the pass writes: one for each part of the light.
  static int layers(const render::Renderer& renderer, std::string_view name) {
    for (const frame::PassReport& pass : renderer.explain())
      if (pass.technique == "reflective_shadow_map" && pass.name == name)
        for (const frame::AccessReport& access : pass.accesses)
          if (access.write && access.texture) return access.texture->layers;
    return 0;
  }
  /// A floor and a wall below which light goes on, and a lamp.
  static scene::Scene corner() {
    scene::Scene scene;
    scene::Material body = test::lambertian(0.5f);
    body.subsurface = scene::Subsurface{};
    const int material = test::addMaterial(scene, body);
    test::show(scene, test::quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, material));
    test::show(scene, test::quad({0, 1, -1}, {2, 0, 0}, {0, 2, 0}, material));
    test::shine(scene, test::lamp(glsl::light_point, 10), {0.3f, 1.2f, 0.2f});
    return scene;
  }
  static scene::CameraPose camera() { return scene::lookAt({1.2f, 1.2f, 2.5f}, {0, 0.5f, -0.3f}, 0.8f); }
  Image all(render::Renderer& renderer, const std::string& name,
            const std::vector<std::pair<std::string, std::string>>& values) {
    return picture(renderer, settings(64, 48, Term::final, {technique(name, values)}));
  }
};

/// Views, maps and clusters are those of the virtual lights. Maps that come in batches, which share memory,
/// are drawn again.
TEST_F(TwiceLitTest, WhatVirtualLightsSeeIsDrawnOnce) {
  const scene::Scene scene = asset("milk");
  render::Renderer renderer(device(), scene);
  const auto count = [&](std::string_view technique, std::string_view name) {
    return passes(renderer, technique, name);
  };
  const Image once = all(renderer, "instant_radiosity", {{"vpls", "64"}, {"map_size", "256"}});
  EXPECT_EQ(count("instant_radiosity", "shade"), 2);
  EXPECT_EQ(count("instant_radiosity", "views"), 1);
  EXPECT_EQ(count("instant_radiosity", "paraboloid maps"), 1);
  const Image batches =
      all(renderer, "instant_radiosity", {{"vpls", "64"}, {"map_size", "256"}, {"memory", "16"}});
  EXPECT_EQ(count("instant_radiosity", "shade"), 4);
  EXPECT_EQ(count("instant_radiosity", "views"), 1);
  EXPECT_EQ(count("instant_radiosity", "paraboloid maps"), 4);
  EXPECT_LT(rmse(once, batches), 1e-5 * mean(once));

  all(renderer, "imperfect_shadow_maps", {{"vpls", "64"}});
  EXPECT_EQ(count("imperfect_shadow_maps", "shade"), 2);
  for (const char* name : {"views", "points of the scene", "splat points"})
    EXPECT_EQ(count("imperfect_shadow_maps", name), 1) << name;

  for (const char* maps : {"triangles", "points"}) {
    all(renderer, "clustered_visibility", {{"vpls", "64"}, {"vals", "4"}, {"maps", maps}});
    EXPECT_EQ(count("clustered_visibility", "shade"), 2) << maps;
    for (const char* name : {"cluster start", "cluster area", "cluster sort"})
      EXPECT_EQ(count("clustered_visibility", name), 1) << name << " with maps of " << maps;
    EXPECT_EQ(
        count("clustered_visibility", "paraboloid maps") + count("clustered_visibility", "splat points"), 1)
        << maps;
  }
}

/// What enters has no specular part, so that nothing is shaded, blurred and kept for it.
TEST_F(TwiceLitTest, WhatEntersHasNoSpecularPart) {
  const scene::Scene scene = asset("milk");
  render::Renderer renderer(device(), scene);
  all(renderer, "reflective_shadow_map", {{"vpls", "64"}});
  EXPECT_EQ(layers(renderer, "shade"), 2) << "at the boundaries";
  EXPECT_EQ(layers(renderer, "shade 2"), 1);
}

/// Of the parts of the light, compensation spreads one: the others are not kept beside it.
TEST_F(TwiceLitTest, WhatTheClampTookIsSpreadAlone) {
  const scene::Scene scene = asset("milk");
  render::Renderer renderer(device(), scene);
  all(renderer, "reflective_shadow_map", {{"vpls", "64"}, {"compensation", "true"}});
  EXPECT_EQ(layers(renderer, "shade"), 3) << "diffuse, specular, residual";
  for (const char* name : {"spread residual", "spread residual 2"})
    EXPECT_EQ(layers(renderer, name), 1) << name;
}

/// Mirrors and glass take no light, and of a material that nothing is drawn with there is none.
TEST_F(TwiceLitTest, LambertianSurfacesHaveNoSpecularPartBesideGlassAndUnusedMaterials) {
  scene::Scene scene = asset("glass_sphere");
  scene.materials.push_back(asset("milk").materials[3]);
  ASSERT_FALSE(scene.materials.back().lambertian() || scene.materials.back().specularSurface());
  render::Renderer renderer(device(), scene);
  all(renderer, "reflective_shadow_map", {{"vpls", "64"}});
  EXPECT_EQ(layers(renderer, "shade"), 1);
}

/// Colours of clusters and elements stand in place of light, and a tree over it, in the picture alone: the
/// surfaces below which light goes on get none of them.
TEST_F(TwiceLitTest, WhatIsShownInColoursEntersNoSurface) {
  const scene::Scene scene = corner();
  render::Renderer renderer(device(), scene);
  const auto left = [&](std::vector<render::TechniqueUse> techniques) {
    for (render::TechniqueUse& use : techniques) use.terms = termSet(Term::indirect);
    return picture(renderer, settings(64, 48, Term::subsurface, std::move(techniques)), camera());
  };
  const Image direct = left({});
  EXPECT_GT(mean(direct), 0);
  EXPECT_EQ(rmse(left({technique("clustered_visibility", {{"vpls", "64"}, {"show", "clusters"}})}), direct),
            0);
  EXPECT_EQ(rmse(left({technique("implicit_visibility",
                                 {{"bins", "4"}, {"longest_edge", "0.3"}, {"show", "level"}})}),
                 direct),
            0);
  const auto sampled = [&](const char* show) {
    return left({technique("illumination_samples",
                           {{"longest_edge", "0.3"}, {"link_error", "0.03"}, {"show", show}})});
  };
  const Image lit = sampled("light");
  EXPECT_GT(mean(lit), mean(direct));
  EXPECT_EQ(rmse(sampled("tree"), lit), 0);
}

/// What elements send there is the same, whatever it is looked up for.
TEST_F(TwiceLitTest, ElementsAreLookedUpTowardsTheEyeOnce) {
  const scene::Scene scene = corner();
  render::Renderer renderer(device(), scene);
  picture(renderer,
          settings(64, 48, Term::final,
                   {technique("illumination_samples",
                              {{"longest_edge", "0.3"}, {"link_error", "0.03"}, {"display", "vertex"}})}),
          camera());
  EXPECT_EQ(passes(renderer, "illumination_samples", "interpolate"), 2);
  EXPECT_EQ(passes(renderer, "illumination_samples", "towards the eye"), 1);
}

}  // namespace
}  // namespace limn
