// Links of surface elements in bins of directions, each the shortest of its bin: what a point sees, found
// while links are made (implicit visibility, thesis, sections 4.2.1 and 4.3.2).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/radiosity/forest.h"

namespace limn::radiosity {

/// Which bins an element fills.
enum class Fill {
  centre,     ///< the one in which its centre lies, wholly (as published)
  footprint,  ///< those whose centres its disc covers
};

struct LinkSettings {
  int resolution = 16;  ///< N of the 6 x N x N bins, 4 to 32
  Fill fill = Fill::footprint;
  /// Elements are opened while their solid angle exceeds this many times the bin's; 1: as published.
  float opening = 2;
  bool operator==(const LinkSettings&) const = default;
};

/// What a build took, ms of one core: that of all cores together.
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

/// For every leaf and bin the element that the leaf sees there: its slot in the forest, with glsl::link_back
/// where it shows its back, or glsl::no_link.
class LIMN_API Links {
 public:
  Links();
  ~Links();
  Links(Links&&) noexcept;
  Links& operator=(Links&&) noexcept;

  /// The thesis's algorithm, from the receivers' side: every element, from the roots down, takes the links
  /// that neither end has to be opened for, in the bins as its parent left them, and leaves the rest to its
  /// children. So creation, refinement (a shorter link of a child replaces its parent's for that child alone)
  /// and push-down are one traversal, and links are one-directional from the start. All cores; the result
  /// does not depend on their number. Allocates nothing once it has seen the forest.
  void build(const Forest& forest, const LinkSettings& settings);
  /// Every pair of leaves is tried.
  void buildFlat(const Forest& forest, const LinkSettings& settings);

  /// Of the last build through the hierarchy.
  const LinkTimes& times() const { return times_; }

  int resolution() const { return resolution_; }
  size_t binCount() const { return 6 * static_cast<size_t>(resolution_) * static_cast<size_t>(resolution_); }
  /// leafSlots * binCount(), leaf after leaf. Rows of unused leaves hold nothing of meaning.
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
