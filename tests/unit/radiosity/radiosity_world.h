// Surfels of meshes with their hierarchy and links, as the tests of implicit visibility on the CPU ask them.
#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/radiosity/illumination.h"
#include "tests/support/radiosity_meshes.h"

namespace limn::radiosity {

constexpr float kPublished = 1;  ///< LinkSettings::opening

/// Surfels, their hierarchy and links.
struct World {
  Surfels surfels;
  Forest forest;
  Links links;

  explicit World(std::vector<TriangleMesh> meshes, const LinkSettings& settings = {.opening = kPublished},
                 bool flat = false, float longestEdge = 1e9f)
      : surfels(surfelsOf(std::move(meshes), longestEdge)),
        forest(surfels, settings.fill == Fill::triangles ? LeafShape::triangles : LeafShape::disc) {
    if (flat)
      links.buildFlat(forest, settings);
    else
      links.build(forest, settings);
  }

  double area() const { return std::accumulate(surfels.areas.begin(), surfels.areas.end(), 0.0); }

  /// A value per surfel's object as one per leaf slot.
  std::vector<glm::vec3> perLeaf(const std::vector<float>& ofObject) const {
    std::vector<glm::vec3> values(forest.leafSlots(), glm::vec3(0));
    for (size_t i = 0; i < surfels.size(); ++i)
      values[forest.leafOf()[i]] = glm::vec3(ofObject[surfels.objects[i]]);
    return values;
  }

  /// Irradiance over pi of each surfel when objects emit radiance, and empty bins see `sky`.
  std::vector<float> received(const std::vector<float>& emission, float sky = 0) const {
    std::vector<glm::vec3> outgoing = perLeaf(emission), irradiance(forest.leafSlots());
    outgoing.resize(forest.slots());
    pullUp(forest, outgoing);
    const std::vector<glm::vec3> environment(links.binCount(), glm::vec3(sky));
    gather(forest, links, binTable(links.resolution()), outgoing, environment, irradiance);
    std::vector<float> result;
    for (const uint32_t leaf : forest.leafOf()) result.push_back(irradiance[leaf].x * glsl::inverse_pi);
    return result;
  }

  /// Mean over an object's area.
  double mean(const std::vector<float>& values, uint32_t object) const {
    double sum = 0, area = 0;
    for (size_t i = 0; i < surfels.size(); ++i) {
      if (surfels.objects[i] != object) continue;
      sum += double(values[i]) * surfels.areas[i];
      area += surfels.areas[i];
    }
    return sum / area;
  }
};

}  // namespace limn::radiosity
