// Declares the adaptive refinement of directional trees.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/radiosity/glossy_lobes.h"
#include "core/radiosity/private/corner_level.h"
#include "core/radiosity/private/float4.h"
#include "core/radiosity/private/tree_cell.h"
#include "core/radiosity/private/tree_memory.h"
#include "core/radiosity/tree_builder.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::radiosity {

/// Directions nearer to the horizon are evaluated here: the light ends at the horizon, and cells that see the
/// end would split without limit.
inline constexpr float kLeastHeight = 1e-3f;
/// Peaks are found whatever the samples of a cell say, but for the least lobes that together have less than
/// this part of the squared error that is asked for.
inline constexpr float kMissedPeaks = 0.25f;
/// Lobes are linear over a cell as long as together they are off at its centre by less than this part of the
/// error that is asked for, and each by no more than kSingle of that over the root of their number: the
/// tree's error grows by 8 % at most. Tuned with 1 to 200 lobes of roughness 0.1 to 0.5, from all around and
/// from patches of 0.6 rad.
inline constexpr float kLinear = 0.27f;
inline constexpr float kSingle = 0.5f;
/// Lobes are frozen where at least this part of those of a cell can be: the others have to be moved.
inline constexpr float kWorthFreezing = 0.25f;
/// The error that the published test is taken to ask for.
inline constexpr float kPublishedError = 0.1f;
/// Cells of the deepest level may have more error than is asked for. Then the others are split until they
/// have this part of it.
inline constexpr double kReducible = 0.1;
/// Part of the squared mean that the squared radiance of a direction counts for at least (display).
inline constexpr double kDarkest = 0.1;

/// Splits the faces of an octahedron into cells until the light of a source is known well enough, and makes
/// the tree of them. Keeps its memory from one tree to the next.
struct CellRefiner {
  std::vector<TreeCell> cells;
  std::vector<Candidate> heap, brightest;
  std::vector<DirectionalTree::Node> nodes;
  std::vector<float> bends;
  std::vector<glm::vec3> cornerValues;
  Arena<uint32_t> lists;
  Arena<float> values;
  uint64_t evaluations = 0;

  TreeSettings settings;
  bool keeps = false;  ///< single lobes' values are kept
  double beside = 0;   ///< luminance of light that is not in the tree
  /// Sums over the cells without children.
  double power = 0, error = 0;
  double stuck = 0;    ///< the part of the error that is in cells of the deepest level
  double darkest = 0;  ///< display: squared luminance that counts at least

  /// Evaluates lobes, and keeps their values where `block` says.
  template <class Source>
  glm::vec3 evaluate(const Source& source, glm::vec3 w, const LobeSet& lobes, size_t& block) {
    w.z = std::max(w.z, kLeastHeight);
    if (keeps) block = values.take(3 * GlossyLobes::stride(lobes.count));
    evaluations += source.cost(lobes.count);
    return source.evaluate(w, {lists.at(lobes.list), lobes.count}, values.at(lobes.rows),
                           keeps ? values.at(block) : nullptr);
  }

  /// Measures a cell that has its values and adds it to the sums.
  void measure(TreeCell& cell) {
    const double value = double(glsl::luminance(cell.value())) + beside;
    cell.power = double(cell.weight) * value * value;
    cell.error = double(cell.weight) * double(cell.variance());
    if (settings.criterion == TreeSettings::Criterion::display)
      cell.error /= std::max(value * value + darkest, 1e-300);
    count(cell, 1);
  }
  void count(const TreeCell& cell, double sign) {
    power += sign * cell.power;
    error += sign * cell.error;
    if (cell.level >= settings.maxLevel) stuck += sign * cell.error;
  }
  /// Sums up all cells, with a mean that is now known.
  void recount() {
    double mean = 0, area = 0;
    for (const TreeCell& cell : cells) {
      if (cell.child != 0) continue;
      mean += double(cell.weight) * (double(glsl::luminance(cell.value())) + beside);
      area += double(cell.weight);
    }
    darkest = kDarkest * (mean / area) * (mean / area);
    power = error = stuck = 0;
    for (TreeCell& cell : cells)
      if (cell.child == 0) measure(cell);
  }

  template <class Source>
  LobeSet takeSet(const Source& source, size_t list, uint32_t count) {
    const size_t rows = values.take(source.rows() * GlossyLobes::stride(count));
    source.describe({lists.at(list), count}, values.at(rows));
    return {list, rows, count};
  }

