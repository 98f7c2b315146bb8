#include "core/scene/charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <queue>
#include <unordered_map>
#include <utility>

namespace limn::scene {
namespace {

using glm::vec2;
using glm::vec3;

constexpr uint32_t kNobody = std::numeric_limits<uint32_t>::max();
constexpr double kFlat = 1e-6;        ///< height of a triangle over its longest side: less has no direction
constexpr double kCells = 512;        ///< across a body, where layers of a chart are told apart
constexpr double kMostCells = 4e6;    ///< of all triangles together
constexpr float kBack = -0.999f;      ///< cosine between two faces of which one is the other's back
constexpr float kLayer = 8;           ///< cells by which one layer lies over another; slopes make less
constexpr float kLeastOwn = 0.2f;     ///< cosine between a chart's axis and its own triangles
constexpr float kLeastAround = 0.1f;  ///< and those around it
constexpr double kSmallChart = 1 / 64.0;  ///< of a body's area: smaller ones are given to their neighbours

float alongAxis(const vec3& v, int axis) {
  const float value = v[axis % 3];
  return axis < 3 ? value : -value;
}

int axisOf(const vec3& normal) {
  int axis = 0;
  for (int i = 1; i < 6; ++i)
    if (alongAxis(normal, i) > alongAxis(normal, axis)) axis = i;
  return axis;
}

/// Holds triangles, and which share an edge.
class TriangleSurface {
 public:
  TriangleSurface(std::span<const vec3> positions, std::span<const uint32_t> indices)
      : positions_(positions), indices_(indices), triangles_(indices.size() / 3) {
    for (uint32_t t = 0; t < triangles_.size(); ++t) {
      const vec3 a = corner(t, 0);
      const glm::dvec3 crossed =
          glm::cross(glm::dvec3(corner(t, 1)) - glm::dvec3(a), glm::dvec3(corner(t, 2)) - glm::dvec3(a));
      const double length = glm::length(crossed);
      if (!(length > kFlat * longestSquare(t)) || !std::isfinite(length)) continue;
      triangles_[t].area = 0.5 * length;
      triangles_[t].normal = vec3(crossed / length);
      area_ += triangles_[t].area;
    }
    link();
  }

