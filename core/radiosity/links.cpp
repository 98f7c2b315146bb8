#include "core/radiosity/links.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <chrono>
#include <limits>

#include "core/base/error.h"
#include "core/radiosity/private/bin_filler.h"
#include "core/radiosity/private/link_test.h"

namespace limn::radiosity {
namespace {

/// Elements of this level and above are worked off level by level, those below them in tasks, each with a
/// whole branch: 16 leaves.
constexpr size_t kCoarseLevel = 3;

/// Lanes of a group that wait for a receiver: 16 group + mask.
uint32_t waiting(uint32_t group, uint32_t lanes) {
  return group << 4 | lanes;
}

/// Adds the time from one call to the next to what the work between them counts as, ms.
class Stopwatch {
 public:
  void add(double& to) {
    const auto now = std::chrono::steady_clock::now();
    to += std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// A receiver that is not a leaf: its bins, and what waits for its children.
struct Inner {
  std::vector<float> distance2;
  std::vector<uint32_t> links, waiting;

  void reserve(size_t bins) {
    distance2.resize(bins);
    links.resize(bins);
  }
  Bins bins() { return {.distance2 = distance2.data(), .links = links.data()}; }
};

/// What one thread needs on its way through a branch.
struct Branch {
  std::vector<uint32_t> stack;
  std::vector<float> distance2;  ///< of the leaf in work
  Inner inner[kCoarseLevel];     ///< [level]; [0] unused
  LinkTimes times;
};

}  // namespace

struct Links::Scratch {
  std::vector<Inner> coarse;  ///< from the first slot of kCoarseLevel on
  tbb::enumerable_thread_specific<Branch> branches;
  Inner nothing;                ///< the parent of the roots
  std::vector<uint32_t> tasks;  ///< elements below kCoarseLevel without a parent there
};

namespace {

/// The traversal of one build, N as of BinFiller.
template <int N>
class Traversal {
 public:
  Traversal(const Forest& forest, const LinkSettings& settings, uint32_t* out)
      : forest_(forest),
        groups_(forest.groups()),
        test_(settings),
        filler_(settings),
        sharing_(static_cast<float>(settings.sharing)),
        belowHorizon_(static_cast<float>(settings.belowHorizon)),
        out_(out) {}

  /// Fills `bins`, which hold the parent's links, with what `slot` need not leave to its children.
  template <bool leaf>
  void visit(uint32_t slot, std::span<const uint32_t> candidates, Bins& bins, std::vector<uint32_t>& stack,
             std::vector<uint32_t>* waitingOut) const {
    Receiver receiver = Receiver::of(groups_[slot / 4], slot % 4);
    receiver.extent /= sharing_;
    bins.up = receiver.normal;
    bins.margin = belowHorizon_ + receiver.spread;
    stack.assign(candidates.begin(), candidates.end());
    while (!stack.empty()) {
      const uint32_t entry = stack.back();
      stack.pop_back();
      const uint32_t g = entry >> 4;
      const glsl::ElementGroup& group = groups_[g];
      const Decision decision = test_.decide<leaf>(receiver, group);
      if (test_.seenAsTriangles(group))
        linkTriangles<leaf>(bins, receiver, g, decision, decision.link & entry);
      else
        link(bins, group, g, decision, decision.link & entry);
      for (uint32_t open = decision.open & entry & 15; open != 0; open &= open - 1)
        stack.push_back(waiting(group.children + static_cast<uint32_t>(std::countr_zero(open)), 15));
      if constexpr (!leaf) {
        const uint32_t defer = decision.defer & entry & 15;
        if (defer != 0) waitingOut->push_back(waiting(g, defer));
      }
    }
  }

  void inner(uint32_t slot, const Inner& parent, Inner& own, Branch& b) const {
    Stopwatch watch;
    std::copy(parent.distance2.begin(), parent.distance2.end(), own.distance2.begin());
    std::copy(parent.links.begin(), parent.links.end(), own.links.begin());
    watch.add(b.times.inherit);
    own.waiting.clear();
    Bins bins = own.bins();
    visit<false>(slot, parent.waiting, bins, b.stack, &own.waiting);
    watch.add(b.times.create);
  }

