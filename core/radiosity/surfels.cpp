#include "core/radiosity/surfels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "core/base/error.h"
#include "core/radiosity/bodies.h"

namespace limn::radiosity {
namespace {

constexpr float kSmallestWeldCosine = 0.70710678f;
constexpr uint32_t kSmallestCluster = 16;
constexpr size_t kMostTriangles = 4;  // between surfels, for each that there may be

/// Disjoint sets (Tarjan 1975), by path halving.
class Sets {
 public:
  explicit Sets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t find(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) { parent_[std::max(find(a), find(b))] = std::min(find(a), find(b)); }

 private:
  std::vector<uint32_t> parent_;
};

/// A cell of a grid of 2^-20, in which points are looked for that rounding has moved apart.
struct Place {
  std::array<int64_t, 3> cell;
  bool operator==(const Place&) const = default;

  /// The cell of p, moved by `shift` cells.
  static Place of(const glm::vec3& p, const glm::dvec3& shift) {
    const glm::dvec3 at = glm::floor(glm::dvec3(p) * 0x1p20 + shift);
    return {{static_cast<int64_t>(at.x), static_cast<int64_t>(at.y), static_cast<int64_t>(at.z)}};
  }
};
struct PlaceHash {
  size_t operator()(const Place& p) const {
    return static_cast<size_t>(p.cell[0] * 73856093 ^ p.cell[1] * 19349663 * 128 ^
                               p.cell[2] * 83492791 * 8192);
  }
};

/// A corner while triangles are split: weights of the triangle's vertices.
using Weights = glm::vec3;

/// One object's surfels in the making.
class Builder {
 public:
  Builder(Surfels& out, size_t most, const TriangleMesh& mesh, uint32_t object, float side)
      : out_(out),
        most_(most),
        mesh_(mesh),
        object_(object),
        side_(side),
        first_(static_cast<uint32_t>(out.size())),
        countedAt_(mesh.positions.size(), kNowhere) {}

  void addTriangles(float longestEdge) {
    longest2_ = longestEdge * longestEdge;
    for (size_t t = 0; t + 2 < mesh_.indices.size(); t += 3) {
      corners_ = {mesh_.indices[t], mesh_.indices[t + 1], mesh_.indices[t + 2]};
      if (!hasArea(position({1, 0, 0}), position({0, 1, 0}), position({0, 0, 1}))) continue;
      source_ = static_cast<uint32_t>(t / 3);
      split({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    }
    for (size_t i = first_; i < out_.size(); ++i) {
      const float length = glm::length(sums_[i - first_]);
      if (length > 0) out_.normals[i] = sums_[i - first_] / length;
      out_.firstOrigin.push_back(static_cast<uint32_t>(out_.origins.size()));
      out_.origins.insert(out_.origins.end(), origins_[i - first_].begin(), origins_[i - first_].end());
    }
  }

  /// Adds the connected pieces and their holes. Returns whether there is no hole: every edge has a neighbour
  /// in the opposite direction.
  bool addPieces() {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;  // between surfels that stand for their places
    std::vector<uint32_t> standsFor(places_ + 1, 0);
    for (size_t i = out_.size(); i-- > first_;)
      standsFor[place_[i - first_]] = static_cast<uint32_t>(i - first_);
    Sets pieces(out_.size() - first_), holes(out_.size() - first_);
    for (size_t t = firstTriangle_; t < out_.triangles.size(); t += 3)
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = standsFor[place_[out_.triangles[t + k] - first_]];
        const uint32_t b = standsFor[place_[out_.triangles[t + (k + 1) % 3] - first_]];
        edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        pieces.join(a, b);
      }
    std::map<uint32_t, uint32_t> names;
    for (const uint32_t place : place_) {
      const auto [found, isNew] = names.emplace(pieces.find(standsFor[place]), out_.pieceCount);
      out_.pieceCount += isNew ? 1 : 0;
      out_.pieces.push_back(found->second);
    }
    for (const auto& [edge, count] : edges)
      if (count != 0) holes.join(edge.first, edge.second);
    names.clear();
    bool closed = true;
    for (const auto& [edge, count] : edges) {
      if (count == 0) continue;
      closed = false;
      const auto [found, isNew] = names.emplace(holes.find(edge.first), out_.holeCount);
      out_.holeCount += isNew ? 1 : 0;
      const uint32_t from = first_ + (count > 0 ? edge.second : edge.first),
                     to = first_ + (count > 0 ? edge.first : edge.second);
      for (int i = 0; i < std::abs(count); ++i) out_.rims.push_back({from, to, found->second});
    }
    return closed;
  }

  void addClusters() {
    Sets sets(out_.size() - first_);
    const std::vector<uint32_t> charts = mesh_.uvs.empty() ? std::vector<uint32_t>() : chartsOfTriangles();
    for (size_t t = firstTriangle_; t < out_.triangles.size(); t += 3)
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = out_.triangles[t + k] - first_, b = out_.triangles[t + (k + 1) % 3] - first_;
        const bool together = charts.empty() ? axis(a) == axis(b) : chart_[a] == chart_[b];
        if (together) sets.join(a, b);
      }
    std::vector<uint32_t> sizes(out_.size() - first_, 0);
    for (uint32_t i = 0; i < sizes.size(); ++i) ++sizes[sets.find(i)];
    std::map<uint32_t, uint32_t> names;  // the small ones of an axis go by its number, behind all roots
    for (uint32_t i = 0; i < sizes.size(); ++i) {
      const uint32_t root = sets.find(i);
      const auto own = static_cast<uint32_t>(sizes.size());
      const uint32_t name = sizes[root] < kSmallestCluster ? own + axis(i) : root;
      const auto [found, isNew] = names.emplace(name, out_.clusterCount);
      out_.clusterCount += isNew ? 1 : 0;
      out_.clusters.push_back(found->second);
    }
  }

