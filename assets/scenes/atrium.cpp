// A courtyard of two storeys: a colonnade of fluted columns, arches, a balustrade above, a fountain, banners.
#include "assets/scenes/atrium.h"

#include <cmath>
#include <tuple>

#include "assets/generator/shapes.h"
#include "assets/generator/simplify.h"
#include "assets/scenes/atrium_parts.h"
#include "assets/scenes/scenes.h"

namespace limn::assets {
namespace {

using namespace atrium;

constexpr float kHalfX = 6, kHalfZ = 3, kBay = 2, kDepth = 0.5f;                // column axes
constexpr float kSpring = 3.0f, kFloor2 = 4.7f, kSpring2 = 6.95f, kTop = 8.3f;  // heights
constexpr float kWallX = 8.7f, kWallZ = 5.7f;

struct Place {
  glm::vec3 at;
  float degrees;  ///< 0 where the bay runs along X
};

/// The middles of the bays (offset 0) or the columns (offset 0.5) around the court.
std::vector<Place> bays() {
  std::vector<Place> places;
  for (const float sign : {-1.0f, 1.0f}) {
    for (float x = -kHalfX + kBay / 2; x < kHalfX; x += kBay) places.push_back({{x, 0, sign * kHalfZ}, 0});
    for (float z = -kHalfZ + kBay / 2; z < kHalfZ; z += kBay) places.push_back({{sign * kHalfX, 0, z}, 90});
  }
  return places;
}

std::vector<glm::vec3> columnAxes() {
  std::vector<glm::vec3> axes;
  for (const float sign : {-1.0f, 1.0f}) {
    for (float x = -kHalfX; x < kHalfX + 0.1f; x += kBay) axes.emplace_back(x, 0, sign * kHalfZ);
    for (float z = -kHalfZ + kBay; z < kHalfZ - 0.1f; z += kBay) axes.emplace_back(sign * kHalfX, 0, z);
  }
  return axes;
}

void place(Scene& scene, const std::string& name, Mesh mesh, int material, const std::vector<Place>& places) {
  std::vector<Primitive> primitives;
  primitives.push_back({std::move(mesh), material});
  const int index = scene.addMesh(name, std::move(primitives));
  for (const Place& p : places) {
    Node node{.name = name, .translation = p.at, .mesh = index};
    if (p.degrees != 0) node.rotation = glm::angleAxis(glm::radians(p.degrees), glm::vec3(0, 1, 0));
    scene.addNode(std::move(node));
  }
}

std::vector<Place> raised(std::vector<Place> places, float height) {
  for (Place& p : places) p.at.y += height;
  return places;
}

/// The ring between the colonnade and the outer wall, as four boxes.
Mesh gallerySlab(float bottom, float top) {
  const float innerX = kHalfX - kDepth / 2, innerZ = kHalfZ - kDepth / 2, y = (bottom + top) / 2,
              h = (top - bottom) / 2;
  Mesh mesh;
  for (const float sign : {-1.0f, 1.0f}) {
    append(mesh, box({0, y, sign * (innerZ + kWallZ) / 2}, {kWallX, h, (kWallZ - innerZ) / 2}));
    append(mesh, box({sign * (innerX + kWallX) / 2, y, 0}, {(kWallX - innerX) / 2, h, innerZ}));
  }
  return mesh;
}

/// The outer walls from inside, with pilasters, dado and blind arches.
Mesh outerWalls() {
  Mesh mesh;
  for (const float sign : {-1.0f, 1.0f}) {
    Mesh longWall = quad({0, kTop / 2, sign * kWallZ}, {-sign * kWallX, 0, 0}, {0, kTop / 2, 0});
    Mesh shortWall = quad({sign * kWallX, kTop / 2, 0}, {0, 0, sign * kWallZ}, {0, kTop / 2, 0});
    scaleUv(longWall, {2 * kWallX, kTop});
    scaleUv(shortWall, {2 * kWallZ, kTop});
    append(mesh, longWall);
    append(mesh, shortWall);
  }
  const glm::vec2 dado[] = {{0, 0},        {0.08f, 0},     {0.08f, 0.8f}, {0.12f, 0.84f},
                            {0.12f, 0.9f}, {0.06f, 0.95f}, {0, 0.95f}};
  const glm::vec2 skirting[] = {
      {0, kFloor2}, {0.06f, kFloor2}, {0.06f, kFloor2 + 0.25f}, {0.03f, kFloor2 + 0.3f}, {0, kFloor2 + 0.3f}};
  append(mesh, cornice(dado, kWallX, kWallZ));
  append(mesh, cornice(skirting, kWallX, kWallZ));
  for (const auto& [bottom, height, radius] :
       {std::tuple{0.95f, 2.2f, 0.72f}, {kFloor2 + 0.3f, 1.6f, 0.6f}}) {
    for (const Place& bay : bays()) {
      const bool alongX = bay.degrees == 0;
      const glm::vec3 out =
          alongX ? glm::vec3(0, 0, bay.at.z > 0 ? 1 : -1) : glm::vec3(bay.at.x > 0 ? 1 : -1, 0, 0);
      const glm::vec3 side = alongX ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
      const glm::vec3 foot =
          glm::vec3(alongX ? bay.at.x : out.x * kWallX, bottom, alongX ? out.z * kWallZ : bay.at.z);
      std::vector<glm::vec3> path = {foot - side * radius,
                                     foot - side * radius + glm::vec3(0, height - 0.02f, 0)};
      for (int i = 0; i <= 16; ++i) {
        const float a = 3.14159265f * static_cast<float>(i) / 16;
        path.push_back(foot + glm::vec3(0, height, 0) - side * radius * std::cos(a) +
                       glm::vec3(0, radius * std::sin(a), 0));
      }
      path.push_back(foot + side * radius);
      append(mesh, tube(path, std::vector<float>(path.size(), 0.06f), 8, false));
    }
  }
  return mesh;
}

Mesh courtMouldings() {
  const float x = kHalfX - kDepth / 2, z = kHalfZ - kDepth / 2;
  const glm::vec2 lower[] = {{0, 4.25f},    {0.03f, 4.25f}, {0.03f, 4.32f}, {0.06f, 4.36f}, {0.09f, 4.45f},
                             {0.2f, 4.52f}, {0.22f, 4.58f}, {0.22f, 4.66f}, {0.18f, 4.7f},  {0, 4.7f}};
  const glm::vec2 upper[] = {{0, 7.95f},    {0.03f, 7.95f}, {0.03f, 8.02f}, {0.07f, 8.06f}, {0.1f, 8.14f},
                             {0.26f, 8.2f}, {0.28f, 8.26f}, {0.28f, 8.38f}, {0.2f, 8.45f},  {0, 8.45f}};
  Mesh mesh = cornice(lower, x, z);
  append(mesh, cornice(upper, x, z));
  // Dentils under the upper cornice.
  for (float at = -x + 0.15f; at < x; at += 0.3f) {
    for (const float sign : {-1.0f, 1.0f})
      append(mesh, box({at, 8.06f, sign * (z - 0.09f)}, {0.07f, 0.05f, 0.08f}));
  }
  for (float at = -z + 0.2f; at < z; at += 0.3f) {
    for (const float sign : {-1.0f, 1.0f})
      append(mesh, box({sign * (x - 0.09f), 8.06f, at}, {0.08f, 0.05f, 0.07f}));
  }
  for (const float sx : {-1.0f, 1.0f}) {  // the corners between the arched walls
    for (const float sz : {-1.0f, 1.0f}) {
      append(mesh, box({sx * kHalfX, (kSpring + 4.7f) / 2, sz * kHalfZ}, {0.249f, 0.85f, 0.249f}));
      append(mesh,
             box({sx * kHalfX, (kSpring2 + kTop) / 2, sz * kHalfZ}, {0.249f, (kTop - kSpring2) / 2, 0.249f}));
    }
  }
  return mesh;
}

template <class Reduced>
void addBanners(Scene& scene, const Reduced& reduced) {
  const std::pair<const char*, glm::vec3> colours[] = {
      {"red", {0.5f, 0.05f, 0.04f}}, {"green", {0.06f, 0.25f, 0.1f}}, {"blue", {0.06f, 0.12f, 0.38f}}};
  for (int i = 0; i < 3; ++i) {
    Material cloth = glossy(std::string("cloth_") + colours[i].first, colours[i].second, 0.9f);
    cloth.doubleSided = true;
    const float x = 4.0f * static_cast<float>(i - 1) - 1;
    std::vector<Place> places = {{{x, kFloor2 - 0.1f, -(kHalfZ - 0.62f)}, 0},
                                 {{x + 2, kFloor2 - 0.1f, kHalfZ - 0.62f}, 180}};
    place(scene, std::string("banner_") + colours[i].first, reduced(banner(1.2f, 2.2f)),
          scene.addMaterial(cloth), places);
  }
}

}  // namespace

void addAtrium(Scene& scene, float share) {
  const auto reduced = [share](Mesh mesh) {
    return share < 1
               ? simplified(mesh, static_cast<std::size_t>(share * static_cast<float>(mesh.triangleCount())))
               : std::move(mesh);
  };
  Material stone = glossy("stone", {1, 1, 1}, 0.85f);
  stone.baseColourTexture = scene.addTexture("stone", plasterImage(512, {0.62f, 0.55f, 0.45f}, 0.3f));
  Material floor = glossy("floor", {1, 1, 1}, 0.6f);
  floor.baseColourTexture = scene.addTexture(
      "tiles", tileImage(512, 4, {0.55f, 0.5f, 0.43f}, {0.33f, 0.22f, 0.17f}, {0.2f, 0.18f, 0.16f}));
  floor.normalTexture = scene.addTexture("tiles_normal", tileNormalImage(512, 4), true);
  const int stoneId = scene.addMaterial(stone), floorId = scene.addMaterial(floor);

  Mesh ground0 = ground(kWallX, kWallZ, 2);
  computeTangents(ground0);
  scene.add("floor", std::move(ground0), floorId);
  scene.add("walls", reduced(outerWalls()), stoneId);
  Mesh slabs = gallerySlab(4.4f, kFloor2);
  append(slabs, gallerySlab(8.0f, kTop));
  scene.add("slabs", std::move(slabs), stoneId);
  scene.add("mouldings", reduced(courtMouldings()), stoneId);
  scene.add("fountain", reduced(fountain()), stoneId);

  std::vector<Place> columns;
  for (const glm::vec3& axis : columnAxes()) columns.push_back({axis, 0});
  place(scene, "column", reduced(flutedColumn(kSpring, 0.2f)), stoneId, columns);
  place(scene, "upper_column", reduced(plainColumn(kSpring2 - kFloor2, 0.13f)), stoneId,
        raised(columns, kFloor2));
  place(scene, "arch", reduced(archedWall(kBay, kFloor2 - kSpring, kDepth, 0.72f)), stoneId,
        raised(bays(), kSpring));
  place(scene, "upper_arch", reduced(archedWall(kBay, kTop - kSpring2, kDepth, 0.82f)), stoneId,
        raised(bays(), kSpring2));
  place(scene, "balustrade", reduced(balustrade(kBay - 0.3f, 0.9f, 7)), stoneId, raised(bays(), kFloor2));
  addBanners(scene, reduced);
}

Scene makeAtrium() {
  Scene scene;
  addAtrium(scene, 1);
  scene.addAreaLight("key", {-4.2f, 16, 4.2f}, {0.8f, 0, -1}, {2.4f, 2.4f}, 1300, {1, 0.93f, 0.82f});
  scene.addCamera("main", {-5.3f, 2.1f, 2.1f}, {2.2f, 3.1f, -2.0f}, 60);
  scene.addCamera("close", {-0.2f, 2.3f, 0.4f}, {1.0f, 2.7f, -3.0f}, 55);
  scene.addCamera("upper", {-7.5f, 6.3f, 0.3f}, {2, 3.6f, -0.7f}, 58);
  return scene;
}

}  // namespace limn::assets
