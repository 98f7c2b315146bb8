#include "core/radiosity/bodies.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/radiosity/surfels.h"

namespace limn::radiosity {
namespace {

constexpr float kMostCells = 64;  // of a grid over a body, along each axis

/// How often a triangle turns around a point of the plane, -1, 0 or 1. Half-open, so that of triangles that
/// share an edge exactly one has a point on it.
int turns(const glm::vec2& p, const glm::vec3 (&corners)[3]) {
  int result = 0;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec2 a(corners[k]), b(corners[(k + 1) % 3]), q(p);
    const bool up = b.y > q.y;
    if ((a.y > q.y) == up) continue;
    // From the lower end, whichever triangle the edge is looked at from.
    const glm::dvec2 low = up ? a : b, high = up ? b : a;
    const bool left = (high.x - low.x) * (q.y - low.y) > (q.x - low.x) * (high.y - low.y);
    if (left) result += up ? 1 : -1;
  }
  return result;
}

/// Height of a triangle's plane over a point of its inside.
double heightAt(const glm::vec2& p, const glm::vec3 (&corners)[3]) {
  const glm::dvec3 a(corners[0]), n = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
  return n.z == 0 ? a.z : a.z - (n.x * (p.x - a.x) + n.y * (p.y - a.y)) / n.z;
}

}  // namespace

Bodies::Bodies(const Surfels& surfels, double lift)
    : lift_(static_cast<float>(lift)), objects_(surfels.backless.size()), enclosed_(surfels.size()) {
  const auto extend = [](Range& range, size_t i) {
    if (range.end == 0) range.first = static_cast<uint32_t>(i);
    range.end = static_cast<uint32_t>(i) + 1;
  };
  for (size_t i = 0; i < surfels.size(); ++i) extend(objects_[surfels.objects[i]].surfels, i);
  for (size_t i = 0; i < surfels.triangles.size(); ++i)
    extend(objects_[surfels.objects[surfels.triangles[i]]].triangles, i);
  for (size_t i = 0; i < objects_.size(); ++i) objects_[i].closed = surfels.backless[i] != 0;
}

void Bodies::leave(Surfels& surfels) {
  tbb::parallel_for(size_t{0}, objects_.size(), [&](size_t i) {
    Object& o = objects_[i];
    o.bounds = {glm::vec3(1e30f), glm::vec3(-1e30f)};
    for (uint32_t k = o.surfels.first; k < o.surfels.end; ++k) {
      o.bounds.low = glm::min(o.bounds.low, surfels.vertices[k]);
      o.bounds.high = glm::max(o.bounds.high, surfels.vertices[k]);
    }
  });
  tbb::parallel_for(size_t{0}, objects_.size(), [&](size_t i) {
    objects_[i].queries.clear();
    if (objects_[i].closed) find(surfels, objects_[i]);
  });
  waiting_.clear();
  for (const Object& body : objects_)
    for (const Query& q : body.queries)
      if (q.winding > 0 && enclosed_[q.surfel] == 0) {
        enclosed_[q.surfel] = 1;
        waiting_.push_back(q.surfel);
      }
  // From the bodies' outlines inwards, a ring of neighbours at a time.
  do {
    moves_.clear();
    for (const uint32_t i : waiting_) {
      const Surfels::Neighbour* best = nullptr;
      for (uint32_t k = surfels.firstNeighbour[i]; k < surfels.firstNeighbour[i + 1]; ++k) {
        const Surfels::Neighbour& n = surfels.neighbours[k];
        // On regular meshes weights are equal but for rounding, which must not choose.
        if (enclosed_[n.surfel] == 0 && (best == nullptr || n.weight > 1.001f * best->weight)) best = &n;
      }
      if (best != nullptr) moves_.push_back({best->surfel, i});
    }
    for (const Move& m : moves_) {
      surfels.positions[m.to] = surfels.positions[m.from];
      enclosed_[m.to] = 0;
    }
    std::erase_if(waiting_, [&](uint32_t i) { return enclosed_[i] == 0; });
  } while (!moves_.empty());
  for (const uint32_t i : waiting_) enclosed_[i] = 0;
}

void Bodies::find(const Surfels& surfels, Object& body) const {
  const auto apart = [](const Box& a, const Box& b) {
    return glm::any(glm::lessThan(a.high, b.low)) || glm::any(glm::lessThan(b.high, a.low));
  };
  for (const Object& other : objects_) {
    if (&other == &body || apart(other.bounds, body.bounds)) continue;
    for (uint32_t i = other.surfels.first; i < other.surfels.end; ++i) {
      const glm::vec3 p = surfels.positions[i] + lift_ * surfels.discs[i] * surfels.normals[i];
      if (!apart({p, p}, body.bounds)) body.queries.push_back({glm::vec2(p), p.z, i, 0});
    }
  }
  if (!body.queries.empty()) wind(surfels, body);
}

void Bodies::wind(const Surfels& surfels, Object& body) {
  const glm::vec2 low(body.bounds.low), size = glm::max(glm::vec2(body.bounds.high) - low, glm::vec2(1e-30f));
  const float n = std::clamp(std::floor(std::sqrt(static_cast<float>(body.queries.size()))), 1.f, kMostCells);
  const auto side = static_cast<uint32_t>(n);
  const auto cellOf = [&](const glm::vec2& p) {
    return glm::uvec2(glm::clamp((p - low) / size * n, glm::vec2(0), glm::vec2(n - 1)));
  };
  // Sorted by cell.
  body.firstOfCell.assign(side * side + 1, 0);
  const auto indexOf = [&](const Query& q) { return cellOf(q.place).y * side + cellOf(q.place).x; };
  for (const Query& q : body.queries) ++body.firstOfCell[indexOf(q) + 1];
  for (uint32_t i = 0; i < side * side; ++i) body.firstOfCell[i + 1] += body.firstOfCell[i];
  body.sorted.resize(body.queries.size());
  for (const Query& q : body.queries) body.sorted[body.firstOfCell[indexOf(q)]++] = q;
  body.queries.swap(body.sorted);
  // Each cell's first has become the next one's.
  const auto firstOf = [&](uint32_t cell) { return cell == 0 ? 0 : body.firstOfCell[cell - 1]; };

  for (uint32_t t = body.triangles.first; t < body.triangles.end; t += 3) {
    const glm::vec3 corners[3] = {surfels.vertices[surfels.triangles[t]],
                                  surfels.vertices[surfels.triangles[t + 1]],
                                  surfels.vertices[surfels.triangles[t + 2]]};
    const glm::uvec2 first = cellOf(glm::min(glm::min(corners[0], corners[1]), corners[2])),
                     last = cellOf(glm::max(glm::max(corners[0], corners[1]), corners[2]));
    for (uint32_t y = first.y; y <= last.y; ++y)
      for (uint32_t i = firstOf(y * side + first.x); i < body.firstOfCell[y * side + last.x]; ++i) {
        Query& q = body.queries[i];
        const int around = turns(q.place, corners);
        if (around != 0 && heightAt(q.place, corners) > q.height) q.winding += around;
      }
  }
}

}  // namespace limn::radiosity
