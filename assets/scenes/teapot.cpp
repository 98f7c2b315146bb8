// The Utah teapot from Newell's control points (M. Newell, "The Utilization of Procedure Models in Digital
// Image Synthesis", 1975): 32 bicubic Bezier patches. Body, lid and bottom are quarters of revolution and
// handle and spout are mirrored halves, so the published net is given by its profiles.
#include <array>

#include "assets/generator/shapes.h"
#include "assets/scenes/scenes.h"
#include "core/brdf/groove.h"

namespace limn::assets {
namespace {

constexpr int kGrooveTexels = 20;  ///< of each side of a table of grooves: 1 MB

using Patch = std::array<std::array<glm::vec3, 4>, 4>;

/// Rows of (radius, height); the control polygon of each quarter circle is stretched by `ratio`.
struct Revolution {
  glm::vec2 rows[4];
  float ratio;
};
constexpr Revolution kRevolutions[] = {
    {{{1.4f, 2.4f}, {1.3375f, 2.53125f}, {1.4375f, 2.53125f}, {1.5f, 2.4f}}, 0.56f},  // rim
    {{{1.5f, 2.4f}, {1.75f, 1.875f}, {2, 1.35f}, {2, 0.9f}}, 0.56f},                  // body, upper
    {{{2, 0.9f}, {2, 0.45f}, {1.5f, 0.225f}, {1.5f, 0.15f}}, 0.56f},                  // body, lower
    {{{0, 3.15f}, {0.8f, 3.15f}, {0, 2.85f}, {0.2f, 2.7f}}, 0.5625f},                 // knob
    {{{0.2f, 2.7f}, {0.4f, 2.55f}, {1.3f, 2.55f}, {1.3f, 2.4f}}, 0.56f},              // lid
    {{{1.5f, 0.15f}, {1.5f, 0.075f}, {1.425f, 0}, {0, 0}}, 0.56f},                    // bottom
};

/// Rows across a tube (handle or spout): the nearer and the farther point of its plane of symmetry as (x,
/// height), and half its width.
struct Tube {
  struct Row {
    glm::vec2 first, second;
    float halfWidth;
  } rows[4];
};
constexpr Tube kTubes[] = {
    {{{{-1.6f, 2.025f}, {-1.5f, 2.25f}, 0.3f},  // handle, upper
      {{-2.3f, 2.025f}, {-2.5f, 2.25f}, 0.3f},
      {{-2.7f, 2.025f}, {-3, 2.25f}, 0.3f},
      {{-2.7f, 1.8f}, {-3, 1.8f}, 0.3f}}},
    {{{{-2.7f, 1.8f}, {-3, 1.8f}, 0.3f},  // handle, lower
      {{-2.7f, 1.575f}, {-3, 1.35f}, 0.3f},
      {{-2.5f, 1.125f}, {-2.65f, 0.9375f}, 0.3f},
      {{-2, 0.9f}, {-1.9f, 0.6f}, 0.3f}}},
    {{{{1.7f, 1.425f}, {1.7f, 0.6f}, 0.66f},  // spout, lower
      {{2.6f, 1.425f}, {3.1f, 0.825f}, 0.66f},
      {{2.3f, 2.1f}, {2.4f, 2.025f}, 0.25f},
      {{2.7f, 2.4f}, {3.3f, 2.4f}, 0.25f}}},
    {{{{2.7f, 2.4f}, {3.3f, 2.4f}, 0.25f},  // spout, upper
      {{2.8f, 2.475f}, {3.525f, 2.49375f}, 0.25f},
      {{2.9f, 2.475f}, {3.45f, 2.5125f}, 0.15f},
      {{2.8f, 2.4f}, {3.2f, 2.4f}, 0.15f}}},
};

Patch quarter(const Revolution& shape, int turn) {
  Patch patch;
  for (int j = 0; j < 4; ++j) {
    const float r = shape.rows[j].x, y = shape.rows[j].y, k = shape.ratio * r;
    const glm::vec2 circle[] = {{r, 0}, {r, -k}, {k, -r}, {0, -r}};
    for (int i = 0; i < 4; ++i) {
      glm::vec2 p = circle[i];
      for (int n = 0; n < turn; ++n) p = {p.y, -p.x};
      patch[j][i] = {p.x, y, p.y};
    }
  }
  return patch;
}

Patch half(const Tube& tube, float side) {
  Patch patch;
  for (int j = 0; j < 4; ++j) {
    const Tube::Row& row = tube.rows[j];
    const glm::vec2 across[] = {row.first, row.first, row.second, row.second};
    for (int i = 0; i < 4; ++i) {
      patch[j][i] = {across[i].x, across[i].y, i == 1 || i == 2 ? side * row.halfWidth : 0};
    }
  }
  return patch;
}

glm::vec3 bezier(const std::array<glm::vec3, 4>& p, float t) {
  const float s = 1 - t;
  return s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3];
}

glm::vec3 evaluate(const Patch& patch, glm::vec2 uv) {
  return bezier(
      {bezier(patch[0], uv.x), bezier(patch[1], uv.x), bezier(patch[2], uv.x), bezier(patch[3], uv.x)}, uv.y);
}

Mesh teapot(int divisions) {
  Mesh mesh;
  const auto add = [&](const Patch& patch, bool flip) {
    append(mesh, surface(divisions, divisions, [&](glm::vec2 uv) {
             return evaluate(patch, flip ? glm::vec2(1 - uv.x, uv.y) : uv);
           }));
  };
  for (const Revolution& shape : kRevolutions) {
    for (int turn = 0; turn < 4; ++turn) add(quarter(shape, turn), true);
  }
  for (const Tube& tube : kTubes) {
    add(half(tube, -1), true);
    add(half(tube, 1), false);
  }
  return mesh;
}

/// A teapot of 32 patches of divisions^2 quads on a chequered floor, all Lambertian.
Scene patternScene(int divisions) {
  Scene scene;
  Material floor = lambert("floor", {1, 1, 1});
  floor.baseColourTexture = scene.addTexture(
      "tiles", tileImage(512, 4, {0.8f, 0.25f, 0.15f}, {0.2f, 0.4f, 0.75f}, {0.85f, 0.8f, 0.6f}));
  scene.add("floor", ground(0.9f, 0.9f, 0.9f), scene.addMaterial(floor));
  scene.add("teapot", transformed(teapot(divisions), rotation(-25, {0, 1, 0}) * scaling(glm::vec3(0.14f))),
            scene.addMaterial(lambert("glaze", {0.75f, 0.72f, 0.65f})));
  scene.addAreaLight("key", {-0.6f, 1.2f, 0.7f}, {0, 0.15f, 0}, {0.5f, 0.5f}, 6, {1, 0.97f, 0.92f});
  scene.addCamera("main", {0.25f, 0.65f, 1.35f}, {0, 0.17f, 0}, 34);
  scene.addCamera("close", {0.6f, 0.5f, 0.7f}, {0.1f, 0.2f, 0}, 34);
  return scene;
}

}  // namespace

