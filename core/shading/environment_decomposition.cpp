#include "core/shading/environment_decomposition.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/shading/environment.h"
#include "glsl/numeric/equirectangular.glsl"
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

/// Solid angle of each pixel of a row.
std::vector<double> rowSolidAngles(int width, int height) {
  std::vector<double> rows;
  for (int y = 0; y < height; ++y)
    rows.push_back(2 * std::numbers::pi / width *
                   (std::cos(std::numbers::pi * y / height) - std::cos(std::numbers::pi * (y + 1) / height)));
  return rows;
}

/// Radiance times solid angle over the whole sphere.
dvec3 totalEnergy(const FilteredMap& map) {
  const std::vector<double> solidAngle = rowSolidAngles(map.width, map.height);
  dvec3 total(0);
  for (int y = 0; y < map.height; ++y) {
    dvec3 row(0);
    for (int x = 0; x < map.width; ++x)
      row +=
          dvec3(map.texels[static_cast<size_t>(y) * static_cast<size_t>(map.width) + static_cast<size_t>(x)]);
    total += solidAngle[static_cast<size_t>(y)] * row;
  }
  return total;
}

/// Half as wide and high, with the same energy in each block of four pixels.
FilteredMap halved(const FilteredMap& map) {
  FilteredMap half{map.width / 2, map.height / 2, {}};
  half.texels.resize(static_cast<size_t>(half.width) * static_cast<size_t>(half.height));
  const std::vector<double> solidAngle = rowSolidAngles(map.width, map.height);
  tbb::parallel_for(0, half.height, [&](int y) {
    const auto source = [&](int x, int row) {
      return dvec3(
          map.texels[static_cast<size_t>(row) * static_cast<size_t>(map.width) + static_cast<size_t>(x)]);
    };
    const double above = solidAngle[static_cast<size_t>(2 * y)],
                 below = solidAngle[static_cast<size_t>(2 * y + 1)];
    for (int x = 0; x < half.width; ++x) {
      const dvec3 sum = above * (source(2 * x, 2 * y) + source(2 * x + 1, 2 * y)) +
                        below * (source(2 * x, 2 * y + 1) + source(2 * x + 1, 2 * y + 1));
      half.texels[static_cast<size_t>(y) * static_cast<size_t>(half.width) + static_cast<size_t>(x)] =
          vec3(sum / (2 * (above + below)));
    }
  });
  return half;
}

/// Antiderivative of the solid angle over a face's plane (Arvo 1995, Applications of Irradiance Tensors).
double cornerSolidAngle(double a, double b) {
  return std::atan2(a * b, std::sqrt(a * a + b * b + 1));
}

/// Place of texel coordinate x or y along the face's side.
double along(double texel, int resolution) {
  return 2 * texel / resolution - 1;
}

/// Mean radiance over the texels of a face, from n x n samples each.
TexelGrid sampleFace(const FilteredMap& map, const CubeFace& face, int resolution, int n) {
  TexelGrid grid{resolution, resolution, {}, {}};
  const size_t count = static_cast<size_t>(resolution) * static_cast<size_t>(resolution);
  grid.energy.resize(count);
  grid.measure.resize(count);
  tbb::parallel_for(0, resolution, [&](int y) {
    for (int x = 0; x < resolution; ++x) {
      dvec3 sum(0);
      double weights = 0;
      for (int i = 0; i < n * n; ++i) {
        const double a = along(x + (i % n + 0.5) / n, resolution),
                     b = -along(y + (i / n + 0.5) / n, resolution);
        const double d2 = 1 + a * a + b * b;
        const double weight = 1 / (d2 * std::sqrt(d2));
        const vec3 direction = face.n + static_cast<float>(a) * face.u + static_cast<float>(b) * face.v;
        sum += weight * dvec3(bilinear(map, glsl::equirectangular_uv(direction)));
        weights += weight;
      }
      const size_t texel = static_cast<size_t>(y) * static_cast<size_t>(resolution) + static_cast<size_t>(x);
      grid.measure[texel] = faceSolidAngle(along(x, resolution), -along(y + 1, resolution),
                                           along(x + 1, resolution), -along(y, resolution));
      grid.energy[texel] = grid.measure[texel] / weights * sum;
    }
  });
  return grid;
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
  FilteredMap map{environment.width, environment.height, environment.texels};
  for (vec3& texel : map.texels) texel = clamped(texel);
  const dvec3 total = totalEnergy(map);
  // A texel is an eighth of the horizon's share of a face; two samples per pixel catch a single bright one.
  while (map.width >= 16 * resolution && map.width % 2 == 0 && map.height % 2 == 0) map = halved(map);
  const int samples = std::clamp((map.width + 2 * resolution - 1) / (2 * resolution), 2, 32);

  std::array<TexelGrid, 6> faces;
  dvec3 sampled(0);
  for (size_t f = 0; f < 6; ++f) {
    faces[f] = sampleFace(map, kCubeFaces[f], resolution, samples);
    for (const dvec3& energy : faces[f].energy) sampled += energy;
  }
  dvec3 correction(1);
  for (int c = 0; c < 3; ++c)
    if (sampled[c] > 0) correction[c] = total[c] / sampled[c];
  for (TexelGrid& face : faces)
    for (dvec3& energy : face.energy) energy *= correction;
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
        fmt::format("environment lights: the threshold {} asks for {} lights, more than {}; a smaller "
                    "threshold or resolution gives fewer",
                    settings.threshold, result.lights.size(), kMostEnvironmentLights));
  sortByBrightness(result);
  return result;
}

}  // namespace limn::shading
