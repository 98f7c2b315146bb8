// A closed room that a row of pillars, from thick to thin, divides into a hall and an aisle. The aisle's only
// light comes off the hall's lit wall, past the pillars.
#include <iterator>

#include "assets/generator/shapes.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

constexpr float kHalfWidth = 1.8f, kHeight = 1.8f, kHall = -1.2f,
                kAisle = 0.9f;  ///< metres; pillars at z = 0
constexpr float kPillarWidths[] = {0.4f, 0.3f, 0.2f, 0.12f, 0.06f};

/// Six walls seen from inside. Nothing outside of them gives or takes light.
void addRoom(Scene& scene) {
  const float middle = 0.5f * (kHall + kAisle), halfDepth = 0.5f * (kAisle - kHall);
  const float halfHeight = 0.5f * kHeight;
  Mesh room = quad({0, 0, middle}, {kHalfWidth, 0, 0}, {0, 0, -halfDepth});
  append(room, quad({0, kHeight, middle}, {kHalfWidth, 0, 0}, {0, 0, halfDepth}));
  append(room, quad({0, halfHeight, kHall}, {kHalfWidth, 0, 0}, {0, halfHeight, 0}));
  append(room, quad({0, halfHeight, kAisle}, {-kHalfWidth, 0, 0}, {0, halfHeight, 0}));
  scene.add("room", std::move(room), scene.addMaterial(lambert("plaster", {0.73f, 0.72f, 0.68f})));
  scene.add("left_wall", quad({-kHalfWidth, halfHeight, middle}, {0, 0, -halfDepth}, {0, halfHeight, 0}),
            scene.addMaterial(lambert("terracotta", {0.6f, 0.3f, 0.2f})));
  scene.add("right_wall", quad({kHalfWidth, halfHeight, middle}, {0, 0, halfDepth}, {0, halfHeight, 0}),
            scene.addMaterial(lambert("slate", {0.3f, 0.42f, 0.5f})));
}

/// The gaps between the pillars, and between them and the walls, are equal.
Mesh pillars() {
  float gap = 2 * kHalfWidth;
  for (const float width : kPillarWidths) gap -= width;
  gap /= static_cast<float>(std::size(kPillarWidths)) + 1;
  Mesh mesh;
  float left = -kHalfWidth;
  for (const float width : kPillarWidths) {
    left += gap;
    append(mesh, box({left + 0.5f * width, 0.5f * kHeight, 0}, 0.5f * glm::vec3(width, kHeight, width)));
    left += width;
  }
  return mesh;
}

}  // namespace

Scene makeColonnade() {
  Scene scene;
  addRoom(scene);
  scene.add("pillars", pillars(), scene.addMaterial(lambert("stone", {0.72f, 0.7f, 0.66f})));
  // Its cone ends within the hall's wall, on a disc of 1.6 m: narrow enough for the pillars to cast shadows
  // with edges close to them, and wide enough for a path tracer to find.
  const Light spot{.type = Light::Type::spot,
                   .colour = {1, 0.93f, 0.82f},
                   .intensity = 12,
                   .innerConeAngle = glm::radians(32.0f),
                   .outerConeAngle = glm::radians(41.0f)};
  scene.addLight("key", spot, {0.1f, 0.9f, -0.3f}, {0.1f, 0.9f, kHall});
  // Through the pillars to what is lit; at the pillars' feet; along the aisle, where all light comes past
  // them.
  scene.addCamera("main", {-0.05f, 1.1f, 0.85f}, {0, 0.72f, kHall}, 62);
  scene.addCamera("close", {-1.1f, 0.6f, 0.78f}, {0.2f, 0.02f, 0}, 50);
  scene.addCamera("aisle", {-1.65f, 1.15f, 0.3f}, {0.2f, 0.5f, 0.95f}, 58);
  return scene;
}

}  // namespace limn::assets
