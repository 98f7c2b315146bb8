// What reflection models look like: metals, brushed metal, dielectrics of three indices, a glossy torus. Few
// lights, but of each kind: a point or the sun shows a lobe alone, a rectangle lights what lobes do not
// reach.
#include <array>
#include <iterator>
#include <string>

#include "assets/generator/shapes.h"
#include "assets/scenes/metals.h"
#include "assets/scenes/scenes.h"
#include "core/brdf/groove.h"

namespace limn::assets {
namespace {

void addBackdrop(Scene& scene, glm::vec3 albedo) {
  scene.add("floor", backdrop(4.5f, 3, 2.2f, 3.6f, 1), scene.addMaterial(lambert("floor", albedo)));
}

/// The mesh as a node that is moved, and turned about the X axis.
void place(Scene& scene, std::string name, Mesh mesh, int material, glm::vec3 position, float tilt = 0) {
  Node& node = scene.nodes[static_cast<std::size_t>(scene.add(std::move(name), std::move(mesh), material))];
  node.translation = position;
  if (tilt != 0) node.rotation = glm::angleAxis(glm::radians(tilt), glm::vec3(1, 0, 0));
}

/// A sun as narrow as a point.
void addSun(Scene& scene, std::string name, float irradiance, glm::vec3 colour, glm::vec3 towards) {
  scene.addLight(std::move(name),
                 {.type = Light::Type::directional, .colour = colour, .intensity = irradiance}, {0, 3, 0},
                 glm::vec3(0, 3, 0) + towards);
}

void addLamp(Scene& scene, float intensity, glm::vec3 colour, glm::vec3 position) {
  scene.addLight("lamp", {.colour = colour, .intensity = intensity}, position, {0, 0, 0});
}

}  // namespace

Scene makeTorusMetal() {
  Scene scene;
  addBackdrop(scene, {0.6f, 0.6f, 0.62f});
  const auto metal = [&](const char* name, float m, glm::vec3 eta, glm::vec3 k) {
    return scene.addMaterial(
        reflecting(name, {.model = "torrance_sparrow", .roughness = glm::vec2(m), .eta = eta, .k = k}));
  };
  // Tilted by 50 degrees; the lowest point is at radius sin 50 + tube below the centre.
  constexpr float radius = 0.4f, tube = 0.16f, height = 0.467f;
  const Mesh ring = torus(radius, tube, 200, 200);
  place(scene, "copper", ring, metal("copper", 0.1f, kCopperEta, kCopperK), {-0.64f, height, 0}, 50);
  place(scene, "aluminium", ring, metal("aluminium", 0.05f, kAluminiumEta, kAluminiumK), {0.64f, height, 0},
        50);
  scene.addAreaLight("key", {-1.5f, 2.6f, 1.8f}, {0, 0.4f, 0}, {2.4f, 1.8f}, 6.5f, {1, 0.96f, 0.9f});
  addSun(scene, "sun", 0.3f, {1, 0.95f, 0.85f}, {-0.8f, -1, -0.5f});
  addSun(scene, "rim", 0.2f, {0.75f, 0.85f, 1}, {0.5f, -0.9f, 0.8f});
  addSun(scene, "fill", 0.15f, {0.9f, 0.95f, 1}, {-0.9f, -0.35f, 0.1f});
  addLamp(scene, 0.4f, {1, 0.85f, 0.7f}, {0, 1.3f, 1.2f});
  scene.addCamera("main", {0, 1.3f, 3}, {0, 0.45f, 0}, 36);
  scene.addCamera("close", {-0.5f, 0.9f, 1.7f}, {-0.5f, 0.45f, 0}, 40);
  return scene;
}

Scene makeDiskAndSphere() {
  Scene scene;
  addBackdrop(scene, {0.6f, 0.6f, 0.62f});
  // Along its grooves brushed metal is smoother than across them.
  const auto aluminium = [&](const char* name, glm::vec2 roughness) {
    return scene.addMaterial(
        reflecting(name, {.model = "ward", .roughness = roughness, .eta = kAluminiumEta, .k = kAluminiumK}));
  };
  const int plain = aluminium("plain", {0.2f, 0.2f}), brushed = aluminium("brushed", {0.06f, 0.35f});
  const int silk = scene.addMaterial(reflecting("silk", {.model = "banks",
                                                         .kd = glm::vec3(0.2f, 0.04f, 0.05f),
                                                         .ks = glm::vec3(0.45f, 0.32f, 0.3f),
                                                         .exponent = 32.f}));
  constexpr std::array<glm::vec2, 5> plate{{{0, 0}, {0.44f, 0}, {0.45f, 0.01f}, {0.44f, 0.02f}, {0, 0.02f}}};
  const Mesh disk = lathe(plate, 256), ball = sphere(0.2f, 64);
  const struct {
    const char* name;
    void (*brush)(Mesh&);
    int material;
  } columns[] = {{"isotropic", nullptr, plain},
                 {"circular", brushAlongCircles, brushed},
                 {"radial", brushAlongRadii, brushed}};
  float x = -1;
  for (const auto& column : columns) {
    Mesh leaning = disk, standing = ball;
    if (column.brush != nullptr) {
      column.brush(leaning);
      column.brush(standing);
    }
    const std::string name = column.name;
    place(scene, name + "_disk", std::move(leaning), column.material, {x, 0.4f, -0.2f}, 60);
    place(scene, name + "_sphere", std::move(standing), column.material, {x, 0.2f, 0.6f}, 0);
    x += 1;
  }
  Mesh spool = sphere(0.13f, 48);
  brushAlongCircles(spool);
  place(scene, "silk_sphere", std::move(spool), silk, {0.5f, 0.13f, 0.85f}, 20);
  scene.addAreaLight("key", {-2.2f, 3.2f, 0.8f}, {0, 0.3f, 0}, {1.2f, 1.2f}, 7, {1, 0.96f, 0.9f});
  addSun(scene, "sun", 0.3f, {1, 0.95f, 0.85f}, {0.9f, -1, -0.6f});
  addLamp(scene, 0.9f, {0.8f, 0.9f, 1}, {1.2f, 1.6f, 1.6f});
  scene.addCamera("main", {0, 1.2f, 3.5f}, {0, 0.38f, 0.1f}, 34);
  scene.addCamera("close", {0, 0.9f, 2.2f}, {0, 0.35f, 0}, 36);
  return scene;
}

Scene makeFresnelSpheres() {
  Scene scene;
  addBackdrop(scene, {0.38f, 0.38f, 0.4f});
  const int stone = scene.addMaterial(lambert("stone", {0.3f, 0.3f, 0.32f}));
  constexpr float radius = 0.24f, step = 0.26f, depth = 0.6f;
  constexpr glm::vec3 paint{0.5f, 0.08f, 0.05f};
  // Indices from left to right; models on steps, the first in front. Phong's lobe, which knows no index, has
  // the reflectance at normal incidence; what the lobe leaves goes to the diffuse part. A coat mirrors, and
  // shows of lights only what it leaves to its base.
  constexpr struct {
    const char* name;
    float n, x;
  } columns[] = {{"1.5", 1.5f, -0.62f}, {"5", 5, 0}, {"200", 200, 0.62f}};
  for (const auto& [index, n, x] : columns) {
    const float root = (n - 1) / (n + 1), f0 = root * root;
    const ReflectionModel models[] = {
        {.model = "torrance_sparrow",
         .roughness = glm::vec2(0.1f),
         .eta = glm::vec3(n),
         .kd = paint * (1 - f0)},
        {.model = "phong", .kd = paint * (1 - f0), .ks = glm::vec3(f0), .exponent = 49.5f},
        {.model = "coated", .eta = glm::vec3(n), .kd = paint, .combine = "blend"}};
    for (std::size_t row = 0; row < std::size(models); ++row) {
      const std::string name = models[row].model + "_" + index;
      place(scene, name, sphere(radius, 48), scene.addMaterial(reflecting(name, models[row])),
            {x, radius + step * static_cast<float>(row), 0.6f - depth * static_cast<float>(row)});
    }
  }
  Mesh stairs = box({0, step / 2, 0.6f - depth}, {1.05f, step / 2, depth / 2});
  append(stairs, box({0, step, 0.6f - 2 * depth}, {1.05f, step, depth / 2}));
  scene.add("stairs", std::move(stairs), stone);
  scene.addAreaLight("key", {-1.4f, 2.8f, 2}, {0, 0.4f, 0}, {0.8f, 0.8f}, 12, {1, 0.96f, 0.9f});
  addSun(scene, "sun", 1, {1, 0.95f, 0.85f}, {-0.9f, -1, -0.8f});
  // From behind: what grazes a sphere shows Fresnel's rise.
  addSun(scene, "rim", 0.5f, {0.8f, 0.9f, 1}, {-0.6f, -0.45f, 1});
  scene.addCamera("main", {0, 1.5f, 3.1f}, {0, 0.45f, 0}, 34);
  scene.addCamera("close", {-0.6f, 0.8f, 1.9f}, {-0.3f, 0.3f, 0.3f}, 40);
  return scene;
}

// Grooves of 20, 45 and 65 degrees, in two colours and in black and white: what no model of few numbers has.
Scene makeMeasuredSpheres() {
  Scene scene;
  addBackdrop(scene, {0.55f, 0.55f, 0.57f});
  constexpr struct {
    const char* name;
    float degrees;
    glm::vec3 rising, falling;
  } rows[] = {{"two_colours", 45, {0.1f, 0.15f, 0.8f}, {0.8f, 0.1f, 0.1f}},
              {"gold_and_green", 20, {0.9f, 0.6f, 0.1f}, {0.1f, 0.5f, 0.3f}},
              {"black_and_white", 65, {0.02f, 0.02f, 0.02f}, {0.95f, 0.95f, 0.95f}}};
  constexpr int texels = 16;
  float x = -0.66f;
  for (const auto& row : rows) {
    const brdf::GrooveBrdf grooves(
        {.slope = glm::radians(row.degrees), .rising = row.rising, .falling = row.falling, .strips = 48});
    const int material =
        scene.addMeasured(row.name, grooves.table(texels), 0.5f * (row.rising + row.falling));
    Mesh upright = sphere(0.3f, 64), small = sphere(0.16f, 48);
    brushAlongCircles(upright);
    brushAlongRadii(small);
    const std::string name = row.name;
    place(scene, name, std::move(upright), material, {x, 0.3f, 0});
    place(scene, name + "_radial", std::move(small), material, {x, 0.16f, 0.55f}, 40);
    x += 0.66f;
  }
  scene.addAreaLight("key", {-1.5f, 2.6f, 1.8f}, {0, 0.3f, 0}, {0.8f, 0.8f}, 9, {1, 0.96f, 0.9f});
  addSun(scene, "sun", 0.5f, {1, 0.95f, 0.85f}, {-0.8f, -1, -0.5f});
  addLamp(scene, 0.8f, {1, 0.85f, 0.7f}, {0.3f, 1.5f, 1.2f});
  scene.addCamera("main", {0, 1.1f, 2.7f}, {0, 0.27f, 0.1f}, 34);
  scene.addCamera("close", {-0.5f, 0.8f, 1.6f}, {-0.35f, 0.25f, 0.1f}, 40);
  return scene;
}

Scene makeGlossyTorus() {
  Scene scene;
  addBackdrop(scene, {0.55f, 0.55f, 0.57f});
  // The roughness 0.01 of Heidrich and Seidel 1999: Phong's exponent is its inverse.
  const int lacquer = scene.addMaterial(reflecting(
      "lacquer",
      {.model = "phong", .kd = glm::vec3(0.04f, 0.2f, 0.3f), .ks = glm::vec3(0.5f), .exponent = 100.f}));
  place(scene, "torus", torus(0.5f, 0.2f, 128, 64), lacquer, {0, 0.583f, 0}, 50);
  place(scene, "sphere", sphere(0.2f, 64), lacquer, {0.78f, 0.2f, 0.55f});
  scene.addAreaLight("key", {-1.5f, 2.6f, 1.8f}, {0, 0.4f, 0}, {0.8f, 0.8f}, 9, {1, 0.96f, 0.9f});
  addSun(scene, "sun", 0.5f, {1, 0.95f, 0.85f}, {-0.8f, -1, -0.5f});
  addSun(scene, "rim", 0.3f, {0.75f, 0.85f, 1}, {0.5f, -0.9f, 0.8f});
  addLamp(scene, 0.8f, {1, 0.85f, 0.7f}, {0.3f, 1.5f, 1.2f});
  scene.addCamera("main", {0.2f, 1.5f, 3.3f}, {0.08f, 0.45f, 0}, 34);
  scene.addCamera("close", {-0.3f, 1, 1.8f}, {-0.1f, 0.5f, 0}, 40);
  return scene;
}

}  // namespace limn::assets
