// Planes with height maps, for tests of the reference.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "core/relief/height_field.h"
#include "core/scene/tangents.h"
#include "tests/support/reference_scene.h"

namespace limn::reference::test {

constexpr int kSide = 32;  ///< of pictures, pixels

/// A square of side 2 `half` around the origin of the plane z = 0, seen from +Z, with texture coordinates by
/// place. Its bumps do not turn its normals, so that only W tells it from a flat one.
struct Plane {
  float half = 1;
  /// v falls with y.
  std::function<glm::vec2(glm::vec2)> uv = [](const glm::vec2& p) { return glm::vec2(p.x, -p.y); };
  glm::mat4 matrix{1};
  bool doubleSided = false;
};

/// Adds a material with that map, and with a normal map of no effect.
inline int addMap(World& world, const relief::HeightField& field, bool doubleSided = false) {
  const int number = world.addMaterial(glm::vec3(0.5f), doubleSided);
  scene::Material& material = world.scene.materials.back();
  if (world.scene.images.empty()) {
    scene::TextureImage& white = world.scene.images.emplace_back();
    white.levels.push_back({.width = 1, .height = 1, .rgba = std::vector<uint8_t>(4, 255)});
  }
  material.normalTexture.image = 0;
  material.normalScale = 0;
  material.height = static_cast<int>(world.scene.heights.size());
  world.scene.heights.push_back(field);
  return number;
}

inline void completeTangents(scene::Primitive& p) {
  p.tangents = scene::generateTangents(p.positions, p.normals, p.uvs, p.indices);
}

inline void addPlane(World& world, const relief::HeightField& field, const Plane& plane) {
  scene::Primitive p = World::quad(glm::vec3(0), {2 * plane.half, 0, 0}, {0, 2 * plane.half, 0},
                                   addMap(world, field, plane.doubleSided));
  for (size_t i = 0; i < p.uvs.size(); ++i) p.uvs[i] = plane.uv(glm::vec2(p.positions[i]));
  completeTangents(p);
  world.addInstance(world.addMesh(std::move(p)), plane.matrix);
}

inline World planeWorld(const relief::HeightField& field, const Plane& plane = {}) {
  World world;
  addPlane(world, field, plane);
  const glm::mat3 turned(plane.matrix);
  world.camera = scene::lookAt(turned[2] * (2.4f * plane.half), glm::vec3(0), 0.8f);
  return world;
}

/// Returns the world without its height maps.
inline World flattened(World world) {
  for (auto& material : world.scene.materials) material.height = scene::kNone;
  return world;
}

/// Leaves one light, far away in the direction `towards`.
inline void shineFrom(World& world, const glm::vec3& towards) {
  world.pose.lights.clear();
  world.pose.lightNames.clear();
  world.addLight(glsl::light_directional, glm::vec3(0), -towards, glm::vec3(1));
}

/// Returns the picture of the first light's W.
inline Image reliefOf(const World& world, int spp = 2) {
  Request request = world.request(kSide, Term::relief, spp);
  request.light = 0;
  return render(request).image;
}

/// Heights that rise along u or v by `slope` metres per metre between the first and the last texel of a tile
/// of 2 m, and are level beyond them; negative: that fall.
inline relief::HeightField ramp(int axis, double slope) {
  constexpr int texels = 64;
  std::vector<float> values(texels);
  for (size_t i = 0; i < texels; ++i) values[i] = 2.f / texels * static_cast<float>(i);
  const glm::ivec2 size = axis == 0 ? glm::ivec2(texels, 1) : glm::ivec2(1, texels);
  return {size, values, glm::dvec2(2), slope, 0, relief::Wrap::clamped};
}

}  // namespace limn::reference::test
