// Things on a patterned floor: chess pieces, and a glossy sphere.
#include "assets/generator/shapes.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

/// A turned piece: (radius, height) from the foot to the tip, in metres of a piece 0.2 m wide.
Mesh turned(std::initializer_list<glm::vec2> outline, float height, int segments) {
  std::vector<glm::vec2> points{{0, 0}, {0.1f, 0}, {0.1f, 0.03f}, {0.075f, 0.05f}, {0.06f, 0.07f}};
  for (const glm::vec2& p : outline) points.emplace_back(p.x, p.y * height);
  return lathe(points, segments, 60);
}

Mesh pawn() {
  return turned({{0.04f, 0.3f},
                 {0.032f, 0.5f},
                 {0.035f, 0.62f},
                 {0.065f, 0.65f},
                 {0.04f, 0.68f},
                 {0.055f, 0.74f},
                 {0.06f, 0.82f},
                 {0.05f, 0.92f},
                 {0.025f, 0.985f},
                 {0, 1}},
                0.32f, 28);
}

Mesh rook() {
  return turned({{0.05f, 0.3f},
                 {0.045f, 0.5f},
                 {0.045f, 0.66f},
                 {0.075f, 0.72f},
                 {0.075f, 0.85f},
                 {0.075f, 1},
                 {0.05f, 1},
                 {0.05f, 0.9f},
                 {0, 0.9f}},
                0.36f, 28);
}

Mesh bishop() {
  return turned({{0.045f, 0.25f},
                 {0.035f, 0.45f},
                 {0.035f, 0.6f},
                 {0.065f, 0.63f},
                 {0.04f, 0.66f},
                 {0.055f, 0.74f},
                 {0.055f, 0.8f},
                 {0.035f, 0.9f},
                 {0.015f, 0.94f},
                 {0.022f, 0.97f},
                 {0, 1}},
                0.46f, 28);
}

}  // namespace

Scene makeChess() {
  Scene scene;
  Material board = lambert("board", {1, 1, 1});
  board.baseColourTexture = scene.addTexture(
      "board", tileImage(512, 6, {0.85f, 0.8f, 0.7f}, {0.2f, 0.45f, 0.2f}, {0.3f, 0.25f, 0.2f}));
  scene.add("board", ground(0.9f, 0.9f, 1.8f), scene.addMaterial(board));
  const int white = scene.addMaterial(lambert("ivory", {0.8f, 0.78f, 0.7f})),
            black = scene.addMaterial(lambert("grey", {0.3f, 0.3f, 0.3f}));
  const Mesh shapes[] = {pawn(), rook(), bishop()};
  const struct {
    int shape;
    bool light;
    float x, z;
  } pieces[] = {{0, true, -0.45f, 0.15f},  {1, true, -0.15f, 0.45f},  {2, false, 0.15f, 0.15f},
                {0, false, 0.45f, -0.15f}, {2, true, -0.15f, -0.45f}, {1, false, 0.45f, 0.45f}};
  for (const auto& piece : pieces)
    scene.add("piece", transformed(shapes[piece.shape], translation({piece.x, 0, piece.z})),
              piece.light ? white : black);
  scene.addAreaLight("key", {-0.8f, 1.4f, 0.9f}, {0, 0.1f, 0}, {0.7f, 0.7f}, 9, {1, 0.97f, 0.92f});
  scene.addCamera("main", {0.95f, 0.8f, 1.2f}, {0, 0.15f, 0}, 36);
  scene.addCamera("close", {0.5f, 0.4f, 0.8f}, {0, 0.15f, 0}, 32);
  return scene;
}

Scene makeGlossySphere() {
  Scene scene;
  Material floor = lambert("floor", {1, 1, 1});
  floor.baseColourTexture = scene.addTexture(
      "tiles", tileImage(512, 4, {0.85f, 0.25f, 0.15f}, {0.2f, 0.4f, 0.8f}, {0.9f, 0.85f, 0.6f}));
  scene.add("floor", ground(1.4f, 1.4f, 1.4f), scene.addMaterial(floor));
  scene.add("sphere", transformed(sphere(0.45f, 32), translation({0, 0.47f, 0})),
            scene.addMaterial(glossy("satin", {0.9f, 0.85f, 0.75f}, 0.5f, 1)));
  scene.addAreaLight("key", {-1.1f, 1.9f, 1.1f}, {0, 0.4f, 0}, {0.8f, 0.8f}, 16, {1, 0.97f, 0.92f});
  scene.addCamera("main", {0.9f, 0.95f, 1.9f}, {0, 0.4f, 0}, 34);
  scene.addCamera("close", {0.6f, 0.6f, 1.2f}, {0, 0.4f, 0}, 36);
  return scene;
}

}  // namespace limn::assets