 private:
  glm::vec3 position(const Weights& w) const {
    // Exact for the halves, quarters, ... of an edge, so that both of its triangles find the same point.
    const auto& p = mesh_.positions;
    const glm::dvec3 d(w);
    return glm::vec3(d.x * glm::dvec3(p[corners_[0]]) + d.y * glm::dvec3(p[corners_[1]]) +
                     d.z * glm::dvec3(p[corners_[2]]));
  }

  static float area(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    return static_cast<float>(
        0.5 * glm::length(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a))));
  }

  /// False where rounding decides about the area.
  static bool hasArea(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const float longest2 = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
    return area(a, b, c) > 1e-5f * longest2;
  }

  void split(const Weights& a, const Weights& b, const Weights& c) {
    const glm::vec3 pa = position(a), pb = position(b), pc = position(c);
    const auto isLong = [&](const glm::vec3& p, const glm::vec3& q) {
      return glm::dot(p - q, p - q) > longest2_;
    };
    const bool ab = isLong(pa, pb), bc = isLong(pb, pc), ca = isLong(pc, pa);
    const Weights mab = 0.5f * (a + b), mbc = 0.5f * (b + c), mca = 0.5f * (c + a);
    if (ab && bc && ca) {
      split(a, mab, mca), split(mab, b, mbc), split(mca, mbc, c), split(mab, mbc, mca);
    } else if (ab && (bc || ca)) {
      if (bc)
        split(mab, b, mbc), split(a, mab, mbc), split(a, mbc, c);
      else
        split(a, mab, mca), split(mab, b, mca), split(mca, b, c);
    } else if (ab) {
      split(a, mab, c), split(mab, b, c);
    } else if (bc && ca) {
      split(b, c, a);
    } else if (bc) {
      split(b, c, a);
    } else if (ca) {
      split(c, a, b);
    } else {
      emit(a, b, c, area(pa, pb, pc));
    }
  }

  void emit(const Weights& a, const Weights& b, const Weights& c, float triangleArea) {
    const uint32_t corners[3] = {surfel(a), surfel(b), surfel(c)};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    // A closed mesh has two for each surfel: there are many more only where triangles lie on each other.
    if (out_.triangles.size() / (3 * kMostTriangles) >= most_)
      throw UsageError(fmt::format(
          "surface elements: the scene has more than {} triangles for each of the {} that fit the "
          "memory allowed",
          kMostTriangles, most_));
    for (int k = 0; k < 3; ++k) out_.triangles.push_back(corners[side_ < 0 ? 2 - k : k]);
    for (const uint32_t corner : corners) out_.areas[corner] += triangleArea / 3;
  }

