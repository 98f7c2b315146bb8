#include "assets/generator/implicit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace limn::assets {
namespace {

constexpr int kBlock = 8;  ///< grid points a side that are skipped together when the surface is far

class Polygoniser {
 public:
  Polygoniser(const Distance& distance, glm::vec3 low, glm::vec3 high, float cell)
      : distance_(distance), low_(low), cell_(cell), size_(glm::ivec3(glm::ceil((high - low) / cell)) + 1) {
    size_ = (size_ + kBlock - 1) / kBlock * kBlock;
    values_.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                   static_cast<std::size_t>(size_.z));
  }

  Mesh run() {
    sample();
    for (int z = 0; z + 1 < size_.z; ++z) {
      for (int y = 0; y + 1 < size_.y; ++y) {
        for (int x = 0; x + 1 < size_.x; ++x) cube({x, y, z});
      }
    }
    for (int i = 0; i < 3; ++i) relax();
    computeNormals(mesh_);
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
      // Where the gradient turns faster than the triangles can follow, their own normal stays.
      const glm::vec3 n = glm::normalize(gradient(mesh_.positions[v]));
      if (glm::dot(n, mesh_.normals[v]) > 0.5f) mesh_.normals[v] = n;
    }
    mesh_.uvs.resize(mesh_.positions.size());
    return std::move(mesh_);
  }

 private:
  std::uint32_t index(glm::ivec3 c) const {
    return static_cast<std::uint32_t>((c.z * size_.y + c.y) * size_.x + c.x);
  }
  glm::vec3 point(glm::ivec3 c) const { return low_ + cell_ * glm::vec3(c); }

  template <class F>
  static void forBlock(glm::ivec3 first, const F& f) {
    for (int z = 0; z < kBlock; ++z) {
      for (int y = 0; y < kBlock; ++y) {
        for (int x = 0; x < kBlock; ++x) f(first + glm::ivec3(x, y, z));
      }
    }
  }

  void sample() {
    const float reach = 2 * 0.5f * std::sqrt(3.0f) * kBlock * cell_;
    for (int z = 0; z < size_.z; z += kBlock) {
      for (int y = 0; y < size_.y; y += kBlock) {
        for (int x = 0; x < size_.x; x += kBlock) {
          const glm::ivec3 first(x, y, z);
          const float middle = distance_(point(first) + 0.5f * kBlock * cell_);
          forBlock(first, [&](glm::ivec3 c) {
            const float d = std::abs(middle) > reach ? middle : distance_(point(c));
            values_[index(c)] = d == 0 ? 1e-7f : d;
          });
        }
      }
    }
  }

  /// The six tetrahedra around the diagonal from (0,0,0) to (1,1,1): neighbouring cubes cut their faces
  /// alike.
  void cube(glm::ivec3 c) {
    bool inside = false, outside = false;
    for (int k = 0; k < 8; ++k) {
      (values_[index(c + glm::ivec3(k & 1, k >> 1 & 1, k >> 2))] < 0 ? inside : outside) = true;
    }
    if (!inside || !outside) return;
    constexpr int axes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& order : axes) {
      std::array<glm::ivec3, 4> corner = {c, c, c, c};
      for (int k = 0; k < 3; ++k) {
        for (int j = k + 1; j < 4; ++j) corner[static_cast<std::size_t>(j)][order[k]] += 1;
      }
      tetrahedron(corner);
    }
  }

  void tetrahedron(std::array<glm::ivec3, 4> corner) {
    const auto middle = std::stable_partition(corner.begin(), corner.end(),
                                              [&](glm::ivec3 c) { return values_[index(c)] < 0; });
    const auto count = middle - corner.begin();
    if (count == 0 || count == 4) return;
    glm::vec3 inside(0), outside(0);
    for (auto it = corner.begin(); it != corner.end(); ++it) (it < middle ? inside : outside) += point(*it);
    const glm::vec3 outward = outside / static_cast<float>(4 - count) - inside / static_cast<float>(count);
    const auto cut = [&](int i, int j) {
      return vertex(corner[static_cast<std::size_t>(i)], corner[static_cast<std::size_t>(j)]);
    };
    if (count == 1) {
      triangle(cut(0, 1), cut(0, 2), cut(0, 3), outward);
    } else if (count == 3) {
      triangle(cut(0, 3), cut(1, 3), cut(2, 3), outward);
    } else {
      triangle(cut(0, 2), cut(0, 3), cut(1, 3), outward);
      triangle(cut(0, 2), cut(1, 3), cut(1, 2), outward);
    }
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, glm::vec3 outward) {
    const glm::vec3 &p = mesh_.positions[a], &q = mesh_.positions[b], &r = mesh_.positions[c];
    if (glm::dot(glm::cross(q - p, r - p), outward) < 0) std::swap(b, c);
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
  }

  std::uint32_t vertex(glm::ivec3 a, glm::ivec3 b) {
    const std::uint64_t ia = index(a), ib = index(b);
    const auto [it, fresh] = vertices_.try_emplace(std::min(ia, ib) << 32 | std::max(ia, ib),
                                                   static_cast<std::uint32_t>(mesh_.positions.size()));
    if (fresh) {
      // Away from the ends, so that no triangle loses its area.
      const float t = glm::clamp(values_[ia] / (values_[ia] - values_[ib]), 0.05f, 0.95f);
      mesh_.positions.push_back(glm::mix(point(a), point(b), t));
    }
    return it->second;
  }

  glm::vec3 gradient(glm::vec3 p) const {
    const float h = 0.25f * cell_;
    glm::vec3 g;
    for (int i = 0; i < 3; ++i) {
      glm::vec3 step(0);
      step[i] = h;
      g[i] = distance_(p + step) - distance_(p - step);
    }
    return g / (2 * h);
  }

  /// One step of Laplacian smoothing along the surface and one Newton step back onto it.
  void relax() {
    std::vector<glm::vec3> sum(mesh_.positions.size(), glm::vec3(0));
    std::vector<float> count(mesh_.positions.size(), 0);
    for (std::size_t i = 0; i < mesh_.indices.size(); i += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh_.indices[i + k], next = mesh_.indices[i + (k + 1) % 3];
        sum[v] += mesh_.positions[next];
        count[v] += 1;
      }
    }
    for (std::size_t v = 0; v < sum.size(); ++v) {
      glm::vec3& p = mesh_.positions[v];
      const glm::vec3 g = gradient(p), n = glm::normalize(g), mean = sum[v] / count[v] - p;
      p += 0.5f * (mean - n * glm::dot(n, mean));
      const float step = distance_(p) / std::max(glm::length(g), 0.3f);
      p -= n * glm::clamp(step, -0.3f * cell_, 0.3f * cell_);
    }
  }

  const Distance& distance_;
  glm::vec3 low_;
  float cell_;
  glm::ivec3 size_;
  std::vector<float> values_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
  Mesh mesh_;
};

}  // namespace