  /// Forgets the last tree.
  void clear(const TreeSettings& how, double otherLight) {
    settings = how;
    beside = otherLight;
    keeps = false;
    cells.clear();
    lists.reset();
    values.reset();
    power = error = stuck = darkest = 0;
  }

  template <class Source>
  LobeSet allOf(const Source& source) {
    const size_t list = lists.take(source.size());
    for (uint32_t k = 0; k < source.size(); ++k) lists.at(list)[k] = k;
    return takeSet(source, list, source.size());
  }

  template <class Source>
  void begin(const Source& source, const TreeSettings& how, double otherLight) {
    clear(how, otherLight);
    keeps = settings.frozen && source.size() > 0;
    const LobeSet all = allOf(source);
    for (uint32_t face = 0; face < DirectionalTree::kFaces; ++face) {
      TreeCell cell{};
      cell.shape = UnitCell::face(face);
      cell.lobes = all;
      for (uint32_t i = 0; i < 4; ++i) {
        const glm::vec3 w = i < 3 ? cell.shape.corners[i] : cell.shape.centre();
        cell.totals[i] = evaluate(source, w, all, cell.blocks[i]);
      }
      cell.weight = 0.25f * glsl::pi;
      measure(cell);
      cells.push_back(cell);
    }
  }

  /// Whether a lobe may change over the cell in ways that its points do not show.
  template <class Source>
  bool hides(const Source& source, const TreeCell& cell, uint32_t lobe, float edge, float cosEdge) const {
    return edge > 2 * source.alpha(lobe) && glm::dot(source.mirror(lobe), cell.shape.centre()) > cosEdge;
  }

  /// Sets by how much each lobe of a cell is off at the centre of a linear function, luminance.
  void findBends(const TreeCell& cell) {
    const size_t length = GlossyLobes::stride(cell.lobes.count);
    bends.resize(std::max(bends.size(), length));
    const glm::vec3 weights(glsl::luminance({1, 0, 0}), glsl::luminance({0, 1, 0}),
                            glsl::luminance({0, 0, 1}));
    const float* points[4];
    for (int p = 0; p < 4; ++p) points[p] = values.at(cell.blocks[p]);
    for (size_t i = 0; i < length; i += 4) {
      Float4 bend = splat(0);
      for (size_t c = 0; c < 3; ++c) {
        const auto at = [&](int p) { return load(points[p] + c * length + i); };
        bend += splat(weights[static_cast<int>(c)]) * (at(3) - splat(1 / 3.f) * (at(0) + at(1) + at(2)));
      }
      store(bends.data() + i, bend);
    }
  }

  /// Moves lobes that are linear over the cell from its set to its linear part.
  template <class Source>
  void freeze(const Source& source, TreeCell& cell) {
    const uint32_t count = cell.lobes.count;
    if (count == 0) return;
    findBends(cell);
    const float asked =
        settings.criterion == TreeSettings::Criterion::relative ? kPublishedError : settings.error;
    const bool display = settings.criterion == TreeSettings::Criterion::display;
    const double local = double(glsl::luminance(cell.value())) + beside;
    const double squared = display ? local * local + darkest : power / double(glsl::pi);
    const float together = kLinear * asked * static_cast<float>(std::sqrt(std::max(squared, 0.0)));
    const float single = kSingle * together / std::sqrt(static_cast<float>(source.size()));
    const float edge = std::min(cell.edge(), 3.f), cosEdge = std::cos(edge);
    const size_t length = GlossyLobes::stride(count), keptList = lists.take(2 * count);
    const uint32_t* list = lists.at(cell.lobes.list);
    uint32_t* kept = lists.at(keptList);
    uint32_t* frozen = kept + count;
    uint32_t keptCount = 0, frozenCount = 0;
    float bent = cell.bent;
    for (uint32_t i = 0; i < count; ++i) {
      if (std::abs(bends[i]) < single && std::abs(bent + bends[i]) < together &&
          !hides(source, cell, list[i], edge, cosEdge)) {
        bent += bends[i];
        frozen[frozenCount++] = i;
      } else {
        kept[keptCount++] = i;
      }
    }
    if (frozenCount < kWorthFreezing * static_cast<float>(count)) return;
    cell.bent = bent;
    for (int p = 0; p < 3; ++p) {
      const float* value = values.at(cell.blocks[p]);
      for (uint32_t k = 0; k < frozenCount; ++k) {
        const uint32_t i = frozen[k];
        cell.linear[p] += glm::vec3(value[i], value[length + i], value[2 * length + i]);
      }
    }
    const size_t keptLength = GlossyLobes::stride(keptCount);
    for (size_t& block : cell.blocks) {
      const size_t shorter = values.take(3 * keptLength);
      const float* from = values.at(block);
      float* to = values.at(shorter);
      for (size_t c = 0; c < 3; ++c)
        for (uint32_t i = 0; i < keptCount; ++i) to[c * keptLength + i] = from[c * length + kept[i]];
      block = shorter;
    }
    for (uint32_t i = 0; i < keptCount; ++i) kept[i] = list[kept[i]];
    cell.lobes = takeSet(source, keptList, keptCount);
  }