  size_t size() const { return triangles_.size(); }
  double longestSquare(uint32_t t) const {
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 edge = glm::dvec3(corner(t, (k + 1) % 3)) - glm::dvec3(corner(t, k));
      longest = std::max(longest, glm::dot(edge, edge));
    }
    return longest;
  }
  double area() const { return area_; }
  double area(uint32_t t) const { return triangles_[t].area; }
  bool flat(uint32_t t) const { return !(triangles_[t].area > 0); }
  const vec3& normal(uint32_t t) const { return triangles_[t].normal; }
  const vec3& corner(uint32_t t, int k) const {
    return positions_[indices_[3 * static_cast<size_t>(t) + static_cast<size_t>(k)]];
  }
  vec3 centre(uint32_t t) const { return (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.f; }
  /// Calls `take` with each triangle that has an edge in common with `t`, and the edge's length.
  template <class Take>
  void forNeighbours(uint32_t t, Take&& take) const {
    for (int k = 0; k < 3; ++k) {
      const uint32_t other = neighbours_[3 * static_cast<size_t>(t) + static_cast<size_t>(k)];
      if (other != kNobody) take(other, glm::distance(corner(t, k), corner(t, (k + 1) % 3)));
    }
  }

 private:
  struct Triangle {
    vec3 normal{0};
    double area = 0;
  };

  /// Finds neighbours. Vertices at one place are one, as those at seams of normals are.
  void link() {
    std::vector<uint32_t> order(positions_.size()), place(positions_.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto less = [&](uint32_t a, uint32_t b) {
      const vec3 &p = positions_[a], &q = positions_[b];
      return std::array{p.x, p.y, p.z} < std::array{q.x, q.y, q.z};
    };
    // NaN has no order; triangles with such corners have no area and are not linked.
    std::erase_if(order, [&](uint32_t v) {
      return glm::any(glm::isnan(positions_[v])) || glm::any(glm::isinf(positions_[v]));
    });
    std::ranges::sort(order, less);
    for (size_t i = 0; i < order.size(); ++i) {
      const bool same = i > 0 && positions_[order[i]] == positions_[order[i - 1]];
      place[order[i]] = same ? place[order[i - 1]] : order[i];
    }
    neighbours_.assign(indices_.size(), kNobody);
    // Edges that one triangle has so far. A triangle and its own back face are no neighbours.
    std::unordered_multimap<uint64_t, size_t> open;
    for (size_t i = 0; i < 3 * triangles_.size(); ++i) {
      if (flat(static_cast<uint32_t>(i / 3))) continue;
      const uint64_t a = place[indices_[i]], b = place[indices_[i % 3 == 2 ? i - 2 : i + 1]];
      const uint64_t edge = std::min(a, b) << 32 | std::max(a, b);
      auto [found, end] = open.equal_range(edge);
      while (found != end && glm::dot(triangles_[i / 3].normal, triangles_[found->second / 3].normal) < kBack)
        ++found;
      if (found == end) {
        open.emplace(edge, i);
        continue;
      }
      neighbours_[i] = static_cast<uint32_t>(found->second / 3);
      neighbours_[found->second] = static_cast<uint32_t>(i / 3);
      open.erase(found);
    }
  }

  std::span<const vec3> positions_;
  std::span<const uint32_t> indices_;
  std::vector<Triangle> triangles_;
  std::vector<uint32_t> neighbours_;
  double area_ = 0;
};

/// Tells layers of a surface apart that lie over each other, seen along an axis.
class Layers {
 public:
  Layers(const TriangleSurface& surface, int axis, float cell)
      : surface_(surface), axis_(axis), cell_(cell) {}

  /// Adds a triangle unless it lies over or under one that was added.
  bool add(uint32_t t) {
    covered_.clear();
    cover(t);
    for (const auto& [cell, height] : covered_) {
      const auto found = heights_.find(cell);
      if (found != heights_.end() && std::abs(found->second - height) > kLayer * cell_) return false;
    }
    heights_.insert(covered_.begin(), covered_.end());
    return true;
  }

 private:
  /// Finds the cells whose centres a triangle covers, and that of its own centre.
  void cover(uint32_t t) {
    std::array<vec2, 3> p;
    vec2 low(std::numeric_limits<float>::max()), high = -low;
    for (int k = 0; k < 3; ++k) {
      p[static_cast<size_t>(k)] = acrossAxis(surface_.corner(t, k), axis_) / cell_;
      low = glm::min(low, p[static_cast<size_t>(k)]);
      high = glm::max(high, p[static_cast<size_t>(k)]);
    }
    const vec3 centre = surface_.centre(t);
    add(glm::ivec2(glm::floor(acrossAxis(centre, axis_) / cell_)), alongAxis(centre, axis_));
    const vec2 e = p[1] - p[0], f = p[2] - p[0];
    const float area = e.x * f.y - e.y * f.x;
    if (area == 0) return;
    for (int y = static_cast<int>(std::floor(low.y)); y <= static_cast<int>(high.y); ++y) {
      const auto [from, to] = acrossRow(p, static_cast<float>(y) + 0.5f);
      if (from > to) continue;
      for (int x = static_cast<int>(std::floor(std::max(from - 1, low.x)));
           x <= static_cast<int>(std::min(to + 1, high.x)); ++x) {
        const vec2 d = vec2(x, y) + 0.5f - p[0];
        const float u = (d.x * f.y - d.y * f.x) / area, v = (e.x * d.y - e.y * d.x) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const float height = (1 - u - v) * alongAxis(surface_.corner(t, 0), axis_) +
                             u * alongAxis(surface_.corner(t, 1), axis_) +
                             v * alongAxis(surface_.corner(t, 2), axis_);
        add({x, y}, height);
      }
    }
  }
  /// Returns between which x a triangle lies at this y, the first above the second where it does not: long
  /// narrow ones take few of the cells around them.
  static std::pair<float, float> acrossRow(const std::array<vec2, 3>& p, float y) {
    float from = std::numeric_limits<float>::max(), to = -from;
    for (size_t k = 0; k < 3; ++k) {
      const vec2 &a = p[k], &b = p[(k + 1) % 3];
      if (a.y == b.y || std::min(a.y, b.y) > y || std::max(a.y, b.y) < y) continue;
      const float x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
      from = std::min(from, x);
      to = std::max(to, x);
    }
    return {from, to};
  }
  void add(const glm::ivec2& cell, float height) {
    const auto key =
        static_cast<uint64_t>(static_cast<uint32_t>(cell.y)) << 32 | static_cast<uint32_t>(cell.x);
    covered_.emplace_back(key, height);
  }

  const TriangleSurface& surface_;
  int axis_;
  float cell_;
  std::unordered_map<uint64_t, float> heights_;
  std::vector<std::pair<uint64_t, float>> covered_;
};

/// Gives each triangle an axis: its own, or for small islands that of the surface around them.
class Axes {
 public:
  explicit Axes(const TriangleSurface& surface)
      : surface_(surface), axis_(surface.size()), island_(surface.size(), kNobody) {
    for (uint32_t t = 0; t < surface.size(); ++t) axis_[t] = axisOf(surface.normal(t));
    for (uint32_t t = 0; t < surface.size(); ++t)
      if (!surface.flat(t) && island_[t] == kNobody) flood(t);
    std::vector<uint32_t> order(islands_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](uint32_t i) { return islands_[i].area; });
    for (const uint32_t i : order)
      if (islands_[i].area < kSmallChart * surface.area()) giveAway(i);
  }

  int operator[](uint32_t t) const { return axis_[t]; }

 private:
  struct Island {
    std::vector<uint32_t> triangles;
    double area = 0;
    int axis = 0;
  };

  void flood(uint32_t first) {
    const auto index = static_cast<uint32_t>(islands_.size());
    Island island;
    island.axis = axis_[first];
    island_[first] = index;
    island.triangles.push_back(first);
    for (size_t i = 0; i < island.triangles.size(); ++i) {
      const uint32_t t = island.triangles[i];
      island.area += surface_.area(t);
      surface_.forNeighbours(t, [&](uint32_t other, float) {
        if (island_[other] != kNobody || axis_[other] != island.axis) return;
        island_[other] = index;
        island.triangles.push_back(other);
      });
    }
    islands_.push_back(std::move(island));
  }

  /// Joins an island to the one with which it has the longest border, if all of it can be seen along its
  /// axis.
  void giveAway(uint32_t index) {
    std::unordered_map<uint32_t, float> borders;
    for (const uint32_t t : islands_[index].triangles)
      surface_.forNeighbours(t, [&](uint32_t other, float length) {
        if (island_[other] != index) borders[island_[other]] += length;
      });
    uint32_t best = kNobody;
    for (const auto& [other, length] : borders) {
      const bool better =
          best == kNobody || length > borders[best] || (length == borders[best] && other < best);
      if (better && std::ranges::all_of(islands_[index].triangles, [&](uint32_t t) {
            return alongAxis(surface_.normal(t), islands_[other].axis) > kLeastOwn;
          }))
        best = other;
    }
    if (best == kNobody) return;
    Island &to = islands_[best], &from = islands_[index];
    for (const uint32_t t : from.triangles) {
      island_[t] = best;
      axis_[t] = to.axis;
    }
    to.triangles.insert(to.triangles.end(), from.triangles.begin(), from.triangles.end());
    to.area += from.area;
    from = {};
  }

  const TriangleSurface& surface_;
  std::vector<int> axis_;
  std::vector<uint32_t> island_;
  std::vector<Island> islands_;
};

/// Adds to a chart what lies around it on the surface within `margin` of its border.
void addSurroundings(const TriangleSurface& surface, double margin, std::span<const uint32_t> chartOf,
                     uint32_t index, Layers& layers, Chart& chart) {
  struct Reached {
    float distance;
    uint32_t triangle;
    bool operator<(const Reached& other) const { return distance > other.distance; }
  };
  std::priority_queue<Reached> queue;
  std::unordered_map<uint32_t, float> distances;
  const auto reach = [&](uint32_t t, float distance) {
    if (chartOf[t] == index || distance > margin) return;
    if (alongAxis(surface.normal(t), chart.axis) < kLeastAround) return;
    const auto [found, added] = distances.try_emplace(t, distance);
    if (!added && found->second <= distance) return;
    found->second = distance;
    queue.push({distance, t});
  };
  for (const uint32_t t : chart.triangles)
    surface.forNeighbours(t, [&](uint32_t other, float) { reach(other, 0); });
  while (!queue.empty()) {
    const auto [distance, t] = queue.top();
    queue.pop();
    if (distances[t] < distance) continue;
    if (!layers.add(t)) continue;
    chart.surroundings.push_back(t);
    surface.forNeighbours(t, [&](uint32_t other, float) {
      reach(other, distance + glm::distance(surface.centre(t), surface.centre(other)));
    });
  }
}

void measureChart(const TriangleSurface& surface, Chart& chart) {
  vec2 low(std::numeric_limits<float>::max()), high = -low;
  for (const auto* triangles : {&chart.triangles, &chart.surroundings})
    for (const uint32_t t : *triangles)
      for (int k = 0; k < 3; ++k) {
        const vec2 p = acrossAxis(surface.corner(t, k), chart.axis);
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
  chart.lowest = low;
  chart.size = high - low;
}

/// Places the charts at this many texels per metre, highest first, in rows. Returns whether they fit.
bool placeInRows(std::vector<Chart>& charts, std::span<const uint32_t> order, int texels, double scale) {
  glm::ivec2 next(0);
  int height = 0;
  for (const uint32_t i : order) {
    const glm::dvec2 wanted = glm::ceil(glm::dvec2(charts[i].size) * scale) + 2.0;
    if (!(wanted.x <= texels && wanted.y <= texels)) return false;
    const glm::ivec2 size(wanted);
    if (next.x + size.x > texels) {
      next = {0, next.y + height};
      height = 0;
    }
    charts[i].corner = next + 1;
    next.x += size.x;
    height = std::max(height, size.y);
    if (next.y + height > texels) return false;
  }
  return true;
}

}  // namespace

glm::vec2 acrossAxis(const glm::vec3& point, int axis) {
  return {point[(axis + 1) % 3], point[(axis + 2) % 3]};
}

std::optional<std::vector<Chart>> makeCharts(std::span<const glm::vec3> positions,
                                             std::span<const uint32_t> indices, double margin,
                                             const ChartLimits& most) {
  const TriangleSurface surface(positions, indices);
  vec3 low(std::numeric_limits<float>::max()), high = -low;
  for (uint32_t t = 0; t < surface.size(); ++t)
    for (int k = 0; k < 3 && !surface.flat(t); ++k) {
      low = glm::min(low, surface.corner(t, k));
      high = glm::max(high, surface.corner(t, k));
    }
  const Axes axes(surface);
  const vec3 extent = high - low;
  const auto cell =
      static_cast<float>(std::max(static_cast<double>(std::max({extent.x, extent.y, extent.z})) / kCells,
                                  std::sqrt(surface.area() / kMostCells)));
  std::vector<Chart> charts;
  std::vector<uint32_t> chartOf(surface.size(), kNobody);
  size_t triangles = surface.size();
  for (uint32_t first = 0; first < surface.size(); ++first) {
    if (surface.flat(first) || chartOf[first] != kNobody) continue;
    const auto index = static_cast<uint32_t>(charts.size());
    if (index >= most.charts) return std::nullopt;
    Chart chart;
    chart.axis = axes[first];
    Layers own(surface, chart.axis, cell);
    std::deque<uint32_t> queue{first};
    while (!queue.empty()) {
      const uint32_t t = queue.front();
      queue.pop_front();
      if (chartOf[t] != kNobody || !own.add(t)) continue;
      chartOf[t] = index;
      chart.triangles.push_back(t);
      surface.forNeighbours(t, [&](uint32_t other, float) {
        if (chartOf[other] == kNobody && axes[other] == chart.axis) queue.push_back(other);
      });
    }
    addSurroundings(surface, margin, chartOf, index, own, chart);
    triangles += chart.surroundings.size();
    if (triangles > most.triangles) return std::nullopt;
    measureChart(surface, chart);
    charts.push_back(std::move(chart));
  }
  return charts;
}

double packCharts(std::vector<Chart>& charts, int texels) {
  std::vector<uint32_t> order(charts.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, std::ranges::greater(), [&](uint32_t i) { return charts[i].size.y; });
  double largest = 0;
  for (const Chart& chart : charts)
    largest = std::max({largest, static_cast<double>(chart.size.x), static_cast<double>(chart.size.y)});
  if (!(largest > 0)) return 0;
  double fits = 0, fails = texels / largest;
  for (int i = 0; i < 24; ++i) {
    const double scale = 0.5 * (fits + fails);
    (placeInRows(charts, order, texels, scale) ? fits : fails) = scale;
  }
  if (!(fits > 0) || !placeInRows(charts, order, texels, fits)) return 0;
  return fits;
}

}  // namespace limn::scene