  /// An element below kCoarseLevel and all below it.
  void branch(uint32_t slot, size_t level, const Inner& parent, Branch& b) const {
    if (level == 0) {
      Stopwatch watch;
      Bins bins{.distance2 = b.distance2.data(),
                .links = out_ + static_cast<size_t>(slot) * parent.links.size()};
      std::copy(parent.distance2.begin(), parent.distance2.end(), bins.distance2);
      std::copy(parent.links.begin(), parent.links.end(), bins.links);
      watch.add(b.times.inherit);
      visit<true>(slot, parent.waiting, bins, b.stack, nullptr);
      watch.add(b.times.refine);
      filler_.close(bins);
      watch.add(b.times.close);
      return;
    }
    inner(slot, parent, b.inner[level], b);
    const uint32_t children = groups_[slot / 4].children + slot % 4;
    for (uint32_t lane = 0; lane < groups_[children].lanes; ++lane)
      branch(4 * children + lane, level - 1, b.inner[level], b);
  }

  /// Every leaf as a candidate for one leaf.
  void all(uint32_t slot, uint32_t leafGroups, Bins bins) const {
    const Receiver receiver = Receiver::of(groups_[slot / 4], slot % 4);
    bins.clear(static_cast<size_t>(filler_.count()));
    bins.up = receiver.normal;
    bins.margin = belowHorizon_;
    for (uint32_t g = 0; g < leafGroups; ++g) {
      const Decision decision = test_.decide<true>(receiver, groups_[g]);
      if (test_.seenAsTriangles(groups_[g]))
        linkTriangles<true>(bins, receiver, g, decision, decision.link);
      else
        link(bins, groups_[g], g, decision, decision.link);
    }
    filler_.close(bins);
  }

 private:
  [[gnu::always_inline]] inline void link(const Bins& bins, const glsl::ElementGroup& group, uint32_t g,
                                          const Decision& d, uint32_t lanes) const {
    lanes &= 15;
    if (lanes == 0) return;
    Candidates c{.x = d.x,
                 .y = d.y,
                 .z = d.z,
                 .nx = radiosity::lanes(group.nx),
                 .ny = radiosity::lanes(group.ny),
                 .nz = radiosity::lanes(group.nz),
                 .distance2 = d.distance2,
                 .height = d.height,
                 .disc = radiosity::lanes(group.disc),
                 .links = static_cast<int32_t>(4 * g) + Int4{0, 1, 2, 3}};
    if (group.backs != 0) c.links |= (d.height > 0.f) & static_cast<int32_t>(glsl::link_back);
    filler_.fill(bins, c, lanes);
  }

  /// Links what leaves' triangles cover. Backs are met as those of discs are.
  template <bool leaf>
  [[gnu::noinline]] void linkTriangles(const Bins& bins, const Receiver& receiver, uint32_t g,
                                       const Decision& d, uint32_t lanes) const {
    lanes &= 15;
    if (lanes == 0) return;
    const uint32_t backs = groups_[g].backs != 0 ? laneMask(LinkTest::behind(d, groups_[g])) : 0;
    for (uint32_t p = forest_.firstPack()[g]; p < forest_.firstPack()[g + 1]; ++p)
      filler_.fill(bins, SeenTriangles(forest_.packs()[p], receiver.position, receiver.normal,
                                       leaf ? 0 : receiver.radius, leaf ? 0 : receiver.spread, lanes, backs));
  }

