// Declares how directional trees are made: refined where the light changes.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "core/base/export.h"
#include "core/radiosity/directional_tree.h"
#include "core/radiosity/glossy_lobes.h"
#include "glsl/numeric/geometry.glsl"

namespace limn::radiosity {

struct TreeSettings {
  /// Says which cell is split next, and when it is enough.
  enum class Criterion : uint8_t {
    transport,  ///< the worst first, until the relative L2 error of the radiance is below `error`
    display,    ///< the same, with errors relative to the radiance of their direction
    relative,   ///< each while (max - min) / centre of its samples exceeds `error` (as published, with 0.5)
  };
  /// Says what values stand for.
  enum class Basis : uint8_t {
    haar,     ///< cells, as many as the criterion asks for
    uniform,  ///< corners of level maxLevel, at most DirectionalTree::kMaxUniformLevel; nothing else counts
  };
  Basis basis = Basis::haar;
  Criterion criterion = Criterion::transport;
  float error = 0.1f;  ///< more than 0
  int minLevel = 2;    ///< every cell has this level at least; 0 to maxLevel
  int maxLevel = 8;    ///< no cell has more; 0 to 10. The same as minLevel: one level
  bool frozen = true;  ///< lobes that are linear over a cell are no longer evaluated in it
  /// Bytes that a tree may take while it is built, with all that is kept for it; more throw UsageError.
  uint64_t memory = uint64_t{1} << 30;
  bool operator==(const TreeSettings&) const = default;
};

/// One of the surfaces whose light is summed up.
struct TreePart {
  const DirectionalTree* tree;
  glsl::Frame frame;     ///< of the tree's directions; n: the normal
  float area;            ///< of the surface
  glm::vec3 diffuse{0};  ///< radiance beside the tree's, the same in all directions above the surface
};

/// Builds trees. Keeps its working memory, so that a thread should use one for many trees.
class LIMN_API TreeBuilder {
 public:
  TreeBuilder();
  ~TreeBuilder();
  TreeBuilder(TreeBuilder&&) noexcept;
  TreeBuilder& operator=(TreeBuilder&&) noexcept;

  /// Builds the tree of the lobes over the hemisphere, with their flux exactly. Errors are relative to this
  /// light and what leaves `beside` it, the same in all directions (luminance, W/(sr m^2)): the gloss of
  /// bright paint needs fewer cells than that of metal.
  void build(const GlossyLobes& lobes, const TreeSettings& settings, DirectionalTree& tree, float beside = 0);

  using Function = std::function<glm::vec3(const glm::vec3& direction)>;
  /// Builds the tree of a function of unit directions over the hemisphere.
  void build(const Function& function, const TreeSettings& settings, DirectionalTree& tree);

  /// Builds the radiance that stands for all parts of a surface whose normals about agree: its flux is
  /// theirs. `frame`: of the result; diffuse radiance is left out, but counts for errors. Parts in that same
  /// frame give their cells, of others the light (times its cosine) is sampled again.
  void pull(std::span<const TreePart> parts, const glsl::Frame& frame, const TreeSettings& settings,
            DirectionalTree& tree);

  /// Returns the estimate of the relative error of the last tree that was built, by the criterion's measure.
  double estimatedError() const;
  /// Returns how many lobes (or functions) were evaluated since the builder was made, each direction for one.
  uint64_t evaluations() const;

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace limn::radiosity