  uint32_t surfel(const Weights& w) {
    const glm::vec3 p = position(w);
    const glm::vec3 faceNormal = glm::cross(mesh_.positions[corners_[1]] - mesh_.positions[corners_[0]],
                                            mesh_.positions[corners_[2]] - mesh_.positions[corners_[0]]);
    glm::vec3 n = w.x * mesh_.normals[corners_[0]] + w.y * mesh_.normals[corners_[1]] +
                  w.z * mesh_.normals[corners_[2]];
    if (!(glm::length(n) > 0)) n = faceNormal;
    n = side_ * n / std::max(glm::length(n), 1e-30f);
    std::vector<uint32_t>& here = surfelsAt(p);
    if (here.empty()) ++places_;
    for (const uint32_t known : here)
      if (glm::dot(out_.normals[known], n) > kSmallestWeldCosine) {
        addOrigin(known, w, n);
        return known;
      }
    if (out_.size() >= most_)
      throw UsageError(
          fmt::format("surface elements: the scene has more than the {} that fit the memory allowed", most_));
    const auto added = static_cast<uint32_t>(out_.size());
    out_.objects.push_back(object_);
    origins_.push_back({{corners_, w, side_}});
    if (const int k = wholeCorner(w); k >= 0) countedAt_[corners_[static_cast<size_t>(k)]] = added;
    out_.vertices.push_back(p);
    out_.normals.push_back(n);
    out_.areas.push_back(0);
    sums_.push_back(n);
    place_.push_back(here.empty() ? places_ : place_[here.front() - first_]);
    source_of_.push_back(source_);
    here.push_back(added);
    return added;
  }

  /// Those that a quarter of a cell around p meets, or else p's own cell.
  std::vector<uint32_t>& surfelsAt(const glm::vec3& p) {
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 shift((corner & 1) != 0 ? 0.25 : -0.25, (corner & 2) != 0 ? 0.25 : -0.25,
                             (corner & 4) != 0 ? 0.25 : -0.25);
      const auto found = at_.find(Place::of(p, shift));
      if (found != at_.end()) return found->second;
    }
    return at_[Place::of(p, glm::dvec3(0))];
  }

  /// Returns the corner of the triangle that these weights are, or -1.
  static int wholeCorner(const Weights& w) { return w.x == 1 ? 0 : w.y == 1 ? 1 : w.z == 1 ? 2 : -1; }

  /// Another vertex at a known place; the same one in another triangle counts once.
  void addOrigin(uint32_t known, const Weights& w, const glm::vec3& n) {
    const auto heaviest = [](const SurfelOrigin& o) {
      const int k = wholeCorner(o.weights);
      return k < 0 ? -1 : static_cast<int64_t>(o.vertices[static_cast<size_t>(k)]);
    };
    const SurfelOrigin origin{corners_, w, side_};
    const int64_t vertex = heaviest(origin);
    // Of a mesh that is tiny beside the scene all vertices may lie at one place: most have been counted
    // nowhere yet, and need not be looked for.
    const bool isNew = vertex >= 0 && countedAt_[static_cast<size_t>(vertex)] == kNowhere;
    if (vertex >= 0 && countedAt_[static_cast<size_t>(vertex)] == known) return;
    std::vector<SurfelOrigin>& list = origins_[known - first_];
    if (!isNew)
      for (const SurfelOrigin& o : list) {
        const bool same = heaviest(o) >= 0 ? heaviest(o) == vertex
                                           : o.vertices == origin.vertices && o.weights == origin.weights;
        if (same) return;
      }
    if (vertex >= 0) countedAt_[static_cast<size_t>(vertex)] = known;
    list.push_back(origin);
    sums_[known - first_] += n;
  }

  uint32_t axis(uint32_t i) const {
    const glm::vec3 n = out_.normals[first_ + i], size = glm::abs(n);
    const int major = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return static_cast<uint32_t>(2 * major + (n[major] < 0 ? 1 : 0));
  }

  /// Connected pieces of the texture plane; also sets chart_, those of the surfels.
  std::vector<uint32_t> chartsOfTriangles() {
    Sets sets(mesh_.positions.size());
    std::map<std::tuple<float, float, float, float, float>, uint32_t> known;
    for (uint32_t i = 0; i < mesh_.positions.size(); ++i) {
      const glm::vec3& p = mesh_.positions[i];
      const glm::vec2& uv = mesh_.uvs[i];
      sets.join(i, known.emplace(std::tuple(p.x, p.y, p.z, uv.x, uv.y), i).first->second);
    }
    for (size_t t = 0; t + 2 < mesh_.indices.size(); t += 3) {
      sets.join(mesh_.indices[t], mesh_.indices[t + 1]);
      sets.join(mesh_.indices[t], mesh_.indices[t + 2]);
    }
    std::vector<uint32_t> charts;
    for (size_t t = 0; t + 2 < mesh_.indices.size(); t += 3) charts.push_back(sets.find(mesh_.indices[t]));
    for (const uint32_t source : source_of_) chart_.push_back(charts[source]);
    return charts;
  }

  Surfels& out_;
  size_t most_;
  const TriangleMesh& mesh_;
  uint32_t object_;
  float side_;
  uint32_t first_;
  size_t firstTriangle_ = out_.triangles.size();
  float longest2_ = 0;
  std::array<uint32_t, 3> corners_{};  ///< of the triangle in work
  uint32_t source_ = 0, places_ = 0;
  static constexpr uint32_t kNowhere = ~0u;
  std::vector<uint32_t> countedAt_;  ///< of each vertex: the surfel that it was counted at last
  std::unordered_map<Place, std::vector<uint32_t>, PlaceHash> at_;
  std::vector<std::vector<SurfelOrigin>> origins_;  ///< per surfel of this object
  std::vector<glm::vec3> sums_;                     ///< of normals, per surfel of this object
  std::vector<uint32_t> place_;                     ///< of each surfel, equal for those at the same position
  std::vector<uint32_t> source_of_;                 ///< of each surfel: the triangle that made it
  std::vector<uint32_t> chart_;                     ///< of each surfel
};