  const Forest& forest_;
  std::span<const glsl::ElementGroup> groups_;
  LinkTest test_;
  BinFiller<N> filler_;
  float sharing_, belowHorizon_;
  uint32_t* out_;
};

/// Calls `work` with the traversal for this many bins: the usual numbers have code of their own.
template <class Work>
void withTraversal(const Forest& forest, const LinkSettings& settings, uint32_t* out, const Work& work) {
  switch (settings.resolution) {
    case 8:
      return work(Traversal<8>(forest, settings, out));
    case 12:
      return work(Traversal<12>(forest, settings, out));
    case 16:
      return work(Traversal<16>(forest, settings, out));
    case 24:
      return work(Traversal<24>(forest, settings, out));
    default:
      return work(Traversal<0>(forest, settings, out));
  }
}

}  // namespace

Links::Links() : scratch_(std::make_unique<Scratch>()) {}
Links::~Links() = default;
Links::Links(Links&&) noexcept = default;
Links& Links::operator=(Links&&) noexcept = default;

void Links::prepare(const Forest& forest, const LinkSettings& settings) {
  if (settings.resolution < 4 || settings.resolution > 32)
    throw UsageError(fmt::format("radiosity: {} bins per side are not in 4 .. 32", settings.resolution));
  if (settings.fill == Fill::triangles && forest.shape() != LeafShape::triangles)
    throw UsageError("radiosity: links to leaves' triangles take a forest of LeafShape::triangles");
  resolution_ = settings.resolution;
  links_.resize(forest.leafSlots() * binCount());
}

void Links::buildFlat(const Forest& forest, const LinkSettings& settings) {
  prepare(forest, settings);
  const uint32_t leafGroups = forest.levels()[0].count;
  withTraversal(forest, settings, links_.data(), [&](const auto& traversal) {
    tbb::parallel_for(0u, leafGroups, [&](uint32_t g) {
      Branch& b = scratch_->branches.local();
      b.distance2.resize(binCount());
      for (uint32_t slot = 4 * g; slot < 4 * g + forest.groups()[g].lanes; ++slot)
        traversal.all(slot, leafGroups,
                      {.distance2 = b.distance2.data(), .links = &links_[slot * binCount()]});
    });
  });
}

void Links::build(const Forest& forest, const LinkSettings& settings) {
  prepare(forest, settings);
  Scratch& s = *scratch_;
  const auto groups = forest.groups();
  const auto parents = forest.parents();
  const auto levels = forest.levels();
  for (Branch& b : s.branches) b.times = {};
  s.nothing.reserve(binCount());
  s.nothing.bins().clear(binCount());
  s.nothing.waiting.clear();
  for (const uint32_t root : forest.roots()) s.nothing.waiting.push_back(waiting(root, 1));

  // Breadth first through the coarse levels, then the branches below: of elements with a coarse parent, and
  // of small clusters.
  const uint32_t firstCoarse =
      levels.size() > kCoarseLevel ? levels[kCoarseLevel].first : static_cast<uint32_t>(groups.size());
  s.coarse.resize(4 * (groups.size() - firstCoarse));
  const auto parentOf = [&](uint32_t group) -> const Inner& {
    return parents[group] == glsl::no_link ? s.nothing : s.coarse[parents[group] - 4 * firstCoarse];
  };
  const auto local = [&]() -> Branch& {
    Branch& b = s.branches.local();
    b.distance2.resize(binCount());
    for (Inner& inner : b.inner) inner.reserve(binCount());
    return b;
  };
  s.tasks.clear();
  for (uint32_t g = 0; g < firstCoarse; ++g) {
    if (parents[g] != glsl::no_link && parents[g] < 4 * firstCoarse) continue;
    for (uint32_t lane = 0; lane < groups[g].lanes; ++lane) s.tasks.push_back(4 * g + lane);
  }
  withTraversal(forest, settings, links_.data(), [&](const auto& traversal) {
    for (size_t level = levels.size(); level-- > kCoarseLevel;)
      tbb::parallel_for(4 * levels[level].first, 4 * (levels[level].first + levels[level].count),
                        [&](uint32_t slot) {
                          if (slot % 4 >= groups[slot / 4].lanes) return;
                          Inner& own = s.coarse[slot - 4 * firstCoarse];
                          own.reserve(binCount());
                          traversal.inner(slot, parentOf(slot / 4), own, local());
                        });
    tbb::parallel_for(size_t{0}, s.tasks.size(), [&](size_t i) {
      const uint32_t slot = s.tasks[i];
      size_t level = 0;
      while (level + 1 < levels.size() && slot / 4 >= levels[level + 1].first) ++level;
      traversal.branch(slot, level, parentOf(slot / 4), local());
    });
  });
  times_ = {};
  for (const Branch& b : s.branches) times_ += b.times;
}

}  // namespace limn::radiosity
