#include "core/scene/metaballs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "glsl/numeric/geometry.glsl"

namespace limn::scene {
namespace {

constexpr double kPeriod = 12;  ///< seconds after which every path closes

/// The kernel (1 - d^2 / R^2)^3 reaches R = 2 radius and has this value at half of that, where the surface of
/// a lone ball is.
constexpr float kThreshold = 27.f / 64.f;

/// Uniform in [0, 1), in a sequence that `state` goes through. PCG-RXS-M-XS (O'Neill 2014).
double uniform(uint32_t& state) {
  state = state * 747796405u + 2891336453u;
  const uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return static_cast<double>((word >> 22u) ^ word) * 0x1p-32;
}

/// A Lissajous figure in [-1, 1]^3.
struct Path {
  std::array<double, 3> frequency{}, phase{};

  glm::vec3 at(double time) const {
    glm::vec3 p;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double turns = frequency[k] * std::fmod(time, kPeriod) / kPeriod + phase[k];
      p[i] = static_cast<float>(std::sin(2 * std::numbers::pi * turns));
    }
    return p;
  }
};

class MetaballSource final : public GeometrySource {
 public:
  explicit MetaballSource(const Metaballs& settings)
      : settings_(settings),
        points_(settings.resolution + 1),
        reach_(2 * settings.radius),
        normalToWorld_(glm::inverse(glm::transpose(glm::dmat3(glm::dmat4(settings.toWorld))))),
        axis_(glm::normalize(glm::dvec3(settings.toWorld[1]))) {
    uint32_t state = settings.seed * 2654435769u + 1u;
    paths_.resize(static_cast<std::size_t>(settings.count));
    for (Path& path : paths_)
      for (std::size_t i = 0; i < 3; ++i) {
        path.frequency[i] = 1 + std::floor(3 * uniform(state));
        path.phase[i] = uniform(state);
      }
    centres_.resize(paths_.size());
    const auto layer = static_cast<std::size_t>(points_) * static_cast<std::size_t>(points_);
    values_.resize(layer * static_cast<std::size_t>(points_));
    for (auto& vertices : vertices_) vertices.resize(8 * layer);
  }

  std::shared_ptr<const Primitive> at(double time) override {
    if (last_ && time == time_) return last_;
    time_ = time;
    primitive_ = free();
    primitive_->positions.clear();
    primitive_->normals.clear();
    primitive_->tangents.clear();
    primitive_->indices.clear();
    for (std::size_t i = 0; i < paths_.size(); ++i) centres_[i] = (1 - reach_) * paths_[i].at(time);
    fillValues();
    march();
    last_ = std::move(primitive_);
    return last_;
  }

 private:
  /// One that nobody holds any more.
  std::shared_ptr<Primitive> free() {
    last_ = nullptr;
    for (const auto& primitive : pool_)
      if (primitive.use_count() == 1) return primitive;
    auto fresh = std::make_shared<Primitive>();
    const auto side = static_cast<std::size_t>(settings_.resolution);
    fresh->positions.reserve(24 * side * side);
    fresh->normals.reserve(24 * side * side);
    if (settings_.tangents) fresh->tangents.reserve(24 * side * side);
    fresh->indices.reserve(3 * 48 * side * side);
    return pool_.emplace_back(std::move(fresh));
  }

  glm::vec3 place(const glm::ivec3& c) const {
    return 2.f / static_cast<float>(settings_.resolution) * glm::vec3(c) - 1.f;
  }
  std::size_t index(const glm::ivec3& c) const {
    return static_cast<std::size_t>((c.z * points_ + c.y) * points_ + c.x);
  }

  /// The field minus the threshold: positive inside.
  void fillValues() {
    std::fill(values_.begin(), values_.end(), -kThreshold);
    for (const glm::vec3& centre : centres_) {
      const float scale = 0.5f * static_cast<float>(settings_.resolution);
      const glm::ivec3 low = glm::max(glm::ivec3(glm::ceil(scale * (centre - reach_ + 1.f))), 0);
      const glm::ivec3 high =
          glm::min(glm::ivec3(glm::floor(scale * (centre + reach_ + 1.f))), settings_.resolution);
      for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
          for (int x = low.x; x <= high.x; ++x) {
            const glm::vec3 offset = place({x, y, z}) - centre;
            const float k = std::max(1.f - glm::dot(offset, offset) / (reach_ * reach_), 0.f);
            values_[index({x, y, z})] += k * k * k;
          }
    }
  }

  /// Downwards along the field: out of the solid.
  glm::vec3 outward(const glm::vec3& p) const {
    glm::vec3 sum(0);
    for (const glm::vec3& centre : centres_) {
      const glm::vec3 offset = p - centre;
      const float k = std::max(1.f - glm::dot(offset, offset) / (reach_ * reach_), 0.f);
      sum += k * k * offset;
    }
    return sum == glm::vec3(0) ? glm::vec3(0, 1, 0) : sum;
  }

