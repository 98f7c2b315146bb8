#include "core/scene/emissive_quad.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/image/greedy_regions.h"
#include "core/scene/texture_lookup.h"

namespace limn::scene {
namespace {

/// Places on the rectangle: s and t in [0, 1] along its sides, from the corner where both begin.
struct AffineUv {
  glm::dvec2 origin{0}, alongU{0}, alongV{0};
  glm::dvec2 at(double s, double t) const { return origin + s * alongU + t * alongV; }
};

std::optional<AffineUv> affineUv(const Primitive& p, const Quad& quad) {
  if (p.uvs.size() != p.positions.size()) return std::nullopt;
  const auto uvAt = [&](float s, float t) {
    const glm::vec3 corner = quad.centre + (s - 0.5f) * quad.sideU + (t - 0.5f) * quad.sideV;
    const auto nearest = std::ranges::min_element(p.indices, {}, [&](uint32_t i) {
      return glm::length(glm::dvec3(p.positions[i]) - glm::dvec3(corner));
    });
    return glm::dvec2(p.uvs[*nearest]);
  };
  AffineUv uv;
  uv.origin = uvAt(0, 0);
  uv.alongU = uvAt(1, 0) - uv.origin;
  uv.alongV = uvAt(0, 1) - uv.origin;
  constexpr double kTolerance = 1e-3;
  const double size = glm::length(uv.alongU) + glm::length(uv.alongV);
  if (!(glm::length(uvAt(1, 1) - uv.at(1, 1)) <= kTolerance * size)) return std::nullopt;
  return uv;
}

/// Mean radiance of each cell, the first row where t is 0. A cell of many texels is read from the level where
/// it has about 64, and at most 64 along a side: files may hold thousands of such rectangles.
TexelGrid meanRadiance(const Scene& scene, const Material& material, const AffineUv& uv) {
  constexpr int n = kTexturedLightCells;
  constexpr double kTexels = 64, kMostAlong = 64;
  const glm::dvec2 texels(textureSize(scene, material.emissiveTexture));
  const double alongU = std::max(glm::length(uv.alongU * texels) / n, 1.0),
               alongV = std::max(glm::length(uv.alongV * texels) / n, 1.0);
  const double lod = std::max(
      {0.0, 0.5 * std::log2(alongU * alongV / kTexels), std::log2(std::max(alongU, alongV) / kMostAlong)});
  const int across = static_cast<int>(std::ceil(alongU / std::exp2(lod))),
            down = static_cast<int>(std::ceil(alongV / std::exp2(lod)));
  TexelGrid grid{n, n, std::vector<glm::dvec3>(n * n), std::vector<double>(n * n, 1.0)};
  for (int cell = 0; cell < n * n; ++cell) {
    glm::dvec3 sum(0);
    for (int i = 0; i < across * down; ++i) {
      const double s = (cell % n + (i % across + 0.5) / across) / n,
                   t = (cell / n + (i / across + 0.5) / down) / n;
      sum += glm::dvec3(
          sampleTexture(scene, material.emissiveTexture, glm::vec2(uv.at(s, t)), static_cast<float>(lod)));
    }
    grid.energy[static_cast<std::size_t>(cell)] = glm::dvec3(material.emission) * sum / double(across * down);
  }
  return grid;
}

/// As many as it takes at a threshold that makes one light of a uniform texture; fewer and larger ones where
/// those were more than kMostTexturedLightParts.
std::vector<Region> regions(const TexelGrid& grid) {
  for (double threshold = 0.05; threshold > 1e-3; threshold /= 2) {
    try {
      return greedyRegions(grid, threshold, RegionShape::rectangles, kMostTexturedLightParts,
                           "emissive texture");
    } catch (const UsageError&) {  // too many
    }
  }
  Region all{0, 0, grid.width, grid.height};
  for (const glm::dvec3& energy : grid.energy) all.energy += energy;
  return {all};
}

}  // namespace

std::vector<EmissivePart> emissiveParts(const Scene& scene, const Primitive& primitive, const Quad& quad) {
  const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
  if (material.emissiveTexture.image == kNone) return {{quad}};
  const std::optional<AffineUv> uv = affineUv(primitive, quad);
  if (!uv) return {};
  std::vector<EmissivePart> parts;
  for (const Region& r : regions(meanRadiance(scene, material, *uv))) {
    const glm::vec2 size(r.x1 - r.x0, r.y1 - r.y0);
    const glm::vec2 middle = (glm::vec2(r.x0, r.y0) + 0.5f * size) / float{kTexturedLightCells} - 0.5f;
    const glm::vec2 sides = size / float{kTexturedLightCells};
    const glm::dvec3 radiance = r.energy / double(size.x * size.y);
    EmissivePart& part = parts.emplace_back();
    part.quad = {quad.centre + middle.x * quad.sideU + middle.y * quad.sideV, sides.x * quad.sideU,
                 sides.y * quad.sideV};
    for (int c = 0; c < 3; ++c)
      part.texture[c] =
          material.emission[c] > 0 ? static_cast<float>(radiance[c] / material.emission[c]) : 1.f;
  }
  return parts;
}

}  // namespace limn::scene
