// Small scenes made in memory, for tests of the reference.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <string>
#include <vector>

#include "core/reference/reference.h"
#include "core/scene/camera.h"
#include "core/scene/scene.h"
#include "tests/support/closed_forms.h"

namespace limn::reference::test {

struct World {
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera;

  /// Lambertian surface of that albedo.
  int addMaterial(const glm::vec3& albedo, bool doubleSided = false) {
    scene::Material material;
    material.baseColour = glm::vec4(albedo, 1);
    material.metallic = 0;
    material.roughness = 1;
    material.specularFactor = 0;
    material.doubleSided = doubleSided;
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
  }

  /// Clear glass with that index of refraction; thickness 0: a thin sheet.
  int addClearGlass(float ior, float thickness = 1) {
    const int material = addMaterial(glm::vec3(1));
    scene::Material& glass = scene.materials.back();
    glass.specularFactor = 1;
    glass.roughness = 0;
    glass.transmission = 1;
    glass.thickness = thickness;
    glass.ior = ior;
    return material;
  }

  int addMesh(scene::Primitive primitive) {
    for (const auto& p : primitive.positions) primitive.bounds.add(p);
    scene.meshes.emplace_back().primitives.push_back(std::move(primitive));
    return static_cast<int>(scene.meshes.size()) - 1;
  }

  void addInstance(int mesh, const glm::mat4& matrix = glm::mat4(1)) {
    scene::DrawInstance instance;
    instance.node = static_cast<int>(pose.instances.size());
    instance.mesh = mesh;
    instance.objectToWorld = matrix;
    pose.instances.push_back(instance);
    const auto& primitive = scene.meshes[static_cast<size_t>(mesh)].primitives[0];
    for (const auto& p : primitive.positions) pose.bounds.add(glm::vec3(matrix * glm::vec4(p, 1)));
  }

  /// Rectangle centre +- u/2 +- v/2, front face along cross(u, v); uv from (0, 0) at -u -v to (1, 1).
  static scene::Primitive quad(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v,
                               int material) {
    scene::Primitive p;
    p.positions = {centre - 0.5f * u - 0.5f * v, centre + 0.5f * u - 0.5f * v, centre + 0.5f * u + 0.5f * v,
                   centre - 0.5f * u + 0.5f * v};
    p.normals.assign(4, glm::normalize(glm::cross(u, v)));
    p.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    p.indices = {0, 1, 2, 0, 2, 3};
    p.material = material;
    return p;
  }

  void addQuad(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v, int material) {
    addInstance(addMesh(quad(centre, u, v, material)));
  }

  /// Unit sphere around the origin, smooth normals.
  static scene::Primitive sphere(int segments, int material) {
    scene::Primitive p;
    const int rows = segments / 2;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= segments; ++i) {
        const float theta = glsl::pi * static_cast<float>(j) / static_cast<float>(rows);
        const float phi = 2 * glsl::pi * static_cast<float>(i) / static_cast<float>(segments);
        p.positions.emplace_back(std::sin(theta) * std::sin(phi), std::cos(theta),
                                 std::sin(theta) * std::cos(phi));
      }
    p.normals = p.positions;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < segments; ++i) {
        const auto a = static_cast<uint32_t>(j * (segments + 1) + i),
                   b = a + static_cast<uint32_t>(segments) + 1;
        p.indices.insert(p.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
      }
    p.material = material;
    return p;
  }

  glsl::Light& addLight(uint32_t type, const glm::vec3& position, const glm::vec3& direction,
                        const glm::vec3& emission) {
    glsl::Light light{};
    light.position = position;
    light.direction = glm::normalize(direction);
    light.emission = emission;
    light.cos_inner = 1;
    light.cos_outer = -1;
    light.type = type;
    light.own_instance = glsl::no_instance;
    light.index = static_cast<uint32_t>(pose.lights.size());
    pose.lights.push_back(light);
    pose.lightNames.push_back("#" + std::to_string(pose.lights.size() - 1));
    return pose.lights.back();
  }

  /// Rectangle of sides u and v (perpendicular), shining along -cross(u, v).
  glsl::Light& addRectangle(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v, float radiance) {
    glsl::Light& light = addLight(glsl::light_rectangle, centre, -glm::cross(u, v), glm::vec3(radiance));
    light.axis_u = glm::normalize(u);
    light.length_u = glm::length(u);
    light.axis_v = glm::normalize(v);
    light.length_v = glm::length(v);
    return light;
  }