  void march() {
    std::fill(vertices_[0].begin(), vertices_[0].end(), kNoVertex);
    for (int z = 0; z < settings_.resolution; ++z) {
      auto& above = vertices_[static_cast<std::size_t>((z + 1) & 1)];
      std::fill(above.begin(), above.end(), kNoVertex);
      for (int y = 0; y < settings_.resolution; ++y)
        for (int x = 0; x < settings_.resolution; ++x) cube({x, y, z});
    }
  }

  /// The six tetrahedra around the diagonal from (0,0,0) to (1,1,1): neighbouring cubes cut their faces
  /// alike.
  void cube(const glm::ivec3& c) {
    int inside = 0;
    for (int k = 0; k < 8; ++k)
      inside += values_[index(c + glm::ivec3(k & 1, k >> 1 & 1, k >> 2))] > 0 ? 1 : 0;
    if (inside == 0 || inside == 8) return;
    constexpr int axes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& order : axes) {
      std::array<glm::ivec3, 4> corner = {c, c, c, c};
      for (int k = 0; k < 3; ++k)
        for (std::size_t j = static_cast<std::size_t>(k) + 1; j < 4; ++j) corner[j][order[k]] += 1;
      tetrahedron(corner);
    }
  }

  /// Corners in rising order, each a step along one axis from the one before.
  void tetrahedron(const std::array<glm::ivec3, 4>& corner) {
    std::array<std::size_t, 4> order{};  // those inside first
    std::size_t in = 0, out = 4;
    for (std::size_t k = 0; k < 4; ++k) (values_[index(corner[k])] > 0 ? order[in++] : order[--out]) = k;
    const auto cut = [&](std::size_t i, std::size_t j) {
      const auto [a, b] = std::minmax(order[i], order[j]);
      return vertex(corner[a], corner[b]);
    };
    if (in == 0 || in == 4) return;
    glm::vec3 inside(0), outside(0);
    for (std::size_t k = 0; k < 4; ++k) (k < in ? inside : outside) += place(corner[order[k]]);
    const glm::vec3 away = glm::mat3(settings_.toWorld) *
                           (outside / static_cast<float>(4 - in) - inside / static_cast<float>(in));
    if (in == 1) triangle(cut(0, 1), cut(0, 2), cut(0, 3), away);
    if (in == 3) triangle(cut(0, 3), cut(1, 3), cut(2, 3), away);
    if (in != 2) return;
    triangle(cut(0, 2), cut(0, 3), cut(1, 3), away);
    triangle(cut(0, 2), cut(1, 3), cut(1, 2), away);
  }

  /// The front side is towards `outward`.
  void triangle(uint32_t a, uint32_t b, uint32_t c, const glm::vec3& outward) {
    const auto& p = primitive_->positions;
    if (glm::dot(glm::cross(p[b] - p[a], p[c] - p[a]), outward) < 0.f) std::swap(b, c);
    for (const uint32_t v : {a, b, c}) primitive_->indices.push_back(v);
  }

  /// Where the surface cuts the edge from a to b, the upper corner of the two.
  uint32_t vertex(const glm::ivec3& a, const glm::ivec3& b) {
    const glm::ivec3 step = b - a;
    const auto at = static_cast<std::size_t>(8 * (a.y * points_ + a.x) + step.x + 2 * step.y + 4 * step.z);
    uint32_t& known = vertices_[static_cast<std::size_t>(a.z & 1)][at];
    if (known != kNoVertex) return known;
    known = static_cast<uint32_t>(primitive_->positions.size());
    const float va = values_[index(a)], vb = values_[index(b)];
    // Away from the ends, so that no triangle loses its area.
    const glm::vec3 p = glm::mix(place(a), place(b), std::clamp(va / (va - vb), 0.05f, 0.95f));
    primitive_->positions.emplace_back(settings_.toWorld * glm::vec4(p, 1));
    const glm::vec3 normal(glm::normalize(normalToWorld_ * glm::dvec3(outward(p))));
    primitive_->normals.push_back(normal);
    if (settings_.tangents)
      primitive_->tangents.emplace_back(glsl::frame_along(normal, glm::cross(axis_, normal)).t, 1.f);
    return known;
  }

  static constexpr uint32_t kNoVertex = ~0u;

  Metaballs settings_;
  int points_;   ///< along a side
  float reach_;  ///< of a ball's field
  glm::dmat3 normalToWorld_;
  glm::vec3 axis_;  ///< Y of the cube, in the world
  std::vector<Path> paths_;
  std::vector<glm::vec3> centres_;
  std::vector<float> values_;
  std::array<std::vector<uint32_t>, 2> vertices_;  ///< of edges by their lower corner, two layers in turn
  std::vector<std::shared_ptr<Primitive>> pool_;
  std::shared_ptr<Primitive> primitive_;  ///< in the making
  std::shared_ptr<const Primitive> last_;
  double time_ = 0;
};

}  // namespace

std::shared_ptr<GeometrySource> makeMetaballs(const Metaballs& settings) {
  return std::make_shared<MetaballSource>(settings);
}

}  // namespace limn::scene
