#include "core/radiosity/tree_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/radiosity/private/cell_refiner.h"
#include "core/radiosity/private/tree_memory.h"
#include "core/radiosity/private/tree_sources.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::radiosity {
namespace {

/// Scales each channel that the tree has at all.
void scaleToFlux(DirectionalTree& tree, const glm::vec3& wanted) {
  const glm::vec3 flux = tree.flux();
  glm::vec3 factor(1);
  for (int c = 0; c < 3; ++c)
    if (flux[c] > 0) factor[c] = wanted[c] / flux[c];
  tree.scale(factor);
}

}  // namespace

void refuseTrees(uint64_t bytes) {
  throw UsageError(
      fmt::format("light over directions takes more than the {} MiB allowed: a larger direction_error or "
                  "longest_edge, or a smaller max_level makes it less",
                  bytes >> 20));
}

struct TreeBuilder::Scratch : CellRefiner {};

TreeBuilder::TreeBuilder() : scratch_(std::make_unique<Scratch>()) {}
TreeBuilder::~TreeBuilder() = default;
TreeBuilder::TreeBuilder(TreeBuilder&&) noexcept = default;
TreeBuilder& TreeBuilder::operator=(TreeBuilder&&) noexcept = default;

uint64_t TreeBuilder::evaluations() const {
  return scratch_->evaluations;
}

double TreeBuilder::estimatedError() const {
  const Scratch& s = *scratch_;
  const bool display = s.settings.criterion == TreeSettings::Criterion::display;
  return std::sqrt(std::max(s.error, 0.0) / std::max(display ? double(glsl::pi) : s.power, 1e-300));
}

void TreeBuilder::build(const GlossyLobes& lobes, const TreeSettings& settings, DirectionalTree& tree,
                        float beside) {
  if (lobes.size() == 0) return tree.clear();
  scratch_->build(LobeSource{lobes}, settings, tree, double(beside));
  scaleToFlux(tree, lobes.flux());
}

void TreeBuilder::build(const Function& function, const TreeSettings& settings, DirectionalTree& tree) {
  scratch_->build(GivenSource(function), settings, tree);
}

void TreeBuilder::pull(std::span<const TreePart> parts, const glsl::Frame& frame,
                       const TreeSettings& settings, DirectionalTree& tree) {
  tree.clear();
  float area = 0;
  bool same = true, dark = true;
  glm::vec3 flux(0), diffuse(0);
  for (const TreePart& part : parts) {
    area += part.area;
    diffuse += part.area * part.diffuse;
    flux += part.area * part.tree->flux();
    if (part.tree->empty()) continue;
    dark = false;
    same = same && agree(part.frame, frame);
  }
  if (dark || !(area > 0)) return;
  if (same) {
    for (const TreePart& part : parts) tree.add(*part.tree, part.area / area);
    return;
  }
  scratch_->build(SurfaceSource{{}, parts, frame, area}, settings, tree,
                  double(glsl::luminance(diffuse / area)));
  scaleToFlux(tree, flux / area);
}

}  // namespace limn::radiosity