  /// Everything `factor` times as large, lights such that the picture stays the same.
  void rescale(float factor) {
    const glm::mat4 scaling = glm::scale(glm::mat4(1), glm::vec3(factor));
    for (auto& instance : pose.instances) instance.objectToWorld = scaling * instance.objectToWorld;
    for (auto& light : pose.lights) {
      light.position = factor * light.position;
      light.length_u *= factor;
      light.length_v *= factor;
      light.range *= factor;
      if (light.type == glsl::light_point || light.type == glsl::light_spot)
        light.emission *= factor * factor;
    }
    camera.worldToView[3] = glm::vec4(factor * glm::vec3(camera.worldToView[3]), 1);
    camera.near *= factor;
    pose.bounds.low *= factor;
    pose.bounds.high *= factor;
  }

  Request request(int size, Term term, int spp) const {
    Request r{.scene = scene, .pose = pose, .camera = camera};
    r.width = r.height = size;
    r.term = term;
    r.spp = spp;
    return r;
  }
};

/// A floor of 4 x 4 m in the plane y = 0, seen from above.
inline World floorWorld(float albedo = 0.5f) {
  World world;
  world.addQuad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, world.addMaterial(glm::vec3(albedo)));
  world.camera = scene::lookAt({0, 4.2f, 0.01f}, {0, 0, 0}, 0.8f);
  return world;
}

/// A floor with a sphere on it, two lights and an environment: a bit of everything.
inline World busyWorld() {
  World world = floorWorld();
  world.addRectangle({0.2f, 1.5f, -0.1f}, {1, 0, 0}, {0, 0, -0.6f}, 7);
  world.addLight(glsl::light_point, {-1, 1, 0.5f}, {0, -1, 0}, glm::vec3(1, 0.5f, 0.2f));
  world.addInstance(
      world.addMesh(World::sphere(24, world.addMaterial({0.8f, 0.2f, 0.1f}))),
      glm::translate(glm::mat4(1), glm::vec3(0.3f, 0.4f, 0)) * glm::scale(glm::mat4(1), glm::vec3(0.4f)));
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, glm::vec3(0.3f));
  world.camera = scene::lookAt({0, 2, 3}, {0, 0.2f, 0}, 0.8f);
  return world;
}

inline bool sameBits(const Image& a, const Image& b) {
  return a.channels() == b.channels() &&
         std::equal(a.data().begin(), a.data().end(), b.data().begin(), b.data().end());
}

/// An empty folder that goes with the test.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("limn_reference_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// World position that a pixel of a result shows: from its Z channel.
inline glm::dvec3 positionOf(const World& world, const Image& image, int x, int y) {
  glsl::FrameBlock frame{};
  scene::setCamera(frame, world.camera, world.pose.bounds, image.width(), image.height());
  const glm::vec3 direction = glm::vec3(frame.view_ray_origin) +
                              static_cast<float>(x) * glm::vec3(frame.view_ray_dx) +
                              static_cast<float>(image.height() - 1 - y) * glm::vec3(frame.view_ray_dy);
  return glm::dvec3(glm::vec3(frame.camera_position)) +
         static_cast<double>(image.at(x, y, image.channel("Z"))) * glm::dvec3(direction);
}

/// Mean of |value - expected(position)| over mean of expected, over covered pixels. `expected` may say NaN:
/// left out.
template <class Expected>
double meanRelativeError(const World& world, const Image& image, const char* channel, Expected expected) {
  double error = 0, total = 0;
  const int c = image.channel(channel), coverage = image.channel("coverage");
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      if (image.at(x, y, coverage) == 0.f) continue;
      const double value = expected(positionOf(world, image, x, y));
      if (std::isnan(value)) continue;
      error += std::abs(static_cast<double>(image.at(x, y, c)) - value);
      total += value;
    }
  return total > 0 ? error / total : error;
}

/// Largest difference of two pictures' channel over the mean of the first; infinite where one is NaN.
inline double largestDifference(const Image& a, const Image& b, const char* channel) {
  double largest = 0, sum = 0;
  const int c = a.channel(channel);
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) {
      const double difference =
          std::abs(static_cast<double>(a.at(x, y, c)) - static_cast<double>(b.at(x, y, c)));
      if (std::isnan(difference)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, difference);
      sum += std::abs(static_cast<double>(a.at(x, y, c)));
    }
  return largest / std::max(sum / static_cast<double>(a.pixelCount()), 1e-300);
}

using limn::test::lambertIrradiance;

}  // namespace limn::reference::test
