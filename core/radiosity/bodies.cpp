#include "core/radiosity/bodies.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/radiosity/surfels.h"
#include "glsl/numeric/language.glsl"

namespace limn::radiosity {
namespace {

constexpr float kMostCells = 64;  // of a grid over a body, along each axis
/// Pieces of less volume, as a part of their bounds' diagonal cubed, are no bodies: rooms and flat ones.
constexpr double kLeastVolume = 1e-4;
/// Elements look for their own body from this part of the way from their vertex to their disc's centre: the
/// vertex of an edge lies in the plane of the face beyond it, the centre on a hollow surface lies below it.
constexpr float kOffTheEdge = 0.1f;

using Corners = std::array<glm::vec3, 3>;

/// How often a triangle turns around a point of the plane, -1, 0 or 1. Half-open, so that of triangles that
/// share an edge exactly one has a point on it.
int turns(const glm::vec2& p, const Corners& corners) {
  int result = 0;
  for (size_t k = 0; k < 3; ++k) {
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
double heightAt(const glm::vec2& p, const Corners& corners) {
  const glm::dvec3 a(corners[0]), n = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
  return n.z == 0 ? a.z : a.z - (n.x * (p.x - a.x) + n.y * (p.y - a.y)) / n.z;
}

/// Returns the solid angle of a triangle, sr: positive where its front turns away from `p` (van Oosterom and
/// Strackee 1983).
double solidAngle(const glm::vec3& p, const Corners& corners) {
  const glm::dvec3 a(corners[0] - p), b(corners[1] - p), c(corners[2] - p);
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  return 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                        la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

/// What is known of an element, as bits.
enum : unsigned char {
  kOutside = 0,
  kInOther = 1,   ///< within a closed body that it is no part of
  kCentreIn = 2,  ///< its centre lies within its own body
  kVertexIn = 4,  ///< as does its vertex, of which nobody asks otherwise
  kWaiting = 8,   ///< for a neighbour's place
  kNext = 16,     ///< the same, beside one that has left
};

/// Returns a point above which an element sees what its vertex sees.
glm::vec3 nearVertex(const Surfels& surfels, uint32_t i) {
  return glm::mix(surfels.vertices[i], surfels.positions[i], kOffTheEdge);
}

}  // namespace

Bodies::Bodies(const Surfels& surfels, double lift)
    : lift_(static_cast<float>(lift)),
      pieces_(surfels.pieceCount),
      holes_(surfels.holeCount),
      enclosed_(surfels.size()) {
  gatherPieces(surfels);
  update(surfels);
  for (Piece& piece : pieces_) {
    const glm::dvec3 size = glm::dvec3(piece.bounds.high) - glm::dvec3(piece.bounds.low);
    piece.solid = piece.solid && volume(surfels, piece) > kLeastVolume * std::pow(glm::length(size), 3);
  }
}

void Bodies::gatherPieces(const Surfels& surfels) {
  std::vector<std::vector<uint32_t>> members(pieces_.size());
  std::vector<std::vector<Triangle>> triangles(pieces_.size());
  for (uint32_t i = 0; i < surfels.size(); ++i) members[surfels.pieces[i]].push_back(i);
  for (size_t t = 0; t < surfels.triangles.size(); t += 3)
    triangles[surfels.pieces[surfels.triangles[t]]].push_back(
        {surfels.triangles[t], surfels.triangles[t + 1], surfels.triangles[t + 2]});
  for (const Surfels::Rim& rim : surfels.rims) {
    rims_.push_back({rim.from, rim.hole});
    const uint32_t piece = surfels.pieces[rim.from];
    triangles[piece].push_back({rim.from, rim.to, static_cast<uint32_t>(surfels.size()) + rim.hole});
  }
  std::vector<uint32_t> holes(pieces_.size(), 0);
  for (const Surfels::Rim& rim : surfels.rims) ++holes[surfels.pieces[rim.from]];
  for (size_t i = 0; i < pieces_.size(); ++i) {
    pieces_[i].solid = surfels.doubleSided[surfels.objects[members[i].front()]] == 0;
    const auto append = [](auto& to, const auto& from) {
      const auto first = static_cast<uint32_t>(to.size());
      to.insert(to.end(), from.begin(), from.end());
      return Range{first, static_cast<uint32_t>(to.size())};
    };
    pieces_[i].surfels = append(order_, members[i]);
    pieces_[i].triangles = append(triangles_, triangles[i]);
    pieces_[i].firstOfHoles = pieces_[i].triangles.end - holes[i];
    fromLeft_.push_back(static_cast<uint32_t>(i));
  }
}

/// Sets the bounds of pieces, and of blocks of them, and the middles of holes.
void Bodies::update(const Surfels& surfels) {
  tbb::parallel_for(size_t{0}, pieces_.size(), [&](size_t i) {
    Piece& piece = pieces_[i];
    piece.bounds = {glm::vec3(1e30f), glm::vec3(-1e30f)};
    for (uint32_t k = piece.surfels.first; k < piece.surfels.end; ++k) {
      piece.bounds.low = glm::min(piece.bounds.low, surfels.vertices[order_[k]]);
      piece.bounds.high = glm::max(piece.bounds.high, surfels.vertices[order_[k]]);
    }
  });
  std::ranges::fill(holes_, glm::vec4(0));
  for (const Rim& rim : rims_) holes_[rim.hole] += glm::vec4(surfels.vertices[rim.surfel], 1);
  std::ranges::sort(fromLeft_, {}, [&](uint32_t i) { return pieces_[i].bounds.low.x; });
  blocks_.assign((fromLeft_.size() + kBlock - 1) / kBlock, {glm::vec3(1e30f), glm::vec3(-1e30f)});
  for (size_t i = 0; i < fromLeft_.size(); ++i) {
    Box& block = blocks_[i / kBlock];
    block.low = glm::min(block.low, pieces_[fromLeft_[i]].bounds.low);
    block.high = glm::max(block.high, pieces_[fromLeft_[i]].bounds.high);
  }
}

std::array<glm::vec3, 3> Bodies::corners(const Surfels& surfels, uint32_t triangle) const {
  Corners result;
  for (size_t k = 0; k < 3; ++k) {
    const uint32_t index = triangles_[triangle][k];
    result[k] = index < surfels.size()
                    ? surfels.vertices[index]
                    : glm::vec3(holes_[index - surfels.size()]) / holes_[index - surfels.size()].w;
  }
  return result;
}

double Bodies::volume(const Surfels& surfels, const Piece& piece) const {
  double sum = 0;
  const glm::dvec3 origin(piece.bounds.low);
  for (uint32_t t = piece.triangles.first; t < piece.triangles.end; ++t) {
    const auto [a, b, c] = corners(surfels, t);
    sum += glm::dot(glm::dvec3(a) - origin, glm::cross(glm::dvec3(b) - origin, glm::dvec3(c) - origin)) / 6;
  }
  return sum;
}

void Bodies::leave(Surfels& surfels) {
  update(surfels);
  tbb::parallel_for(size_t{0}, pieces_.size(), [&](size_t i) {
    pieces_[i].inside.clear();
    if (pieces_[i].solid) find(surfels, pieces_[i]);
  });
  for (const Piece& body : pieces_)
    for (const Query& q : body.inside) enclosed_[q.surfel] |= q.bit;
  waiting_.clear();
  for (const Piece& body : pieces_)
    for (const Query& q : body.inside) {
      unsigned char& state = enclosed_[q.surfel];
      if (state == kOutside || state == kWaiting) continue;
      if (state == kCentreIn) {
        surfels.positions[q.surfel] = nearVertex(surfels, q.surfel);
        state = kOutside;
      } else {
        state = kWaiting;
        waiting_.push_back(q.surfel);
      }
    }
  // From the bodies' outlines inwards, a ring of neighbours at a time: those beside what has left last.
  ring_ = waiting_;
  while (!ring_.empty()) {
    moves_.clear();
    for (const uint32_t i : ring_) {
      const Surfels::Neighbour* best = nullptr;
      for (const Surfels::Neighbour& n : surfels.neighboursOf(i))
        // On regular meshes weights are equal but for rounding, which must not choose.
        if (enclosed_[n.surfel] == kOutside && (best == nullptr || n.weight > 1.001f * best->weight))
          best = &n;
      if (best != nullptr) moves_.push_back({best->surfel, i});
    }
    ring_.clear();
    for (const Move& m : moves_) {
      surfels.positions[m.to] = surfels.positions[m.from];
      enclosed_[m.to] = kOutside;
    }
    for (const Move& m : moves_)
      for (const Surfels::Neighbour& n : surfels.neighboursOf(m.to)) {
        if (enclosed_[n.surfel] != kWaiting) continue;
        enclosed_[n.surfel] = kNext;
        ring_.push_back(n.surfel);
      }
  }
  for (const uint32_t i : waiting_) enclosed_[i] = kOutside;
}

void Bodies::find(const Surfels& surfels, Piece& body) const {
  const auto apart = [](const Box& a, const Box& b) {
    return glm::any(glm::lessThan(a.high, b.low)) || glm::any(glm::lessThan(b.high, a.low));
  };
  const auto ask = [&](uint32_t i, const glm::vec3& from, unsigned char bit) {
    const glm::vec3 p = from + lift_ * surfels.discs[i] * surfels.normals[i];
    if (!apart({p, p}, body.bounds)) body.queries.push_back({glm::vec2(p), p.z, i, 0, bit});
  };
  const auto answer = [&] {
    if (body.queries.empty()) return;
    wind(surfels, body);
    if (body.open()) leaveHoles(surfels, body);
    std::erase_if(body.queries, [](const Query& q) { return q.winding <= 0; });
    body.inside.insert(body.inside.end(), body.queries.begin(), body.queries.end());
    body.queries.clear();
  };
  const auto askPiece = [&](const Piece& piece) {
    const bool own = &piece == &body;
    if ((!own && body.open()) || apart(piece.bounds, body.bounds)) return;
    for (uint32_t k = piece.surfels.first; k < piece.surfels.end; ++k)
      ask(order_[k], surfels.positions[order_[k]], own ? kCentreIn : kInOther);
  };
  for (size_t first = 0; first < fromLeft_.size(); first += kBlock) {
    if (pieces_[fromLeft_[first]].bounds.low.x > body.bounds.high.x) break;
    if (apart(blocks_[first / kBlock], body.bounds)) continue;
    for (size_t i = first; i < std::min(first + kBlock, fromLeft_.size()); ++i)
      askPiece(pieces_[fromLeft_[i]]);
  }
  answer();
  for (const Query& q : body.inside)
    if (q.bit == kCentreIn) ask(q.surfel, nearVertex(surfels, q.surfel), kVertexIn);
  answer();
}

/// Lets out what lies where the generalized winding number of an open body, which is that of the body with
/// its holes closed but for what the holes take of the sphere of directions, is at most a half.
void Bodies::leaveHoles(const Surfels& surfels, Piece& body) const {
  for (Query& q : body.queries) {
    if (q.winding <= 0) continue;
    double sphere = 0;
    for (uint32_t t = body.firstOfHoles; t < body.triangles.end; ++t)
      sphere += solidAngle(glm::vec3(q.place, q.height), corners(surfels, t)) / (4 * glsl::pi);
    if (q.winding - sphere <= 0.5) q.winding = 0;
  }
}

void Bodies::wind(const Surfels& surfels, Piece& body) const {
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

  for (uint32_t t = body.triangles.first; t < body.triangles.end; ++t) {
    const Corners at = corners(surfels, t);
    const glm::vec2 from = glm::min(glm::min(at[0], at[1]), at[2]),
                    to = glm::max(glm::max(at[0], at[1]), at[2]);
    const glm::uvec2 first = cellOf(from), last = cellOf(to);
    for (uint32_t y = first.y; y <= last.y; ++y)
      for (uint32_t i = firstOf(y * side + first.x); i < body.firstOfCell[y * side + last.x]; ++i) {
        Query& q = body.queries[i];
        if (q.place.x < from.x || q.place.x > to.x || q.place.y < from.y || q.place.y > to.y) continue;
        const int around = turns(q.place, at);
        if (around != 0 && heightAt(q.place, at) > q.height) q.winding += around;
      }
  }
}

}  // namespace limn::radiosity
