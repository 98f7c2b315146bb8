#include "core/radiosity/illumination.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/scene/environment_light.h"
#include "glsl/numeric/equirectangular.glsl"

namespace limn::radiosity {
namespace {

/// Bins take the pixels of a map whole that is at least this many times as wide and as high as a face has
/// bins: nine of them or more lie across a bin, so that those at its edge hardly matter.
constexpr int kWholePixels = 64;

/// Parts of a map's rows that are summed up by themselves, so that sums do not depend on how many cores there
/// are.
constexpr int kBands = 32;

/// Returns the mean of the pixels whose centres lie in each bin.
std::vector<glm::vec4> meansOfPixels(const scene::Environment& map, const ElementSpace& space, uint32_t n) {
  const size_t bins = size_t{6} * n * n;
  std::vector<glm::dvec4> sums(kBands * bins, glm::dvec4(0));  // w: solid angle
  tbb::parallel_for(0, kBands, [&](int band) {
    glm::dvec4* const own = &sums[static_cast<size_t>(band) * bins];
    for (int y = map.height * band / kBands; y < map.height * (band + 1) / kBands; ++y) {
      const double solidAngle = double(glsl::equirectangular_pixel_solid_angle(y, map.width, map.height));
      for (int x = 0; x < map.width; ++x) {
        const glm::vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(map.width),
                           (static_cast<float>(y) + 0.5f) / static_cast<float>(map.height));
        const glm::vec3 direction =
            glsl::environment_world_direction(glsl::equirectangular_direction(uv), map.rotation);
        const size_t at = static_cast<size_t>(y) * static_cast<size_t>(map.width) + static_cast<size_t>(x);
        own[glsl::bin_of(space.direction(direction), n)] +=
            solidAngle * glm::dvec4(map.scale * map.texels[at], 1);
      }
    }
  });
  std::vector<glm::vec4> means;
  for (size_t bin = 0; bin < bins; ++bin) {
    glm::dvec4 sum(0);
    for (size_t band = 0; band < kBands; ++band) sum += sums[band * bins + bin];
    means.emplace_back(glm::dvec3(sum) / sum.w, 0);
  }
  return means;
}

}  // namespace

std::vector<glm::vec4> binTable(int resolution) {
  const auto n = static_cast<uint32_t>(resolution);
  std::vector<glm::vec4> table;
  for (uint32_t bin = 0; bin < 6 * n * n; ++bin)
    table.emplace_back(glm::normalize(glsl::bin_direction(bin, n)), glsl::bin_solid_angle(bin, n));
  return table;
}

std::vector<glm::vec4> environmentBins(const scene::Environment& environment, const ElementSpace& space,
                                       int resolution) {
  const auto n = static_cast<uint32_t>(resolution);
  if (std::min(environment.width, environment.height) >= kWholePixels * resolution)
    return meansOfPixels(environment, space, n);
  // Four samples for each pixel of the map, so that no small bright one is missed.
  const double pixels = double(environment.width) * environment.height;
  const int side =
      std::max(static_cast<int>(std::ceil(2 * std::sqrt(pixels / double(size_t{6} * n * n)))), 2);
  const scene::EnvironmentLight light(environment);
  std::vector<glm::vec4> bins(size_t{6} * n * n);
  tbb::parallel_for(0u, 6 * n * n, [&](uint32_t bin) {
    glm::vec3 sum(0);
    float weights = 0;
    for (int s = 0; s < side * side; ++s) {
      const glm::vec2 in((static_cast<float>(s % side) + 0.5f) / float(side),
                         (static_cast<float>(s / side) + 0.5f) / float(side));
      const glm::vec2 place = (glm::vec2(float(bin % n), float(bin / n % n)) + in) * (2 / float(n)) - 1.f;
      const glm::vec3 ray = glsl::bin_face_direction(bin / (n * n), place);
      const float length2 = glm::dot(ray, ray), weight = 1 / (length2 * std::sqrt(length2));
      sum += weight * light.radiance(glm::normalize(space.worldDirection(ray)));
      weights += weight;
    }
    bins[bin] = glm::vec4(sum / weights, 0);
  });
  return bins;
}

void gather(const Forest& forest, const Links& links, std::span<const glm::vec4> table,
            std::span<const glm::vec3> outgoing, std::span<const glm::vec3> environment,
            std::span<glm::vec3> irradiance) {
  const auto groups = forest.groups();
  tbb::parallel_for(0u, forest.levels()[0].count, [&](uint32_t g) {
    for (uint32_t lane = 0; lane < groups[g].lanes; ++lane) {
      const int k = static_cast<int>(lane);
      const glm::vec3 normal(groups[g].nx[k], groups[g].ny[k], groups[g].nz[k]);
      const auto row = links.of(4 * g + lane);
      glm::vec3 sum(0);
      float weights = 0;
      for (size_t bin = 0; bin < row.size(); ++bin) {
        const float weight = table[bin].w * glm::dot(normal, glm::vec3(table[bin]));
        if (!(weight > 0)) continue;
        weights += weight;
        const uint32_t link = row[bin];
        if (link == glsl::no_link) {
          if (!environment.empty()) sum += weight * environment[bin];
        } else if ((link & glsl::link_back) == 0 && !outgoing.empty()) {
          sum += weight * outgoing[link];
        }
      }
      irradiance[4 * g + lane] = weights > 0 ? glsl::pi / weights * sum : glm::vec3(0);
    }
  });
}

void pullUp(const Forest& forest, std::span<glm::vec3> outgoing) {
  const auto groups = forest.groups();
  const auto levels = forest.levels();
  for (size_t level = 1; level < levels.size(); ++level)
    tbb::parallel_for(levels[level].first, levels[level].first + levels[level].count, [&](uint32_t g) {
      for (uint32_t lane = 0; lane < groups[g].lanes; ++lane) {
        const uint32_t children = groups[g].children + lane;
        glm::vec3 sum(0);
        float area = 0;
        for (uint32_t k = 0; k < groups[children].lanes; ++k) {
          const float share = groups[children].area[static_cast<int>(k)];
          sum += share * outgoing[4 * children + k];
          area += share;
        }
        outgoing[4 * g + lane] = sum / std::max(area, 1e-37f);
      }
    });
}

}  // namespace limn::radiosity
