// Laws that every technique of light below surfaces keeps: what it may not gain, what it comes to where light
// goes nowhere, and that neither units nor the strength of lamps matter.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/camera.h"
#include "glsl/diffusion/normalised.glsl"
#include "tests/gpu/render_test.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using glm::vec3;

constexpr int kPictureSide = 64;
constexpr float kTermIor = 1.4f;

class SubsurfaceTechniqueTest : public RenderTest {
 protected:
  static glm::vec4 albedo(const vec3& absorption, float ior) {
    const glsl::WalkReflectance walk = glsl::walk_reflectance(glsl::diffusion_boundary(ior));
    glm::vec4 all(1);
    for (int c = 0; c < 3; ++c) all[c] = glsl::walk_albedo(walk, absorption[c]);
    return all;
  }

  /// A ball of radius `size` on a floor of the same matter, seen from 4 radii, under a lamp.
  static scene::Scene ball(float meanFreePath, float size = 1, float strength = 1) {
    scene::Scene scene;
    scene::Material matter = test::lambertian(1);
    matter.ior = kTermIor;
    const vec3 absorption(0.01f, 0.05f, 0.3f);
    matter.subsurface =
        scene::Subsurface{.extinction = vec3(1 / (meanFreePath * size)), .absorption = absorption};
    matter.baseColour = albedo(absorption, kTermIor);
    const int material = test::addMaterial(scene, matter);
    test::show(scene, test::spherePrimitive(size, material));
    test::show(scene, test::quad({0, -size, 0}, {8 * size, 0, 0}, {0, 0, -8 * size}, material));
    test::shine(scene, test::lamp(glsl::light_point, 9 * size * size * strength), size * vec3(1.5f, 2.5f, 1));
    return scene;
  }

  static Image drawn(render::Renderer& renderer, const std::vector<render::TechniqueUse>& techniques,
                     float size = 1) {
    renderer.configure(settings(kPictureSide, kPictureSide, Term::subsurface, techniques));
    renderer.setCamera(scene::lookAt(size * vec3(0.5f, 1.5f, 4), vec3(0), 0.7f));
    renderer.render();
    return renderer.read();
  }

  /// Pictures of ball(0.1f) by each of the techniques under test, by their names: what several tests compare
  /// with is drawn once.
  static const Image& usual(const render::TechniqueUse& use) {
    static const std::map<std::string, Image> all = [] {
      const scene::Scene scene = ball(0.1f);
      render::Renderer renderer(device(), scene);
      std::map<std::string, Image> pictures;
      for (const render::TechniqueUse& each : uses())
        pictures.emplace(each.plugin->info->name, drawn(renderer, {each}));
      return pictures;
    }();
    return all.at(use.plugin->info->name);
  }

  /// The picture of a ball of radius 1 at a time of the scene's first animation.
  static Image pictureAt(render::Renderer& renderer, double time) {
    renderer.setTime(time, 0);
    renderer.setCamera(scene::lookAt({0.5f, 1.5f, 4}, vec3(0), 0.7f));
    renderer.render();
    return renderer.read();
  }

  /// Expects that a renderer that has shown time 0 shows time 1 as one that begins there does: the pictures
  /// differ by less than a tenth of what has changed since, which is above a tenth of the light.
  static void expectFreshStart(const scene::Scene& scene, const render::TechniqueUse& use) {
    render::Settings s = settings(kPictureSide, kPictureSide, Term::subsurface, {use});
    s.dynamic = false;
    render::Renderer moved(device(), scene), fresh(device(), scene);
    moved.configure(s);
    fresh.configure(s);
    const Image before = pictureAt(moved, 0), after = pictureAt(moved, 1), wanted = pictureAt(fresh, 1);
    const double change = rmse(before, wanted);
    EXPECT_GT(change, 0.1 * mean(wanted));
    EXPECT_LT(rmse(after, wanted), 0.1 * change);
  }

  /// Those under test, whose light spreads as far as the half space's albedo says.
  static std::vector<render::TechniqueUse> uses() {
    std::vector<render::TechniqueUse> all;
    for (const std::string& name : techniquesAnswering(Term::subsurface)) {
      all.push_back(technique(name));
      all.back().parameters.set("profile", "normalised_diffusion");
    }
    return all;
  }

