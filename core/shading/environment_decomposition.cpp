#include "core/shading/environment_decomposition.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "core/base/error.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::shading {
namespace {

using glm::dvec3;
using glm::vec2;
using glm::vec3;

vec3 clamped(const vec3& radiance) {
  vec3 result(0);
  for (int c = 0; c < 3; ++c)
    if (std::isfinite(radiance[c]) && radiance[c] > 0) result[c] = radiance[c];
  return result;
}

/// Antiderivative of the solid angle over a face's plane (Arvo 1995, Applications of Irradiance Tensors).
double cornerSolidAngle(double a, double b) {
  return std::atan2(a * b, std::sqrt(a * a + b * b + 1));
}

/// Place of texel coordinate x or y along the face's side.
double along(double texel, int resolution) {
  return 2 * texel / resolution - 1;
}

/// A part of the sphere between two meridians, which lies in one column of the map and of each face around.
struct Lune {
  double azimuth = 0, width = 0;  ///< of its middle, as in glsl/numeric/equirectangular.glsl; radians
  int column = 0;                 ///< of the map
};

/// Lunes a sixteenth as wide as a texel or less, which cover the sphere. Along each the edges of texels and
/// rows are found exactly; what their slope across the lunes leaves is within 0.004 of a texel.
std::vector<Lune> lunes(int columns, int resolution) {
  std::vector<double> edges;
  for (int x = 0; x <= columns; ++x) edges.push_back(2 * std::numbers::pi * x / columns - std::numbers::pi);
  for (int quarter = -2; quarter <= 2; ++quarter) {
    for (int x = 0; x <= resolution; ++x) {
      const double azimuth = 0.5 * std::numbers::pi * quarter + std::atan(along(x, resolution));
      if (std::abs(azimuth) < std::numbers::pi) edges.push_back(azimuth);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Lune> result;
  for (size_t i = 0; i + 1 < edges.size(); ++i) {
    const double width = edges[i + 1] - edges[i], middle = 0.5 * (edges[i] + edges[i + 1]);
    const int column = std::min(
        static_cast<int>((middle / std::numbers::pi + 1) * 0.5 * static_cast<double>(columns)), columns - 1);
    const int parts = static_cast<int>(std::ceil(width * 32 * resolution / std::numbers::pi));
    for (int part = 0; part < parts; ++part)
      result.push_back({edges[i] + width * (part + 0.5) / parts, width / parts, column});
  }
  return result;
}

/// The heights above the equator (sine of the latitude) at which a meridian, towards (x, z) at the equator,
/// crosses the edges of texels; in no order.
void addTexelEdges(double x, double z, int resolution, std::vector<double>& heights) {
  const double side = std::max(std::abs(x), std::abs(z));
  const auto add = [&](double tangent) { heights.push_back(tangent / std::sqrt(1 + tangent * tangent)); };
  for (int i = 0; i <= resolution; ++i) {
    const double place = along(i, resolution);
    add(side * place);
    if (place == 0) continue;
    for (const double across : {std::abs(x), std::abs(z)})
      if (across > side * std::abs(place)) add(across / place);
  }
}

using FaceEnergies = std::array<std::vector<dvec3>, 6>;

/// Adds what a map holds along a lune. `rows`: heights of the edges of the map's rows, from the top.
void addLune(const scene::Environment& map, const std::vector<double>& rows, const Lune& lune, int resolution,
             FaceEnergies& energies) {
  const double x = std::sin(lune.azimuth), z = -std::cos(lune.azimuth);
  std::vector<double> edges;
  addTexelEdges(x, z, resolution, edges);
  std::sort(edges.begin(), edges.end(), std::greater());
  std::vector<double> heights(rows.size() + edges.size());
  std::merge(rows.begin(), rows.end(), edges.begin(), edges.end(), heights.begin(), std::greater());
  size_t row = 0;
  for (size_t i = 0; i + 1 < heights.size(); ++i) {
    const double y = 0.5 * (heights[i] + heights[i + 1]);
    while (row + 2 < rows.size() && y < rows[row + 1]) ++row;
    const double horizontal = std::sqrt(1 - y * y);
    const dvec3 direction(horizontal * x, y, horizontal * z), size = glm::abs(direction);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto f = static_cast<size_t>(2 * axis + (direction[axis] < 0));
    const auto place = [&](double coordinate) {
      return std::min(static_cast<size_t>(0.5 * (coordinate / size[axis] + 1) * resolution),
                      static_cast<size_t>(resolution - 1));
    };
    const size_t texel =
        place(-glm::dot(direction, dvec3(kCubeFaces[f].v))) * static_cast<size_t>(resolution) +
        place(glm::dot(direction, dvec3(kCubeFaces[f].u)));
    const size_t pixel = row * static_cast<size_t>(map.width) + static_cast<size_t>(lune.column);
    energies[f][texel] += lune.width * (heights[i] - heights[i + 1]) * dvec3(clamped(map.texels[pixel]));
  }
}

scene::DistantRectangle distantRectangle(const CubeFace& face, const Region& region, int resolution) {
  const double a0 = along(region.x0, resolution), a1 = along(region.x1, resolution);
  const double b0 = -along(region.y1, resolution), b1 = -along(region.y0, resolution);
  scene::DistantRectangle light;
  light.centre =
      face.n + static_cast<float>(0.5 * (a0 + a1)) * face.u + static_cast<float>(0.5 * (b0 + b1)) * face.v;
  light.axisU = face.u;
  light.axisV = face.v;
  light.sides = vec2(a1 - a0, b1 - b0);
  light.irradiance = vec3(region.energy);
  return light;
}

void check(const DecompositionSettings& settings) {
  if (settings.resolution < 1 || settings.resolution > kLargestFaceResolution)
    throw UsageError(
        fmt::format("environment: a face resolution of {} is not accepted; expected 1 to {} texels",
                    settings.resolution, kLargestFaceResolution));
}

/// The lights in the order of their brightness.
void sortByBrightness(EnvironmentDecomposition& d) {
  std::vector<size_t> order(d.lights.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t i, size_t j) {
    return glsl::luminance(d.lights[i].irradiance) > glsl::luminance(d.lights[j].irradiance);
  });
  EnvironmentDecomposition sorted{d.resolution, {}, {}, {}};
  for (const size_t i : order) {
    sorted.faces.push_back(d.faces[i]);
    sorted.regions.push_back(d.regions[i]);
    sorted.lights.push_back(d.lights[i]);
  }
  d = std::move(sorted);
}

}  // namespace

const std::array<CubeFace, 6> kCubeFaces{{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                          {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                          {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                                          {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                                          {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                                          {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}}};

double faceSolidAngle(double a0, double b0, double a1, double b1) {
  return cornerSolidAngle(a1, b1) - cornerSolidAngle(a0, b1) - cornerSolidAngle(a1, b0) +
         cornerSolidAngle(a0, b0);
}

std::array<TexelGrid, 6> cubeMap(const scene::Environment& environment, int resolution) {
  if (!environment) throw Error("environment: there is no map to decompose");
  std::vector<double> rows;
  for (int y = 0; y <= environment.height; ++y)
    rows.push_back(std::cos(std::numbers::pi * y / environment.height));
  const std::vector<Lune> all = lunes(environment.width, resolution);
  const size_t texels = static_cast<size_t>(resolution) * static_cast<size_t>(resolution);
  FaceEnergies none;
  none.fill(std::vector<dvec3>(texels));
  // Sums in an order that does not depend on the number of threads.
  const FaceEnergies energies = tbb::parallel_deterministic_reduce(
      tbb::blocked_range(size_t{0}, all.size(), all.size() / 16 + 1), none,
      [&](const tbb::blocked_range<size_t>& range, FaceEnergies sum) {
        for (size_t i = range.begin(); i < range.end(); ++i)
          addLune(environment, rows, all[i], resolution, sum);
        return sum;
      },
      [](FaceEnergies sum, const FaceEnergies& more) {
        for (size_t f = 0; f < 6; ++f)
          for (size_t i = 0; i < sum[f].size(); ++i) sum[f][i] += more[f][i];
        return sum;
      });

  std::array<TexelGrid, 6> faces;
  for (size_t f = 0; f < 6; ++f) {
    faces[f] = {resolution, resolution, energies[f], {}};
    for (int y = 0; y < resolution; ++y)
      for (int x = 0; x < resolution; ++x)
        faces[f].measure.push_back(faceSolidAngle(along(x, resolution), -along(y + 1, resolution),
                                                  along(x + 1, resolution), -along(y, resolution)));
  }
  return faces;
}

EnvironmentDecomposition decomposeEnvironment(const scene::Environment& environment,
                                              const DecompositionSettings& settings) {
  check(settings);
  const std::array<TexelGrid, 6> grids = cubeMap(environment, settings.resolution);
  std::array<std::vector<Region>, 6> regions;
  tbb::parallel_for(size_t{0}, size_t{6}, [&](size_t f) {
    regions[f] = greedyRegions(grids[f], settings.threshold, settings.shape, kMostEnvironmentLights,
                               "environment lights");
  });
  EnvironmentDecomposition result;
  result.resolution = settings.resolution;
  for (size_t f = 0; f < 6; ++f) {
    for (const Region& region : regions[f]) {
      result.faces.push_back(static_cast<int>(f));
      result.regions.push_back(region);
      result.lights.push_back(distantRectangle(kCubeFaces[f], region, settings.resolution));
    }
  }
  if (result.lights.size() > kMostEnvironmentLights)
    throw UsageError(
        fmt::format("environment lights: the threshold {} asks for {} lights, more than {}; a smaller one "
                    "gives fewer",
                    settings.threshold, result.lights.size(), kMostEnvironmentLights));
  sortByBrightness(result);
  return result;
}

}  // namespace limn::shading