Scene makeTeapotPattern() {
  return patternScene(10);  // 3872 vertices
}

Scene makeTeapotCoarse() {
  return patternScene(4);  // 800 vertices
}

// After the teapot of Heidrich and Seidel 1999: blue seen from one side, red from the other.
Scene makeTeapotGroove() {
  Scene scene;
  scene.add("floor", backdrop(3, 2, 1.6f, 2, 1.2f), scene.addMaterial(lambert("floor", {0.6f, 0.6f, 0.62f})));
  Mesh pot = transformed(teapot(20), scaling(glm::vec3(0.1f)));
  computeTangents(pot);  // around body and limbs: the grooves run along them
  const int grooves =
      scene.addMeasured("grooves", brdf::GrooveBrdf(brdf::Groove{}).table(kGrooveTexels), {0.3f, 0.1f, 0.3f});
  scene.materials[static_cast<std::size_t>(grooves)].doubleSided = true;  // the lid leaves a gap
  const int node = scene.add("teapot", std::move(pot), grooves);
  scene.nodes[static_cast<std::size_t>(node)].rotation =
      glm::angleAxis(glm::radians(-25.0f), glm::vec3(0, 1, 0));
  scene.addAreaLight("key", {-0.9f, 1.3f, 0.7f}, {0, 0.1f, 0}, {0.5f, 0.5f}, 10, {1, 0.97f, 0.92f});
  scene.addLight("lamp", {.colour = {0.9f, 0.95f, 1}, .intensity = 0.7f}, {0.7f, 0.9f, 0.8f}, {0, 0.1f, 0});
  scene.addCamera("main", {0.12f, 0.52f, 1.25f}, {0, 0.13f, 0}, 34);
  scene.addCamera("close", {0.45f, 0.38f, 0.55f}, {0.1f, 0.16f, 0}, 36);
  return scene;
}

Scene makeTeapot() {
  Scene scene;
  Material wood = glossy("wood", {1, 1, 1}, 0.6f);
  wood.baseColourTexture =
      scene.addTexture("wood", woodImage(1024, 6, {0.46f, 0.28f, 0.15f}, {0.2f, 0.1f, 0.045f}));
  scene.add("floor", backdrop(3, 2, 1.6f, 2, 1.2f), scene.addMaterial(wood));
  Material glaze = glossy("glaze", {0.72f, 0.68f, 0.58f}, 0.4f);
  glaze.doubleSided = true;  // the lid leaves a gap through which the inside shows
  // Newell's net stands 3.15 units high without the 1.3 squash of later copies; here the pot is 0.3 m high.
  const int pot =
      scene.add("teapot", transformed(teapot(20), scaling(glm::vec3(0.1f))), scene.addMaterial(glaze));
  scene.nodes[static_cast<std::size_t>(pot)].rotation =
      glm::angleAxis(glm::radians(-25.0f), glm::vec3(0, 1, 0));
  scene.addAreaLight("key", {-0.9f, 1.3f, 0.7f}, {0, 0.1f, 0}, {0.5f, 0.5f}, 12, {1, 0.95f, 0.88f}, 52);
  scene.addCamera("main", {0.12f, 0.52f, 1.25f}, {0, 0.13f, 0}, 34);
  scene.addCamera("close", {0.45f, 0.38f, 0.55f}, {0.1f, 0.16f, 0}, 36);
  return scene;
}

}  // namespace limn::assets