  static double largestRatio(const Image& image, const Image& truth) {
    double most = 0;
    for (size_t i = 0; i < image.data().size(); ++i)
      if (truth.data()[i] > 1e-6f)
        most = std::max(most, std::abs(double(image.data()[i]) / double(truth.data()[i]) - 1));
    return most;
  }
};

/// Light that goes nowhere leaves where it entered.
TEST_F(SubsurfaceTechniqueTest, ShortMeanFreePathsMeetTheLocalLimit) {
  const scene::Scene scene = ball(1e-7f);
  render::Renderer renderer(device(), scene);
  const Image local = drawn(renderer, {});
  EXPECT_GT(mean(local), 0.01);
  for (const render::TechniqueUse& use : uses()) {
    SCOPED_TRACE(use.plugin->info->name);
    EXPECT_LT(largestRatio(drawn(renderer, {use}), local), 1e-3);
  }
}

/// Under light 1 from everywhere a body sends back no more than what enters it, times the half space's
/// albedo.
TEST_F(SubsurfaceTechniqueTest, BodiesGainNothing) {
  for (const float meanFreePath : {0.003f, 0.03f, 0.3f, 3.f}) {
    SCOPED_TRACE(meanFreePath);
    scene::Scene scene = ball(meanFreePath, 1, 0);
    scene.environment.width = 16;
    scene.environment.height = 8;
    scene.environment.texels.assign(128, vec3(1));
    render::Renderer renderer(device(), scene);
    const Image local = drawn(renderer, {});
    for (const render::TechniqueUse& use : uses()) {
      SCOPED_TRACE(use.plugin->info->name);
      const Image image = drawn(renderer, {use});
      expectWithin(image, 0, 1);
      double most = 0;
      for (size_t i = 0; i < image.data().size(); ++i)
        most = std::max(most, double(image.data()[i]) - double(local.data()[i]));
      EXPECT_LT(most, 0.01) << "of 1";
    }
  }
}

TEST_F(SubsurfaceTechniqueTest, UnitsOfLengthDoNotMatter) {
  for (const float size : {1e-4f, 1e4f}) {
    const scene::Scene scene = ball(0.1f, size);
    render::Renderer renderer(device(), scene);
    for (const render::TechniqueUse& use : uses()) {
      SCOPED_TRACE(use.plugin->info->name);
      const Image& one = usual(use);
      EXPECT_LT(rmse(drawn(renderer, {use}, size), one), 0.01 * mean(one)) << size;
    }
  }
}

TEST_F(SubsurfaceTechniqueTest, LightScalesLinearlyOverTwelveDecades) {
  for (const float strength : {1e-6f, 1e6f}) {
    const scene::Scene scene = ball(0.1f, 1, strength);
    render::Renderer renderer(device(), scene);
    for (const render::TechniqueUse& use : uses()) {
      SCOPED_TRACE(use.plugin->info->name);
      EXPECT_NEAR(mean(drawn(renderer, {use})) / mean(usual(use)) / double(strength), 1, 1e-4);
    }
  }
}

/// Channels without scattering or without absorption, mean free paths beyond all sizes, and indices of 1
/// and 3.
TEST_F(SubsurfaceTechniqueTest, ExtremeMatterGivesFiniteLight) {
  for (const float ior : {1.f, 3.f})
    for (const float meanFreePath : {1e-6f, 1.f, 1e6f})
      for (const vec3& absorption : {vec3(0, 0.5f, 1), vec3(0), vec3(1)}) {
        scene::Scene scene = ball(meanFreePath);
        scene.materials[0].ior = ior;
        scene.materials[0].subsurface->absorption = absorption;
        scene.materials[0].baseColour = albedo(absorption, ior);
        render::Renderer renderer(device(), scene);
        for (const char* profile : {"dipole", "normalised_diffusion"})
          for (render::TechniqueUse& use : uses()) {
            SCOPED_TRACE(use.plugin->info->name);
            use.parameters.set("profile", profile);
            expectWithin(drawn(renderer, {use}), 0, 100);
          }
      }
}