  /// Returns what the cells take, with all that is kept of them, bytes.
  uint64_t memory() const { return cells.size() * sizeof(TreeCell) + lists.memory() + values.memory(); }

  template <class Source>
  void split(const Source& source, uint32_t index) {
    if (memory() > settings.memory) refuseTrees(settings.memory);
    count(cells[index], -1);
    if (keeps) freeze(source, cells[index]);
    const auto firstChild = static_cast<uint32_t>(cells.size());
    cells[index].child = firstChild;
    const TreeCell parent = cells[index];
    glm::vec3 middles[3], totals[3], linear[3];
    size_t blocks[3] = {};
    parent.shape.middles(middles);
    for (int i = 0; i < 3; ++i) {
      linear[i] = 0.5f * (parent.linear[(i + 1) % 3] + parent.linear[(i + 2) % 3]);
      totals[i] = linear[i] + evaluate(source, middles[i], parent.lobes, blocks[i]);
    }
    float weightLeft = parent.weight;
    for (uint32_t k = 0; k < 4; ++k) {
      TreeCell child{};
      child.shape = parent.shape.child(k, middles);
      child.lobes = parent.lobes;
      child.bent = parent.bent;
      child.level = parent.level + 1;
      for (uint32_t i = 0; i < 3; ++i) {
        const bool own = k == i;
        const uint32_t middle = k == 3 ? i : 3 - i - k;
        child.totals[i] = own ? parent.totals[i] : totals[middle];
        child.linear[i] = own ? parent.linear[i] : linear[middle];
        child.blocks[i] = own ? parent.blocks[i] : blocks[middle];
      }
      if (k == 3) {  // shares the centre
        child.blocks[3] = parent.blocks[3];
        child.totals[3] = parent.totals[3];
        child.weight = std::max(weightLeft, 0.f);
      } else {
        const glm::vec3(&corners)[3] = child.shape.corners;
        child.totals[3] = (child.linear[0] + child.linear[1] + child.linear[2]) / 3.f +
                          evaluate(source, child.shape.centre(), child.lobes, child.blocks[3]);
        child.weight = cellWeight(corners[0], corners[1], corners[2]);
        weightLeft -= child.weight;
      }
      measure(child);
      cells.push_back(child);
    }
  }

  /// Splits what holds the mirror directions of lobes until its edges are as long as the lobes' cores.
  template <class Source>
  void findPeaks(const Source& source) {
    brightest.clear();
    double all = 0;
    for (uint32_t k = 0; k < source.size(); ++k) {
      brightest.push_back({source.power(k), k});
      all += brightest.back().priority;
    }
    std::sort(brightest.begin(), brightest.end());
    double missed = 0;
    // Lobes that overlap are brighter together.
    const double mayMiss =
        kMissedPeaks * double(settings.error) * double(settings.error) * std::max(all, power);
    for (const Candidate& lobe : brightest) {
      missed += lobe.priority;
      if (missed > mayMiss) splitAround(source, lobe.index);
    }
  }