/// What the centroid of surfel's third of a triangle (the quadrilateral of corner, edge midpoints and
/// centroid) takes of each of the two other corners.
constexpr float kCentroidShare = 7.f / 36;

void addNeighbours(Surfels& s) {
  // The corners of all triangles, those of a surfel together. One vertex may have as many as there are
  // triangles.
  std::vector<uint32_t> end(s.size() + 1, 0), corners(s.triangles.size());
  for (const uint32_t surfel : s.triangles) ++end[surfel + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  for (uint32_t i = 0; i < corners.size(); ++i) corners[end[s.triangles[i]]++] = i;
  // Where each surfel was added last: to the list in work or to an earlier one.
  std::vector<size_t> known(s.size(), std::numeric_limits<size_t>::max());
  s.firstNeighbour.assign(1, 0);
  for (uint32_t self = 0, i = 0; self < s.size(); ++self) {
    const size_t first = s.neighbours.size();
    for (; i < end[self]; ++i) {
      const size_t k = corners[i] % 3, t = corners[i] - k;
      const glm::vec3 a = s.vertices[s.triangles[t]], b = s.vertices[s.triangles[t + 1]],
                      c = s.vertices[s.triangles[t + 2]];
      const float area = glm::length(glm::cross(b - a, c - a)) / 2;
      for (const size_t other : {(k + 1) % 3, (k + 2) % 3}) {
        const uint32_t neighbour = s.triangles[t + other];
        size_t& place = known[neighbour];
        if (place < first || place >= s.neighbours.size()) {
          place = s.neighbours.size();
          s.neighbours.push_back({neighbour, 0});
        }
        s.neighbours[place].weight += kCentroidShare * area / 3 / std::max(s.areas[self], 1e-37f);
      }
    }
    s.firstNeighbour.push_back(static_cast<uint32_t>(s.neighbours.size()));
  }
}

void placeDiscs(Surfels& s) {
  for (size_t i = 0; i < s.size(); ++i) s.positions.push_back(s.centre(i, s.vertices, s.normals[i]));
  s.discs.assign(s.size(), 0);
  for (size_t t = 0; t < s.triangles.size(); t += 3)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t self = s.triangles[t + k];
      const glm::vec3 a = s.vertices[self], b = s.vertices[s.triangles[t + (k + 1) % 3]],
                      c = s.vertices[s.triangles[t + (k + 2) % 3]];
      for (const glm::vec3& corner : {a, 0.5f * (a + b), 0.5f * (a + c), (a + b + c) / 3.f})
        s.discs[self] = std::max(s.discs[self], glm::length(corner - s.positions[self]));
    }
  // Discs that cover long triangles would rise far out of curved surfaces.
  for (size_t i = 0; i < s.size(); ++i) s.discs[i] = std::min(s.discs[i], std::sqrt(s.areas[i]));
}

}  // namespace

Surfels createSurfels(std::span<const TriangleMesh> objects, float longestEdge, double lift, size_t most) {
  Surfels surfels;
  for (uint32_t object = 0; object < objects.size(); ++object) {
    const TriangleMesh& mesh = objects[object];
    bool closed = mesh.doubleSided;
    for (const float side : {1.f, -1.f}) {
      if (side < 0 && !mesh.doubleSided) break;
      Builder builder(surfels, most, mesh, object, side);
      builder.addTriangles(longestEdge);
      builder.addClusters();
      const bool whole = builder.addPieces();
      if (!mesh.doubleSided) closed = whole;
    }
    surfels.backless.push_back(closed ? 1 : 0);
    surfels.doubleSided.push_back(mesh.doubleSided ? 1 : 0);
  }
  surfels.firstOrigin.push_back(static_cast<uint32_t>(surfels.origins.size()));
  addNeighbours(surfels);
  placeDiscs(surfels);
  Bodies(surfels, lift).leave(surfels);
  return surfels;
}

}  // namespace limn::radiosity