glm::vec3 mirrored(glm::vec3 p) {
  return {p.x, p.y, std::abs(p.z)};
}

float roundCone(glm::vec3 p, glm::vec3 a, glm::vec3 b, float ra, float rb) {
  const glm::vec3 ab = b - a;
  const float t = glm::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0f, 1.0f);
  return glm::distance(p, a + t * ab) - glm::mix(ra, rb, t);
}

float ellipsoid(glm::vec3 p, glm::vec3 centre, glm::vec3 radii) {
  const glm::vec3 q = (p - centre) / radii;
  const float k = glm::length(q), slope = glm::length(q / radii);
  return slope < 1e-6f ? -std::min({radii.x, radii.y, radii.z}) : k * (k - 1) / slope;
}

float smoothUnion(float a, float b, float blend) {
  const float h = std::max(blend - std::abs(a - b), 0.0f) / blend;
  return std::min(a, b) - 0.25f * h * h * blend;
}

float smoothCut(float a, float b, float blend) {
  return -smoothUnion(-a, b, blend);
}

float polylineTube(glm::vec3 p, std::span<const glm::vec3> path, std::span<const float> radii) {
  float d = 1e9f;
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    d = std::min(d, roundCone(p, path[i], path[i + 1], radii[i], radii[i + 1]));
  return d;
}

Mesh polygonise(const Distance& distance, glm::vec3 low, glm::vec3 high, float cell) {
  return Polygoniser(distance, low, high, cell).run();
}

}  // namespace limn::assets