  /// Splits around the mirror direction as well: cells beside the peak's own do not see it either.
  template <class Source>
  void splitAround(const Source& source, uint32_t lobe) {
    const glm::vec3 mirror = source.mirror(lobe);
    const float core = 2 * source.alpha(lobe);
    splitAt(source, mirror, core);
    const glm::vec3 place = glsl::octahedral_place(mirror);
    const glm::vec3 signs = glsl::octahedral_signs(glsl::octahedral_face(mirror));
    for (uint32_t i = 0; i < 12; ++i) {
      const glm::vec3 tap = glsl::octahedral_tap(place, signs, i < 6 ? 2 * core : 4 * core, i % 6);
      if (tap.z > 0) splitAt(source, tap, core);
    }
  }
  template <class Source>
  void splitAt(const Source& source, const glm::vec3& w, float edge) {
    glm::vec3 place = glsl::octahedral_place(w);
    uint32_t cell = glsl::octahedral_face(w);
    while (true) {
      if (cells[cell].child == 0) {
        if (cells[cell].level >= settings.maxLevel || cells[cell].edge() <= edge) return;
        split(source, cell);
      }
      cell = cells[cell].child + glsl::octahedral_descend(place);
    }
  }

  /// Whether the error is small enough, or what splits could still take from it does not matter.
  bool good() const {
    const double eps2 = double(settings.error) * double(settings.error);
    const double limit =
        eps2 * (settings.criterion == TreeSettings::Criterion::display ? double(glsl::pi) : power);
    return error <= limit || error - stuck <= kReducible * stuck;
  }

  void offer(uint32_t cell) {
    if (cells[cell].level >= settings.maxLevel) return;
    const double priority = cells[cell].error;
    if (!(priority > 0)) return;
    heap.push_back({priority, cell});
    std::push_heap(heap.begin(), heap.end());
  }

  template <class Source>
  void refineWorst(const Source& source) {
    heap.clear();
    for (uint32_t i = 0; i < cells.size(); ++i)
      if (cells[i].child == 0) offer(i);
    while (!heap.empty() && !good()) {
      const uint32_t worst = heap.front().index;
      std::pop_heap(heap.begin(), heap.end());
      heap.pop_back();
      split(source, worst);
      for (uint32_t k = 0; k < 4; ++k) offer(cells[worst].child + k);
    }
  }

  /// Whether all lobes together have less light than the error asked for: one value for each face is enough.
  template <class Source>
  bool faint(const Source& source) const {
    if (!(beside > 0) || source.size() == 0) return false;
    double most = 0;  // of the root of the squared light: that of the sum is at most the sum
    for (uint32_t k = 0; k < source.size(); ++k) most += std::sqrt(source.power(k));
    return most < double(settings.error) * std::sqrt(double(glsl::pi)) * beside;
  }

  template <class Source>
  void refine(const Source& source) {
    for (uint32_t i = 0; i < cells.size(); ++i)
      if (cells[i].level < settings.minLevel) split(source, i);
    recount();
    if (settings.criterion == TreeSettings::Criterion::relative) {
      for (uint32_t i = 0; i < cells.size(); ++i)
        if (cells[i].child == 0 && cells[i].level < settings.maxLevel &&
            cells[i].varies(settings.error, static_cast<float>(beside)))
          split(source, i);
      return;
    }
    findPeaks(source);
    refineWorst(source);
  }

  template <class Source>
  void buildUniform(const Source& source, const TreeSettings& how, DirectionalTree& tree) {
    clear(how, 0);
    const int level = std::min(settings.maxLevel, DirectionalTree::kMaxUniformLevel);
    const LobeSet all = allOf(source);
    cornerValues.clear();
    size_t block = 0;
    for (const glm::vec3& w : cornerLevel(level).directions)
      cornerValues.push_back(evaluate(source, w, all, block));
    tree.assignUniform(level, cornerValues);
  }

  template <class Source>
  void build(const Source& source, const TreeSettings& how, DirectionalTree& tree, double otherLight = 0) {
    if (how.basis == TreeSettings::Basis::uniform) return buildUniform(source, how, tree);
    begin(source, how, otherLight);
    if (!faint(source)) refine(source);
    finish(tree);
  }

  /// Values of inner cells are the means of their children's.
  void finish(DirectionalTree& tree) {
    nodes.resize(cells.size());
    for (size_t i = cells.size(); i-- > 0;) {
      const uint32_t child = cells[i].child;
      nodes[i] = {cells[i].value(), child};
      if (child == 0) continue;
      glm::vec3 sum(0);
      for (uint32_t k = 0; k < 4; ++k) sum += cells[child + k].weight * nodes[child + k].value;
      nodes[i].value = sum / cells[i].weight;
    }
    tree.assign(nodes);
  }
};

}  // namespace limn::radiosity