/// Geometry of a source, as metaballs are, scatters what the same mesh does, alone and beside a mesh.
TEST_F(SubsurfaceTechniqueTest, SourcesScatterAsMeshesDo) {
  for (const bool alone : {true, false}) {
    scene::Scene mesh = ball(0.1f);
    if (alone) mesh.nodes[1].mesh = scene::kNone;
    scene::Scene source = mesh;
    source.nodes[0].mesh = scene::kNone;
    source.dynamic.push_back({"ball", std::make_shared<test::StillSource>(mesh.meshes[0].primitives[0]),
                              mesh.meshes[0].primitives[0].material});
    render::Renderer ofMesh(device(), mesh);
    const Image local = drawn(ofMesh, {});
    for (const render::TechniqueUse& use : uses()) {
      SCOPED_TRACE(use.plugin->info->name);
      render::Renderer ofSource(device(), source);  // its first frame
      const Image expected = drawn(ofMesh, {use}), found = drawn(ofSource, {use});
      expectWithin(found, 0, 100);
      EXPECT_GT(rmse(expected, local), 0.02 * mean(expected)) << "light gets nowhere";
      EXPECT_LT(rmse(found, expected), 0.01 * mean(expected)) << (alone ? "alone" : "beside a mesh");
    }
  }
}

/// Morphed geometry scatters what the mesh does that it comes to.
TEST_F(SubsurfaceTechniqueTest, MorphedBodiesScatterAsMeshesDo) {
  scene::Scene morphed = ball(0.1f);
  scene::Primitive& body = morphed.meshes[0].primitives[0];
  scene::MorphTarget& target = body.morphTargets.emplace_back();
  for (vec3& p : body.positions) {
    target.positions.push_back(vec3(0.3f, 0.5f * p.y, 0));
    target.deltaBounds.add(target.positions.back());
    p -= target.positions.back();
  }
  target.deltaBounds.add(vec3(0));
  morphed.meshes[0].morphWeights = {1};
  morphed.nodes[0].morphWeights = {1};
  for (const render::TechniqueUse& use : uses()) {
    SCOPED_TRACE(use.plugin->info->name);
    render::Renderer renderer(device(), morphed);  // its first frame
    const Image& expected = usual(use);
    EXPECT_LT(rmse(drawn(renderer, {use}), expected), 0.01 * mean(expected));
  }
}

/// A node that mirrors its mesh's mirror image shows the mesh. Rounding of places may decide on other
/// clusters and charts, whose errors are some thousandths of the light.
TEST_F(SubsurfaceTechniqueTest, MirroredMeshesScatterAsMeshesDo) {
  scene::Scene mirrored = ball(0.1f);
  scene::Primitive& body = mirrored.meshes[0].primitives[0];
  for (vec3& p : body.positions) p.x = -p.x;
  for (vec3& n : body.normals) n.x = -n.x;
  for (size_t t = 0; t < body.indices.size(); t += 3) std::swap(body.indices[t + 1], body.indices[t + 2]);
  mirrored.nodes[0].matrix = glm::scale(glm::mat4(1), vec3(-1, 1, 1));
  render::Renderer renderer(device(), mirrored);
  for (const render::TechniqueUse& use : uses()) {
    SCOPED_TRACE(use.plugin->info->name);
    const Image& expected = usual(use);
    EXPECT_LT(rmse(drawn(renderer, {use}), expected), 0.03 * mean(expected));
  }
}

/// Bodies that appear, grow or are mirrored look as they do in a renderer that never saw them otherwise.
TEST_F(SubsurfaceTechniqueTest, BodiesThatGrewAreThoseOfAFreshStart) {
  scene::Scene scene = ball(0.1f);
  scene.nodes[0].matrix.reset();
  scene::Animation& animation = scene.animations.emplace_back();
  animation.duration = 3;
  animation.channels.push_back({scene::AnimationChannel::Path::scale,
                                scene::AnimationChannel::Interpolation::linear,
                                0,
                                {0, 1, 2, 3},
                                {0, 0, 0, 0.3f, 0.3f, 0.3f, 1, 1, 1, -1, 1, 1}});
  for (const render::TechniqueUse& use : uses()) {
    SCOPED_TRACE(use.plugin->info->name);
    const auto at = [&](render::Renderer& renderer, double time) {
      const Image image = pictureAt(renderer, time);
      return std::vector<float>(image.data().begin(), image.data().end());
    };
    const render::Settings s = settings(kPictureSide, kPictureSide, Term::subsurface, {use});
    render::Renderer grown(device(), scene);
    grown.configure(s);
    at(grown, 0);
    for (const double time : {1, 2, 3}) {
      render::Renderer fresh(device(), scene);
      fresh.setTime(time, 0);
      fresh.configure(s);
      EXPECT_EQ(at(grown, time), at(fresh, time)) << time;
    }
  }
}

