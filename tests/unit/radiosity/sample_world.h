// Elements of meshes with materials, as the tests of illumination samples light them.
#pragma once

#include <memory>
#include <vector>

#include "core/radiosity/sample_solver.h"
#include "tests/support/radiosity_meshes.h"

namespace limn::radiosity {

/// Hides nothing.
class FreeSight final : public Occlusion {
 public:
  bool blocked(const glm::vec3&, const glm::vec3&, float) const override { return false; }
};

inline LeafMaterial diffuseLeaf(float albedo) {
  LeafMaterial m;
  m.brdf.diffuse = glm::vec3(albedo);
  m.brdf.alpha = 1;
  return m;
}

inline LeafMaterial metalLeaf(float roughness) {
  LeafMaterial m;
  m.brdf.alpha = roughness * roughness;
  m.brdf.f0 = glm::vec3(0.75f);
  m.brdf.f90 = 1;
  return m;
}

/// Elements of meshes, each with a material.
struct SampleWorld {
  ElementSpace space;
  Surfels surfels;
  Forest forest;
  std::vector<LeafMaterial> materials;
  std::unique_ptr<SampleSolver> solver;

  SampleWorld(const std::vector<TriangleMesh>& meshes, const std::vector<LeafMaterial>& ofObject,
              const SampleSettings& settings = {}, float longestEdge = 1e9f)
      : space(spaceOf(meshes)), surfels(surfelsOf(meshes, longestEdge)), forest(surfels) {
    materials.resize(forest.leafSlots());
    for (size_t i = 0; i < surfels.size(); ++i) materials[forest.leafOf()[i]] = ofObject[surfels.objects[i]];
    solver = std::make_unique<SampleSolver>(surfels, forest, space, materials, settings);
  }

  /// Lights the objects with these irradiances, without directions.
  void light(const std::vector<float>& ofObject) {
    for (size_t i = 0; i < surfels.size(); ++i)
      solver->light(forest.leafOf()[i], glm::vec3(ofObject[surfels.objects[i]]), {});
  }
  /// Lights an object from a direction that is unit in world space, with an irradiance perpendicular to it.
  void lightFrom(uint32_t object, const glm::vec3& direction, float spread, float irradiance) {
    const glsl::IncidentLight light{space.direction(direction), spread, glm::vec3(irradiance)};
    for (size_t i = 0; i < surfels.size(); ++i)
      if (surfels.objects[i] == object)
        solver->light(forest.leafOf()[i],
                      glm::vec3(irradiance * std::max(glm::dot(surfels.normals[i], light.direction), 0.f)),
                      {&light, 1});
  }
  /// Power that reached an object in all rounds, in the units of the elements.
  double flux(uint32_t object) const {
    double sum = 0;
    for (size_t i = 0; i < surfels.size(); ++i)
      if (surfels.objects[i] == object)
        sum += double(solver->irradiance()[forest.leafOf()[i]].x) * double(surfels.areas[i]);
    return sum;
  }
  /// Mean over an object's area.
  double mean(uint32_t object) const {
    double area = 0;
    for (size_t i = 0; i < surfels.size(); ++i)
      if (surfels.objects[i] == object) area += double(surfels.areas[i]);
    return flux(object) / area;
  }
};

/// Two squares of side 1 at distance 1 that face each other, of n x n cells.
inline std::vector<TriangleMesh> facingPlates(int n) {
  return {rectangleMesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, n),
          rectangleMesh({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, n)};
}

/// A floor and, as a second object, the other faces of the room [-1, 1]^3.
inline std::vector<TriangleMesh> floorAndRoom(int floorCells, int roomCells) {
  TriangleMesh rest = roomMesh(roomCells);
  std::vector<uint32_t> kept;
  for (size_t t = 0; t < rest.indices.size(); t += 3)
    if (rest.normals[rest.indices[t]].y < 0.5f)
      kept.insert(kept.end(), rest.indices.begin() + std::ptrdiff_t(t),
                  rest.indices.begin() + std::ptrdiff_t(t) + 3);
  rest.indices = kept;
  return {rectangleMesh({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, floorCells), rest};
}

}  // namespace limn::radiosity
