// Declares what directional trees are made of: lobes, functions, and the trees of parts of a surface. A
// source says how much light goes where, and what is known of its lobes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "core/radiosity/glossy_lobes.h"
#include "core/radiosity/tree_builder.h"

namespace limn::radiosity {

/// Lobes as what a tree is made of.
struct LobeSource {
  const GlossyLobes& lobes;

  uint32_t size() const { return static_cast<uint32_t>(lobes.size()); }
  size_t rows() const { return GlossyLobes::rows(); }
  void describe(std::span<const uint32_t> which, float* to) const { lobes.describe(which, to); }
  glm::vec3 evaluate(const glm::vec3& w, std::span<const uint32_t> which, const float* descriptions,
                     float* values) const {
    return lobes.evaluate(w, which, descriptions, values);
  }
  uint64_t cost(size_t count) const { return count; }
  glm::vec3 mirror(uint32_t k) const { return lobes.mirror(k); }
  float alpha(uint32_t k) const { return lobes.alpha(k); }
  /// About the integral of the lobe's squared luminance by projected angle: brightness^2 / cos times that of
  /// the squared density of mirror directions, which for a narrow GGX is 1 / (12 pi alpha^2).
  double power(uint32_t k) const {
    const double ratio = double(lobes.brightness(k)) / double(lobes.alpha(k));
    return ratio * ratio / (12 * double(glsl::pi) * std::max(double(lobes.mirror(k).z), 0.1));
  }
};

/// A function has no lobes: nothing is kept for single ones.
struct FunctionSource {
  uint32_t size() const { return 0; }
  size_t rows() const { return 0; }
  void describe(std::span<const uint32_t>, float*) const {}
  uint64_t cost(size_t) const { return 1; }
  glm::vec3 mirror(uint32_t) const { return {}; }
  float alpha(uint32_t) const { return 1; }
  double power(uint32_t) const { return 0; }
};

struct GivenSource : FunctionSource {
  const TreeBuilder::Function& function;

  explicit GivenSource(const TreeBuilder::Function& given) : function(given) {}
  glm::vec3 evaluate(const glm::vec3& w, std::span<const uint32_t>, const float*, float*) const {
    return function(w);
  }
};

/// Whether directions have the same coordinates in two frames, but for less than cells resolve.
inline bool agree(const glsl::Frame& a, const glsl::Frame& b) {
  constexpr float kTurn = 2e-3f;
  return glm::distance(a.n, b.n) < kTurn && glm::distance(a.t, b.t) < kTurn;
}

/// What parts of a surface send where, per area of all. Smooth values are sampled: the error is that of
/// the cells' own with a third fewer cells, since their edges are none of the light's.
struct SurfaceSource : FunctionSource {
  /// The most by which light of a part counts where the surface is seen at a more grazing angle.
  static constexpr float kSteepest = 2;
  std::span<const TreePart> parts;
  const glsl::Frame& frame;
  float area;

  glm::vec3 evaluate(const glm::vec3& w, std::span<const uint32_t>, const float*, float*) const {
    const glm::vec3 out = glsl::from_local(frame, w);
    glm::vec3 sum(0);
    for (const TreePart& part : parts) {
      const glm::vec3 local = glsl::to_local(part.frame, out);
      if (local.z > 0) sum += part.area * std::min(local.z / w.z, kSteepest) * part.tree->smoothValue(local);
    }
    return sum / area;
  }
};

}  // namespace limn::radiosity