/// So do bodies that morph targets unfold from a single place.
TEST_F(SubsurfaceTechniqueTest, BodiesThatUnfoldedAreThoseOfAFreshStart) {
  scene::Scene scene = ball(0.1f);
  scene::Primitive& body = scene.meshes[0].primitives[0];
  scene::MorphTarget& target = body.morphTargets.emplace_back();
  target.positions = body.positions;
  target.deltaBounds = body.bounds;
  for (vec3& p : body.positions) p = vec3(0);
  scene.meshes[0].morphWeights = {0};
  scene.nodes[0].morphWeights = {0};
  scene::Animation& animation = scene.animations.emplace_back();
  animation.duration = 2;
  animation.channels.push_back({scene::AnimationChannel::Path::weights,
                                scene::AnimationChannel::Interpolation::linear,
                                0,
                                {0, 1},
                                {0, 1}});
  for (const render::TechniqueUse& use : uses()) {
    SCOPED_TRACE(use.plugin->info->name);
    const render::Settings s = settings(kPictureSide, kPictureSide, Term::subsurface, {use});
    render::Renderer unfolded(device(), scene), fresh(device(), scene);
    unfolded.configure(s);
    fresh.configure(s);
    const Image before = pictureAt(unfolded, 0), after = pictureAt(unfolded, 1), wanted = pictureAt(fresh, 1);
    EXPECT_GT(rmse(before, wanted), 0.1 * mean(wanted));
    EXPECT_TRUE(std::ranges::equal(after.data(), wanted.data()));
  }
}

/// What is kept from frame to frame follows a body that moves as a whole, by its matrix or by a morph target.
TEST_F(SubsurfaceTechniqueTest, BodiesThatMovedAreThoseOfAFreshStart) {
  using Path = scene::AnimationChannel::Path;
  for (const bool morphs : {false, true}) {
    scene::Scene scene = ball(0.1f);
    scene.nodes[0].matrix.reset();
    scene::Animation& animation = scene.animations.emplace_back();
    animation.duration = 2;
    animation.channels.push_back({morphs ? Path::weights : Path::translation,
                                  scene::AnimationChannel::Interpolation::linear,
                                  0,
                                  {0, 1},
                                  {0, 0, 0, 0.75f, 0, 0}});
    if (morphs) {
      animation.channels.back().values = {0, 1};
      scene::Primitive& body = scene.meshes[0].primitives[0];
      scene::MorphTarget& target = body.morphTargets.emplace_back();
      target.positions.assign(body.positions.size(), vec3(0.75f, 0, 0));
      for (const vec3& shift : {vec3(0), target.positions.front()}) target.deltaBounds.add(shift);
      scene.meshes[0].morphWeights = scene.nodes[0].morphWeights = {0};
    }
    for (const render::TechniqueUse& use : uses()) {
      SCOPED_TRACE(std::string(use.plugin->info->name) + (morphs ? ", morphed" : ""));
      // Rounding of places decides on other clusters and charts, whose errors are some thousandths of the
      // light.
      expectFreshStart(scene, use);
    }
  }
}

/// Points of a body that moves as a whole, turns and is stretched a little are those of a fresh start.
TEST_F(SubsurfaceTechniqueTest, PointsFollowTheMatrixOfTheirBody) {
  using Path = scene::AnimationChannel::Path;
  scene::Scene scene = ball(0.1f);
  scene.nodes[0].matrix.reset();
  scene.nodes[0].transform.scale = {1.3f, 0.5f, 0.9f};
  scene::Animation& animation = scene.animations.emplace_back();
  animation.duration = 2;
  const auto add = [&](Path path, std::vector<float> values) {
    animation.channels.push_back(
        {path, scene::AnimationChannel::Interpolation::linear, 0, {0, 1}, std::move(values)});
  };
  const float half = std::sqrt(0.5f);
  add(Path::rotation, {0, 0, 0, 1, 0, 0, half, half});  // by a right angle about z
  add(Path::translation, {0, 0, 0, 0.2f, 0.4f, 0});
  add(Path::scale, {1.3f, 0.5f, 0.9f, 1.33f, 0.51f, 0.9f});
  // Areas stay as they were made, 4 % less.
  expectFreshStart(scene, technique("hierarchical_subsurface"));
}

