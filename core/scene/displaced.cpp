#include "core/scene/displaced.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/scene/texture_lookup.h"
#include "glsl/relief/height_normal.glsl"

namespace limn::scene {
namespace {

/// How far a triangle may lie from the map's first texel, in texels: their numbers are integers.
constexpr double kMostPlace = 1 << 30;

/// A corner of a piece of a triangle: weights of the triangle's vertices, and its place in the map in texels.
struct Corner {
  glm::dvec3 weights;
  glm::dvec2 place;
};
using Polygon = std::vector<Corner>;

/// Returns the part of a convex polygon where sign * (place[axis] - line) >= 0.
Polygon cut(const Polygon& polygon, int axis, double line, double sign) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a.place[axis] - line), db = sign * (b.place[axis] - line);
    if (da >= 0) result.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      const double t = da / (da - db);
      Corner between{glm::mix(a.weights, b.weights, t), glm::mix(a.place, b.place, t)};
      between.place[axis] = line;
      result.push_back(between);
    }
  }
  return result;
}

/// Grows a primitive out of the pieces of another one's triangles, cell by cell of a field.
class Displacement {
 public:
  Displacement(const Primitive& from, const relief::HeightField& field, bool bumpyNormals)
      : from_(from), field_(field), slopes_(relief::slopeLevels(field)), bumpyNormals_(bumpyNormals) {
    result_.material = from.material;
    result_.emissiveParts = from.emissiveParts;
  }

  /// Returns the number of cells that add() goes through; infinite where texels have no numbers.
  double cells(std::size_t triangle) const {
    const auto [low, high] = lines(polygon(triangle));
    const bool numbered = glm::all(glm::greaterThan(low, glm::dvec2(-kMostPlace))) &&
                          glm::all(glm::lessThan(high, glm::dvec2(kMostPlace)));
    return numbered ? (high.x - low.x) * (high.y - low.y) : std::numeric_limits<double>::infinity();
  }

  void add(std::size_t triangle) {
    corners_ = std::span(from_.indices).subspan(3 * triangle, 3);
    const Polygon whole = polygon(triangle);
    const auto [low, high] = lines(whole);
    for (double y = low.y; y < high.y; ++y) {
      const Polygon row = cut(cut(whole, 1, y, 1), 1, y + 1, -1);
      for (double x = low.x; x < high.x && row.size() >= 3; ++x)
        addPiece(cut(cut(row, 0, x, 1), 0, x + 1, -1));
    }
  }

  Primitive take() {
    for (const glm::vec3& position : result_.positions) result_.bounds.add(position);
    return std::move(result_);
  }

 private:
  Polygon polygon(std::size_t triangle) const {
    Polygon corners;
    for (int k = 0; k < 3; ++k) {
      glm::dvec3 weights(0);
      weights[k] = 1;
      const uint32_t vertex = from_.indices[3 * triangle + static_cast<std::size_t>(k)];
      corners.push_back({weights, field_.place(glm::dvec2(from_.uvs[vertex]))});
    }
    return corners;
  }

  /// The lines between which a triangle lies, at least one cell apart.
  static std::pair<glm::dvec2, glm::dvec2> lines(const Polygon& corners) {
    glm::dvec2 low = corners[0].place, high = low;
    for (const Corner& corner : corners) {
      low = glm::min(low, corner.place);
      high = glm::max(high, corner.place);
    }
    low = glm::floor(low);
    return {low, glm::max(glm::ceil(high), low + 1.0)};
  }

  template <class T>
  T blend(const std::vector<T>& values, const glm::vec3& w) const {
    return w[0] * values[corners_[0]] + w[1] * values[corners_[1]] + w[2] * values[corners_[2]];
  }

  void addPiece(const Polygon& piece) {
    if (piece.size() < 3) return;
    const auto first = static_cast<uint32_t>(result_.positions.size());
    for (const Corner& corner : piece) addVertex(corner);
    for (uint32_t i = 2; i < piece.size(); ++i)
      result_.indices.insert(result_.indices.end(), {first, first + i - 1, first + i});
  }

  void addVertex(const Corner& corner) {
    const glm::vec3 weights(corner.weights), blended = blend(from_.normals, weights);
    const float size = glm::length(blended);
    const glm::vec3 normal = size > 0.f ? blended / size : from_.normals[corners_[0]];
    glm::vec4 tangent = blend(from_.tangents, weights);
    tangent.w = tangent.w < 0.f ? -1.f : 1.f;
    const glm::vec2 uv = blend(from_.uvs, weights);
    result_.positions.push_back(blend(from_.positions, weights) +
                                static_cast<float>(field_.height(corner.place)) * normal);
    result_.normals.push_back(
        bumpyNormals_ ? glsl::height_normal(normal, tangent, sampleSlopes(slopes_, wrapOf(field_), uv, 0))
                      : normal);
    result_.tangents.push_back(tangent);
    result_.uvs.push_back(uv);
    if (!from_.colours.empty()) result_.colours.push_back(blend(from_.colours, weights));
  }

  const Primitive& from_;
  const relief::HeightField& field_;
  std::vector<relief::SlopeLevel> slopes_;  ///< of the field, as shading normals have them
  bool bumpyNormals_;
  std::span<const uint32_t> corners_;  ///< vertices of the triangle at hand
  Primitive result_;
};

Primitive displacedPrimitive(const Mesh& mesh, const Primitive& primitive, const Material& material,
                             const relief::HeightField& field, std::size_t& left) {
  if (!primitive.joints.empty() || !primitive.morphTargets.empty())
    throw UsageError(fmt::format("mesh '{}' deforms: its height map cannot displace it", mesh.name));
  // A normal map goes before the heights; it turns the surface's own normals.
  Displacement displacement(primitive, field, material.normalTexture.image == kNone);
  const std::size_t triangles = primitive.indices.size() / 3;
  double cells = 0;
  for (std::size_t i = 0; i < triangles; ++i) cells += displacement.cells(i);
  if (!std::isfinite(cells))
    throw UsageError(
        fmt::format("mesh '{}' has texture coordinates more than {:.3g} texels from its height map: it "
                    "cannot be displaced",
                    mesh.name, kMostPlace));
  // Two triangles a cell; those that edges cut have more, but lie in cells that are counted for each
  // triangle.
  if (2 * cells > static_cast<double>(left))
    throw UsageError(fmt::format("mesh '{}' has {:.3g} texels of its height map on it, too many to displace",
                                 mesh.name, cells));
  left -= static_cast<std::size_t>(2 * cells);
  for (std::size_t i = 0; i < triangles; ++i) displacement.add(i);
  return displacement.take();
}

}  // namespace

Scene displaced(Scene scene, std::size_t mostTriangles) {
  std::size_t left = mostTriangles;
  for (Mesh& mesh : scene.meshes)
    for (Primitive& primitive : mesh.primitives) {
      const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
      if (material.height == kNone || primitive.uvs.empty() || primitive.tangents.empty()) continue;
      primitive = displacedPrimitive(mesh, primitive, material,
                                     scene.heights[static_cast<std::size_t>(material.height)], left);
    }
  for (Material& material : scene.materials) material.height = kNone;
  scene.heights.clear();
  return scene;
}

}  // namespace limn::scene
