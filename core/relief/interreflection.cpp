#include "core/relief/interreflection.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/base/error.h"
#include "core/relief/private/cell_walk.h"
#include "glsl/relief/bounce_directions.glsl"

namespace limn::relief {
namespace {

/// Returns the smallest t of [0, end] from which c0 + c1 t + c2 t^2 is negative, where c0 >= 0.
std::optional<double> firstFall(double c0, double c1, double c2, double end) {
  if (c0 == 0 && (c1 < 0 || (c1 == 0 && c2 < 0))) return 0;
  const double discriminant = c1 * c1 - 4 * c2 * c0;
  if (discriminant < 0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  double t = end;
  if (c1 < 0)
    t = 2 * c0 / (root - c1);
  else if (c2 < 0)
    t = -(c1 + root) / (2 * c2);
  else
    return std::nullopt;
  if (t <= end) return t;
  return std::nullopt;
}

/// Returns the place moved by whole sizes of the map, or to its edge, where that is inside.
glm::dvec2 inMap(const HeightField& field, const glm::dvec2& place) {
  const glm::dvec2 size(field.size());
  if (field.wrap() == Wrap::clamped) return glm::clamp(place, glm::dvec2(0), size - 1.0);
  return place - size * glm::floor(place / size);
}

std::vector<glm::vec3> sharedDirections(BounceDirections kind, int paths, double lowest, std::uint32_t seed) {
  std::vector<glm::vec3> result;
  if (kind == BounceDirections::ownFrame) return result;
  std::mt19937 engine(seed);
  const auto uniform = [&] { return (static_cast<double>(engine()) + 0.5) / 4294967296.0; };
  for (int i = 0; i < paths; ++i) {
    if (kind == BounceDirections::shared) {
      result.push_back(glsl::shared_direction(i, paths, static_cast<float>(lowest)));
      continue;
    }
    const double z = kind == BounceDirections::published ? uniform() : glm::mix(lowest, 1.0, uniform());
    const double sine = std::sqrt(1 - z * z), angle = 2 * std::numbers::pi * uniform();
    result.emplace_back(sine * std::cos(angle), sine * std::sin(angle), z);
  }
  return result;
}

template <class Function>
void forTexels(const HeightField& field, const Function& function) {
  tbb::parallel_for(0, field.size().y, [&](int y) {
    for (int x = 0; x < field.size().x; ++x) function(glm::ivec2(x, y), field.index({x, y}));
  });
}

}  // namespace

std::optional<glm::dvec2> traceRay(const HeightField& field, const glm::dvec2& place,
                                   const glm::dvec3& direction) {
  const glm::dvec2 along = glm::dvec2(direction) / field.spacing();
  const double level = field.height(place), size = std::max(field.size().x, field.size().y);
  if (along == glm::dvec2(0)) {
    if (direction.z > 0) return std::nullopt;
    return inMap(field, place);
  }
  const double farthest = kFarthestSizes * size / std::max(std::abs(along.x), std::abs(along.y));
  for (CellWalk walk(place, along); walk.enter() <= farthest; walk.advance()) {
    if (direction.z >= 0 && level + direction.z * walk.enter() > field.highest()) break;
    const Patch cell = field.patch(walk.cell());
    const glm::dvec2 in = walk.inside(walk.enter());
    const double above = walk.enter() > 0 ? level + direction.z * walk.enter() - cell.at(in) : 0;
    const double rate =
        direction.z - glm::dot(cell.slope, along) - cell.twist * (in.x * along.y + in.y * along.x);
    const auto t = above < 0
                       ? std::optional<double>(0)
                       : firstFall(above, rate, -cell.twist * along.x * along.y, walk.leave() - walk.enter());
    if (t) return inMap(field, place + (walk.enter() + *t) * along);
  }
  return std::nullopt;
}

void traceBounces(const HeightField& field, BounceDirections directions, int paths,
                  const BouncePathsTaker& take, std::uint32_t seed) {
  if (paths < 1) throw UsageError(fmt::format("{} paths of interreflection: at least 1 is needed", paths));
  const double steepest = field.steepest(), lowest = -steepest / std::sqrt(1 + steepest * steepest);
  const std::vector<glm::vec3> shared = sharedDirections(directions, paths, lowest, seed);
  forTexels(field, [&](const glm::ivec2& texel, std::size_t number) {
    const glm::dvec3 n = field.normal(texel);
    std::vector<BouncePath> list(static_cast<std::size_t>(paths));
    double sum = 0;
    for (int i = 0; i < paths; ++i) {
      const glm::dvec3 d = shared.empty() ? glsl::own_frame_direction(i, paths, glm::vec3(n), 0)
                                          : shared[static_cast<std::size_t>(i)];
      const double cosine = shared.empty() ? 1 : std::max(glm::dot(n, d), 0.0);
      if (cosine == 0) continue;
      BouncePath& path = list[static_cast<std::size_t>(i)];
      if (const auto place = traceRay(field, texel, d)) path.place = *place;
      path.weight = static_cast<float>(cosine);
      sum += cosine;
    }
    if (sum > 0)
      for (BouncePath& path : list) path.weight *= static_cast<float>(std::numbers::pi / sum);
    take(number, list);
  });
}

BouncePaths traceBounces(const HeightField& field, BounceDirections directions, int paths,
                         std::uint32_t seed) {
  const std::size_t each = static_cast<std::size_t>(std::max(paths, 0));
  BouncePaths result{.paths = paths, .list = std::vector<BouncePath>(field.texels() * each)};
  traceBounces(
      field, directions, paths,
      [&](std::size_t texel, std::span<const BouncePath> list) {
        std::ranges::copy(list, result.list.begin() + static_cast<std::ptrdiff_t>(texel * each));
      },
      seed);
  return result;
}

}  // namespace limn::relief
