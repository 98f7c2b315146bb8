// Declares links of surface elements in bins of directions, each the shortest of its bin. They say what a
// point sees, and visibility is found while links are made (implicit visibility, thesis, sections 4.2.1 and
// 4.3.2).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/radiosity/forest.h"

namespace limn::radiosity {

/// Says which bins an element fills.
enum class Fill {
  centre,     ///< the one in which its centre lies, wholly (as published)
  footprint,  ///< those whose centres its disc covers
  /// Of a leaf: those whose centres its triangles cover, each bin for the corner that is nearest to what it
  /// meets; of elements above: as footprint. Takes a forest of LeafShape::triangles.
  triangles,
};

struct LinkSettings {
  int resolution = 16;  ///< N of the 6 x N x N bins, 4 to 32
  Fill fill = Fill::footprint;
  /// Elements are opened while their solid angle exceeds this multiple of the bin's; 1: as published.
  float opening = 2;
  /// Receivers share links until their solid angle, seen from the other end, is this part of what elements at
  /// the other end may have: of a shared link the direction is wrong at most receivers, of an element of many
  /// only its outline. 1, which takes a quarter less time, shows as mottled walls. More than 0.
  double sharing = 0.25;
  /// A bin is closed where its neighbours, all but one, are nearer than this part of its distance; more than
  /// 0.
  double closing = 0.5;
  /// Sine of how far below a receiver's horizon discs that are wider than four bins fill bins, at least: the
  /// normals of pixels differ from those of vertices, and further down nobody looks. Narrower discs and
  /// triangles fill all bins that they cover.
  double belowHorizon = 0.2;
  bool operator==(const LinkSettings&) const = default;
};

/// Holds the times of a build, ms of one core: the sum over all cores.
struct LinkTimes {
  double create = 0;   ///< links of elements above the leaves (thesis: create links)
  double inherit = 0;  ///< their parents' links, copied to them and to leaves (push down)
  double refine = 0;   ///< shorter links of leaves (refine)
  double close = 0;    ///< single empty bins filled

  LinkTimes& operator+=(const LinkTimes& other) {
    create += other.create, inherit += other.inherit, refine += other.refine, close += other.close;
    return *this;
  }
};

/// Holds, for every leaf and bin, the element that the leaf sees there: its slot in the forest, with
/// glsl::link_back where it shows its back, or glsl::no_link.
class LIMN_API Links {
 public:
  Links();
  ~Links();
  Links(Links&&) noexcept;
  Links& operator=(Links&&) noexcept;

  /// Builds the links by the thesis's algorithm, from the receivers' side: every element, from the roots
  /// down, takes the links for which neither end has to be opened, in the bins as its parent left them, and
  /// leaves the rest to its children. So creation, refinement (a shorter link of a child replaces its
  /// parent's for that child alone) and push-down are one traversal, and links are one-directional from the
  /// start. Uses all cores; the result does not depend on their number. Allocates nothing once it has seen
  /// the forest.
  void build(const Forest& forest, const LinkSettings& settings);
  /// Builds the links by testing every pair of leaves.
  void buildFlat(const Forest& forest, const LinkSettings& settings);

  /// Returns the times of the last build through the hierarchy.
  const LinkTimes& times() const { return times_; }

  int resolution() const { return resolution_; }
  size_t binCount() const { return 6 * static_cast<size_t>(resolution_) * static_cast<size_t>(resolution_); }
  /// Returns leafSlots * binCount() links, leaf after leaf. Rows of unused leaves have no meaning.
  std::span<const uint32_t> links() const { return links_; }
  std::span<const uint32_t> of(uint32_t leaf) const {
    return std::span(links_).subspan(leaf * binCount(), binCount());
  }

 private:
  struct Scratch;
  void prepare(const Forest& forest, const LinkSettings& settings);

  int resolution_ = 0;
  std::vector<uint32_t> links_;
  LinkTimes times_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace limn::radiosity
