// A floor with height maps under one light, as tests of bumps draw it.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/tangents.h"
#include "tests/gpu/render_test.h"
#include "tests/support/test_scenes.h"

namespace limn {

/// Names the shapes of bump_horizon that say of each direction whether it is seen.
inline const std::vector<std::string> kShapes{"moments", "published", "horizon_map",
                                              "march",   "nearest",   "scan"};

class BumpFloorTest : public RenderTest {
 protected:
  static constexpr int kSide = 128;   ///< of pictures, pixels
  static constexpr int kTexels = 64;  ///< of the grooves

  /// A floor of 2 m x 2 m, one tile of `field`, under light that comes from `towards`.
  static scene::Scene floorUnder(const glm::vec3& towards, std::vector<relief::HeightField> fields) {
    scene::Scene scene;
    scene.heights = std::move(fields);
    scene::Material material;
    material.metallic = 0;
    material.specularFactor = 0;
    if (!scene.heights.empty()) material.height = 0;
    scene::Node node;
    node.mesh = test::addMesh(scene, test::floorPrimitive(1, test::addMaterial(scene, material)));
    scene.nodes.push_back(node);
    scene::LightSource light;
    light.type = glsl::light_directional;
    light.intensity = 2;
    scene::Node lamp;
    const glm::vec3 up = std::abs(towards.z) > 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    lamp.transform.rotation = glm::quatLookAt(-glm::normalize(towards), up);
    lamp.light = 0;
    scene.lights.push_back(light);
    scene.nodes.push_back(lamp);
    return scene;
  }

  /// Gives the floor's vertices the coordinates `uv` of theirs, and tangents that fit.
  static void moveCoordinates(scene::Scene& scene, const std::function<glm::vec2(const glm::vec2&)>& uv) {
    scene::Primitive& p = scene.meshes[0].primitives[0];
    for (glm::vec2& own : p.uvs) own = uv(own);
    p.tangents = scene::generateTangents(p.positions, p.normals, p.uvs, p.indices);
  }

  static scene::CameraPose camera() { return scene::lookAt({0, 2, 0.7f}, {0, 0, 0}, 0.7f); }

  Image drawn(const scene::Scene& scene, Term term, const std::vector<render::TechniqueUse>& techniques,
              std::vector<frame::PassReport>* passes = nullptr, const scene::CameraPose& from = camera()) {
    render::Renderer renderer(device(), scene);
    render::Settings asked = settings(kSide, kSide, term, techniques, term == Term::relief ? 0 : -1);
    asked.channels = true;
    Image seen = picture(renderer, std::move(asked), from);
    if (passes) *passes = renderer.explain();
    return seen;
  }

  static relief::HeightField flat() { return {{4, 4}, std::vector<float>(16, 0.3f), glm::dvec2(2)}; }

  /// V-shaped grooves with walls of 45 degrees across u, or across v: a crest at texel 0, a bottom in the
  /// middle.
  static relief::HeightField groove(bool acrossV = false) {
    std::vector<float> values;
    for (int i = 0; i < kTexels; ++i)
      values.push_back(2 * static_cast<float>(std::abs(i - kTexels / 2)) / kTexels);
    return {acrossV ? glm::ivec2(1, kTexels) : glm::ivec2(kTexels, 1), values, glm::dvec2(2)};
  }

  /// Calls f(value of the first channel, world position) for the pixels that show the floor.
  static void forEachPoint(const Image& picture, const std::function<void(float, const glm::vec3&)>& f) {
    scene::Bounds bounds;
    bounds.add({-1, 0, -1});
    bounds.add({1, 0, 1});
    glsl::FrameBlock frame{};
    scene::setCamera(frame, camera(), bounds, kSide, kSide);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const float depth = picture.at(x, y, picture.channel("Z"));
        if (depth <= 0) continue;
        const glm::vec3 ray(frame.view_ray_origin + static_cast<float>(x) * frame.view_ray_dx +
                            static_cast<float>(kSide - 1 - y) * frame.view_ray_dy);
        f(picture.at(x, y, 0), glm::vec3(frame.camera_position) + depth * ray);
      }
  }

  static bool same(const Image& a, const Image& b) { return std::ranges::equal(a.data(), b.data()); }
};

}  // namespace limn