/// The points that are asked for lie on a body's front, also where it has a back: twice as many elements then
/// take their slots. The ball's own vertices are more than half of them.
TEST_F(SubsurfaceTechniqueTest, BodiesWithTwoSidesHaveAsManyPointsOnTheirFronts) {
  const auto bytesOfPoints = [](bool doubleSided) {
    scene::Scene scene = ball(0.1f);
    scene.meshes[0].primitives[0] = test::spherePrimitive(1, 0, 16);  // 482 places
    scene.nodes[1].mesh = scene::kNone;
    scene.materials[0].doubleSided = doubleSided;
    render::Renderer renderer(device(), scene);
    drawn(renderer, {technique("hierarchical_subsurface", {{"points", "900"}})});
    int64_t bytes = 0;
    for (const frame::PassReport& pass : renderer.explain())
      for (const frame::AccessReport& access : pass.accesses)
        if (access.resource == "points of bodies") bytes = access.bytes;
    return bytes;
  };
  const auto oneSide = static_cast<double>(bytesOfPoints(false));
  EXPECT_GT(oneSide, 900.0 * 32);
  EXPECT_GT(static_cast<double>(bytesOfPoints(true)), 1.5 * oneSide);
}

/// Without translucent surfaces techniques are not asked, and pictures are the same in all bits.
TEST_F(SubsurfaceTechniqueTest, OpaqueScenesLeaveThemOut) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const Image without = picture(renderer, settings(32, 32, Term::final));
  for (const render::TechniqueUse& use : uses()) {
    SCOPED_TRACE(use.plugin->info->name);
    EXPECT_TRUE(
        std::ranges::equal(picture(renderer, settings(32, 32, Term::final, {use})).data(), without.data()));
    EXPECT_EQ(mean(picture(renderer, settings(32, 32, Term::subsurface, {use}))), 0);
    int passes = 0;
    for (const frame::PassReport& pass : renderer.explain())
      passes += pass.technique == use.plugin->info->name && pass.state == frame::PassState::run;
    EXPECT_EQ(passes, 0);
  }
}

/// Where nobody asks for light below surfaces, frames keep what they kept without the technique.
TEST_F(SubsurfaceTechniqueTest, UnaskedTheyLetFramesKeepResults) {
  for (const auto& [scene, term] :
       {std::pair(asset("cornell_box"), Term::final), std::pair(ball(0.1f), Term::direct)}) {
    render::Renderer renderer(device(), scene);
    for (const render::TechniqueUse& use : uses()) {
      SCOPED_TRACE(std::string(use.plugin->info->name) + ' ' + limn::name(term));
      render::Settings s = settings(32, 32, term, {technique("hard_shadow_map"), use});
      s.dynamic = false;
      renderer.configure(s);
      renderer.render();
      renderer.render();
      int kept = 0;
      for (const frame::PassReport& pass : renderer.explain())
        kept += pass.name.starts_with("shadow maps") && pass.state == frame::PassState::cached;
      EXPECT_EQ(kept, 1);
    }
  }
}

/// A translucent material that nothing is drawn with changes neither bits nor passes.
TEST_F(SubsurfaceTechniqueTest, MaterialsThatAreNotDrawnHaveNoPasses) {
  const scene::Scene without = asset("cornell_box");
  scene::Scene with = without;
  with.materials.push_back(ball(0.1f).materials[0]);
  const auto drawing = [&](const scene::Scene& scene, const std::vector<render::TechniqueUse>& techniques) {
    render::Renderer renderer(device(), scene);
    Image image = picture(renderer, settings(32, 32, Term::final, techniques));
    std::vector<std::string> passes;
    for (const frame::PassReport& pass : renderer.explain())
      if (pass.state == frame::PassState::run) passes.push_back(pass.name);
    return std::pair(std::move(image), std::move(passes));
  };
  const auto [image, passes] = drawing(without, {});
  std::vector<std::vector<render::TechniqueUse>> choices(1);
  for (const render::TechniqueUse& use : uses()) choices.push_back({use});
  for (const auto& techniques : choices) {
    SCOPED_TRACE(techniques.empty() ? "none" : techniques.front().plugin->info->name);
    const auto [same, ran] = drawing(with, techniques);
    EXPECT_EQ(ran, passes);
    EXPECT_TRUE(std::ranges::equal(same.data(), image.data()));
  }
}

}  // namespace
}  // namespace limn
