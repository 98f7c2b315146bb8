#include "core/radiosity/sample_solver.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "core/base/error.h"
#include "core/radiosity/disc_transport.h"
#include "core/radiosity/illumination.h"
#include "glsl/numeric/sampling.glsl"

namespace limn::radiosity {
namespace {

constexpr int kRays = 4;  ///< of a link

/// Links that would transport less than this part of the error allowed are not made.
constexpr float kNegligible = 1e-3f;

/// Links into lobes are refined until the sender spans less than this many of the lobe's widths.
constexpr float kLobeWidths = 2.5f;

/// Light of lobes may vary over the directions and places of a link by this multiple of the error allowed:
/// these are bounds, and what rays find is far less; without them narrow lobes pass between the rays.
constexpr float kLobeVariation = 8;

/// Senders nearer than this many square roots of their area are made to transport what a disc does.
constexpr float kNear = 6;

/// Of a unit's distance: what lies in a plane sees nothing else in it.
constexpr float kGrazing = 1e-4f;

/// A cluster is flat where its normals differ by less: it does not see itself.
constexpr float kFlat = 1e-3f;

/// Elements whose normals differ by more have no tree over one hemisphere: their leaves' trees stand for
/// them.
constexpr float kCurved = 0.5f;

float largest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

uint32_t mixed(uint32_t x) {
  x ^= x >> 16, x *= 0x7feb352du;
  x ^= x >> 15, x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

float unit(uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24f;
}

}  // namespace

SampleSolver::SampleSolver(const Surfels& surfels, const Forest& forest, const ElementSpace& space,
                           std::span<const LeafMaterial> materials, const SampleSettings& settings)
    : surfels_(surfels), forest_(forest), space_(space), settings_(settings) {
  for (const LeafMaterial& m : materials) {
    glsl::SurfaceBrdf brdf{};
    brdf.diffuse = m.diffuse, brdf.alpha = m.alpha, brdf.f0 = m.f0, brdf.f90 = m.f90;
    brdf.dielectric_f0 = m.dielectric_f0, brdf.dielectric_f90 = m.dielectric_f90;
    brdf_.push_back(brdf);
  }
  elements_.resize(forest.slots());
  frames_.resize(forest.slots());
  for (size_t i = 0; i < surfels.size(); ++i) elements_[forest.leafOf()[i]].surfel = static_cast<uint32_t>(i);

  firstFan_.assign(surfels.size() + 1, 0);
  const auto& corners = surfels.triangles;
  for (const uint32_t corner : corners) ++firstFan_[corner + 1];
  for (size_t i = 0; i < surfels.size(); ++i) firstFan_[i + 1] += firstFan_[i];
  fans_.resize(corners.size());
  std::vector<uint32_t> next(firstFan_.begin(), firstFan_.end());
  for (size_t t = 0; t + 2 < corners.size(); t += 3)
    for (size_t k = 0; k < 3; ++k)
      fans_[next[corners[t + k]]++] = {corners[t + (k + 1) % 3], corners[t + (k + 2) % 3], 0};
  begin();
}

void SampleSolver::begin() {
  measure();
  const size_t leaves = forest_.leafSlots(), slots = forest_.slots();
  fresh_.assign(leaves, glm::vec3(0));
  irradiance_.assign(leaves, glm::vec3(0));
  unshot_.assign(slots, glm::vec3(0));
  most_.assign(slots, 0);
  lights_.resize(leaves);
  trees_.resize(slots);
  shown_.resize(leaves);
  samples_.resize(slots);
  firstFresh_.assign(slots, 0);
  for (auto& lights : lights_) lights.clear();
  for (auto& tree : trees_) tree.clear();
  for (auto& tree : shown_) tree.clear();
  for (auto& samples : samples_) samples.clear();
  sampleCount_ = evaluations_ = 0;
  reference_ = 0;
}

void SampleSolver::measure() {
  const auto groups = forest_.groups();
  const auto measureGroup = [&](uint32_t g, bool leaf) {
    const glsl::ElementGroup& group = groups[g];
    for (uint32_t lane = 0; lane < group.lanes; ++lane) {
      const int k = static_cast<int>(lane);
      Element& e = elements_[4 * g + lane];
      e.position = {group.x[k], group.y[k], group.z[k]};
      e.normal = {group.nx[k], group.ny[k], group.nz[k]};
      e.area = group.area[k];
      e.spread = group.spread[k];
      glsl::Frame& frame = frames_[4 * g + lane];
      frame = glsl::frame_around(space_.worldDirection(e.normal));
      frame = {space_.direction(frame.t), space_.direction(frame.b), e.normal};
      if (leaf) {
        e.reach = group.disc[k];
        e.glossy = glossy(4 * g + lane);
        e.alpha = e.glossy ? brdf_[4 * g + lane].alpha : 1;
        continue;
      }
      e.firstChild = 4 * (group.children + lane);
      e.childCount = groups[group.children + lane].lanes;
      e.reach = 0;
      e.alpha = 1;
      e.glossy = false;
      for (uint32_t c = e.firstChild; c < e.firstChild + e.childCount; ++c) {
        e.reach = std::max(e.reach, glm::length(elements_[c].position - e.position) + elements_[c].reach);
        e.alpha = std::min(e.alpha, elements_[c].alpha);
        e.glossy = e.glossy || elements_[c].glossy;
      }
    }
  };
  const auto levels = forest_.levels();
  for (size_t level = 0; level < levels.size(); ++level)
    tbb::parallel_for(levels[level].first, levels[level].first + levels[level].count,
                      [&](uint32_t g) { measureGroup(g, level == 0); });
  tbb::parallel_for(size_t{0}, surfels_.size(), [&](size_t i) {
    Element& e = elements_[forest_.leafOf()[i]];
    // Elements that left a body are far from their vertex, and its triangles.
    const bool atHome = glm::length(e.position - surfels_.vertices[i]) <= 2 * e.reach;
    e.lift = 0;
    float area = 0;
    for (uint32_t f = firstFan_[i]; f < firstFan_[i + 1]; ++f) {
      const glm::vec3 &a = surfels_.vertices[i], &b = surfels_.vertices[fans_[f].second],
                      &c = surfels_.vertices[fans_[f].third];
      const glm::vec3 across = glm::cross(b - a, c - a);
      const float twice = glm::length(across), upright = glm::dot(across, e.normal);
      area += twice;
      fans_[f].area = area;
      if (atHome && upright > 0.1f * twice)
        e.lift = std::max(e.lift, glm::dot(a - e.position, across) / upright);
    }
  });
}

void SampleSolver::light(uint32_t leaf, const glm::vec3& irradiance,
                         std::span<const glsl::IncidentLight> incident) {
  fresh_[leaf] = irradiance;
  if (!glossy(leaf)) return;
  for (const glsl::IncidentLight& light : incident)
    lights_[leaf].push_back({glsl::to_local(frames_[leaf], light.direction), light.spread, light.irradiance});
}

/// What a thread keeps to reflect samples.
struct SampleSolver::Worker {
  TreeBuilder builder;
  GlossyLobes lobes;
  DirectionalTree single;
  std::vector<glsl::IncidentLight> lights;
  std::vector<TreePart> parts;
};

template <class First, class Visit>
void SampleSolver::visitSamples(uint32_t leaf, const First& first, const Visit& visit) const {
  const Element& e = elements_[leaf];
  for (uint32_t slot = leaf; slot != glsl::no_link; slot = forest_.parents()[slot / 4])
    for (size_t i = first(slot); i < samples_[slot].size(); ++i) {
      const SampleAtElement& sample = samples_[slot][i];
      const Element& sender = elements_[sample.sender];
      const glm::vec3 offset = sender.position - e.position;
      const float distance2 = glm::dot(offset, offset);
      if (!(distance2 > 0)) continue;
      const glm::vec3 w = offset / std::sqrt(distance2);
      if (!(glm::dot(e.normal, w) > 0)) continue;
      visit(glsl::IncidentLight{
          w, sampleSpread(sender.area, distance2),
          sample.radiance * axisTransport(sender.area, -glm::dot(sender.normal, w), distance2)});
    }
}

void SampleSolver::collect(uint32_t leaf, bool freshOnly, std::vector<glsl::IncidentLight>& lights) const {
  lights.clear();
  visitSamples(
      leaf, [&](uint32_t slot) { return freshOnly ? firstFresh_[slot] : 0; },
      [&](const glsl::IncidentLight& light) {
        lights.push_back({glsl::to_local(frames_[leaf], light.direction), light.spread, light.irradiance});
      });
}

void SampleSolver::reflect(Worker& worker, uint32_t leaf, const TreeSettings& settings,
                           DirectionalTree& tree) {
  tree.clear();
  if (!settings_.immediate) {
    worker.lobes.set(brdf_[leaf], worker.lights, settings_.widen);
    if (worker.lobes.size() > 0) worker.builder.build(worker.lobes, settings, tree);
    count(tree);
    return;
  }
  for (const glsl::IncidentLight& light : worker.lights) {
    worker.lobes.set(brdf_[leaf], {&light, 1}, settings_.widen);
    if (worker.lobes.size() == 0) continue;
    worker.builder.build(worker.lobes, settings, worker.single);
    if (tree.empty())
      std::swap(tree, worker.single);
    else
      tree.add(worker.single);
  }
  count(tree);
}

void SampleSolver::count(const DirectionalTree& tree) {
  if ((treeBytes_ += tree.memory()) > settings_.memory)
    throw UsageError(
        fmt::format("light over directions takes more than the {} MiB allowed: a larger direction_error or "
                    "longest_edge, or "
                    "a smaller max_level makes it less",
                    settings_.memory >> 20));
}

void SampleSolver::reflect() {
  const size_t leaves = forest_.leafSlots();
  if (reference_ == 0) {
    double flux = 0, area = 0;
    for (size_t leaf = 0; leaf < leaves; ++leaf) {
      flux += double(elements_[leaf].area) * largest(fresh_[leaf]);
      area += elements_[leaf].area;
    }
    reference_ = area > 0 ? static_cast<float>(flux / area) : 0;
  }
  const bool first = sampleCount_ == 0;
  treeBytes_ = 0;
  tbb::enumerable_thread_specific<Worker> workers;
  tbb::parallel_for(0u, static_cast<uint32_t>(leaves), [&](uint32_t leaf) {
    unshot_[leaf] = glsl::diffuse_albedo(brdf_[leaf]) * fresh_[leaf] * glsl::inverse_pi;
    most_[leaf] = largest(unshot_[leaf]);
    if (!elements_[leaf].glossy) return;
    Worker& worker = workers.local();
    if (first)
      worker.lights.swap(lights_[leaf]);
    else
      collect(leaf, true, worker.lights);
    lights_[leaf].clear();
    reflect(worker, leaf, settings_.tree, trees_[leaf]);
  });
  fresh_.assign(leaves, glm::vec3(0));
  pullUp(forest_, unshot_);
  for (const Forest::Level& level : forest_.levels().subspan(1))
    tbb::parallel_for(4 * level.first, 4 * (level.first + level.count), [&](uint32_t slot) {
      const Element& e = elements_[slot];
      most_[slot] = 0;
      for (uint32_t c = e.firstChild; c < e.firstChild + e.childCount; ++c)
        most_[slot] = std::max(most_[slot], most_[c]);
      if (e.glossy && e.spread < kCurved) pullTree(workers.local(), slot);
    });
  for (const Worker& worker : workers) evaluations_ += worker.builder.evaluations();
}

void SampleSolver::pullTree(Worker& worker, uint32_t slot) {
  const Element& e = elements_[slot];
  trees_[slot].clear();
  bool dark = true;
  for (uint32_t c = e.firstChild; c < e.firstChild + e.childCount; ++c) dark = dark && trees_[c].empty();
  if (dark) return;
  worker.parts.clear();
  for (uint32_t c = e.firstChild; c < e.firstChild + e.childCount; ++c)
    worker.parts.push_back({.tree = &trees_[c], .frame = frames_[c], .area = elements_[c].area});
  worker.builder.pull(worker.parts, frames_[slot], settings_.tree, trees_[slot]);
  count(trees_[slot]);
}

glm::vec3 SampleSolver::treeValue(uint32_t slot, uint32_t leaf, const glm::vec3& direction) const {
  const uint32_t from = elements_[slot].spread < kCurved ? slot : leaf;
  return trees_[from].empty() ? glm::vec3(0) : trees_[from].value(glsl::to_local(frames_[from], direction));
}

float SampleSolver::treeMost(uint32_t slot, const glm::vec3& axis, float cosine, float& least) const {
  const Element& e = elements_[slot];
  if (e.childCount == 0 || e.spread < kCurved) {
    if (trees_[slot].empty()) {
      least = 0;
      return 0;
    }
    const DirectionBounds bounds = trees_[slot].bounds(glsl::to_local(frames_[slot], axis), cosine);
    least = std::min(least, largest(bounds.low));
    return largest(bounds.high);
  }
  float most = 0;
  for (uint32_t c = e.firstChild; c < e.firstChild + e.childCount; ++c)
    if (elements_[c].glossy) most = std::max(most, treeMost(c, axis, cosine, least));
  return most;
}

glm::vec3 SampleSolver::unshot(uint32_t leaf, const glm::vec3& direction) const {
  return unshot_[leaf] + treeValue(leaf, leaf, direction);
}

void SampleSolver::project(const TreeSettings& settings) {
  treeBytes_ = 0;
  tbb::enumerable_thread_specific<Worker> workers;
  tbb::parallel_for(0u, forest_.leafSlots(), [&](uint32_t leaf) {
    if (!elements_[leaf].glossy) return;
    Worker& worker = workers.local();
    collect(leaf, false, worker.lights);
    reflect(worker, leaf, settings, shown_[leaf]);
  });
  for (const Worker& worker : workers) evaluations_ += worker.builder.evaluations();
}

uint64_t SampleSolver::cellCount() const {
  uint64_t count = 0;
  for (const DirectionalTree& tree : trees_) count += tree.cellCount();
  return count;
}

/// One round of links.
class SampleSolver::Shooting {
 public:
  Shooting(SampleSolver& solver, const Occlusion& occlusion)
      : solver_(solver),
        occlusion_(occlusion),
        error_(solver.settings_.linkError * solver.reference_),
        clearance_(rayClearance(solver.space_)) {}

  void run() {
    std::vector<uint32_t> roots;
    for (const uint32_t root : solver_.forest_.roots()) roots.push_back(4 * root);
    tbb::parallel_for(size_t{0}, roots.size(), [&](size_t i) { receive(roots[i], roots); });
  }
  ShootCounts counts() const { return {pairs_.load(), links_.load(), rays_.load()}; }

 private:
  enum class Verdict { none, link, splitSender, splitReceiver };
  struct End {
    glm::vec3 position, normal;
    uint32_t leaf = 0;
  };
  /// What a pair of elements may transport.
  struct Pair {
    const Element &receiver, &sender;
    glm::vec3 offset;
    float distance = 0;
    bool cut = false;     ///< a horizon divides one end
    float transport = 0;  ///< at most: irradiance per unit of radiance
  };

  /// Takes light at an element from senders, whose links with its parent were not good enough.
  void receive(uint32_t receiver, std::vector<uint32_t> senders) {
    std::vector<uint32_t> later;
    ShootCounts counts;
    while (!senders.empty()) {
      const uint32_t sender = senders.back();
      senders.pop_back();
      ++counts.pairs;
      SampleAtElement sample{sender};
      const Verdict verdict = examine(receiver, sender, sample, counts);
      if (verdict == Verdict::link) {
        solver_.samples_[receiver].push_back(sample);
        ++counts.links;
      } else if (verdict == Verdict::splitReceiver) {
        later.push_back(sender);
      } else if (verdict == Verdict::splitSender) {
        const Element& e = solver_.elements_[sender];
        for (uint32_t child = e.firstChild + e.childCount; child-- > e.firstChild;) senders.push_back(child);
      }
    }
    pairs_ += counts.pairs;
    rays_ += counts.rays;
    links_ += counts.links;
    if ((solver_.sampleCount_ + links_) * sizeof(SampleAtElement) > solver_.settings_.memory)
      throw UsageError(
          fmt::format("illumination samples take more than the {} MiB allowed: a larger link_error or "
                      "longest_edge makes fewer",
                      solver_.settings_.memory >> 20));
    const Element& e = solver_.elements_[receiver];
    if (later.empty()) return;
    tbb::parallel_for(e.firstChild, e.firstChild + e.childCount,
                      [&](uint32_t child) { receive(child, later); });
  }

  Verdict examine(uint32_t r, uint32_t s, SampleAtElement& sample, ShootCounts& counts) const {
    const Element &receiver = solver_.elements_[r], &sender = solver_.elements_[s];
    if (r == s) return receiver.spread > kFlat ? split(receiver, sender) : Verdict::none;
    Pair pair{receiver, sender, sender.position - receiver.position};
    if (!measure(pair)) return Verdict::none;

    const bool lobe = solver_.settings_.receiver && receiver.glossy;
    const float allowed = error_ * (lobe ? std::min(4 * receiver.alpha * receiver.alpha, 1.f) : 1.f);
    const float up = glm::dot(pair.offset, receiver.normal) / std::max(pair.distance, 1e-20f);
    const float extent = sampleSpread(sender.area, pair.distance * pair.distance);
    const bool wide = lobe && extent > kLobeWidths * receiver.alpha * std::max(up, 0.1f);

    std::array<End, kRays> from, to;
    std::array<glm::vec3, kRays> light;
    std::array<float, kRays> transport{};
    float varies = 0;  // light of lobes, by the directions and places that the link stands for
    float most = solver_.most_[s];
    if (sender.glossy) {
      const float sine = (receiver.reach + sender.reach) / std::max(pair.distance, 1e-20f);
      const float cosine = sine < 1 ? std::sqrt(1 - sine * sine) : 0;
      float low = 1e30f;
      const float high = solver_.treeMost(s, -pair.offset / std::max(pair.distance, 1e-20f), cosine, low);
      varies = std::max(high - low, 0.f) * pair.transport;
      most += high;
    }
    most *= pair.transport;
    if (!(most > kNegligible * error_)) return Verdict::none;
    const bool divisible = sender.childCount > 0 || receiver.childCount > 0;
    if (divisible && most > allowed) {
      if (pair.cut || varies > kLobeVariation * allowed) return split(receiver, sender);
      if (wide && sender.childCount > 0) return Verdict::splitSender;
    }
    const uint32_t seed = mixed(r + mixed(s));
    for (int i = 0; i < kRays; ++i) {
      chooseEnds(pair, r, s, seed, i, from[i], to[i]);
      const glm::vec3 way = to[i].position - from[i].position;
      const float distance2 = std::max(glm::dot(way, way), 1e-20f);
      const glm::vec3 w = way / std::sqrt(distance2);
      transport[i] = axisTransport(sender.area, -glm::dot(to[i].normal, w), distance2) *
                     std::max(glm::dot(from[i].normal, w), 0.f);
      light[i] = solver_.unshot_[s];
      if (sender.glossy) light[i] += solver_.treeValue(s, to[i].leaf, -w);
    }
    glm::vec3 brought(0);
    float low = 1e30f, high = 0, whole = 0;
    for (int i = 0; i < kRays; ++i) {
      bool clear = transport[i] > 0;
      if (clear) {
        ++counts.rays;
        clear = !blocked(from[i], to[i]);
      }
      const glm::vec3 arrives = clear ? transport[i] * light[i] : glm::vec3(0);
      brought += arrives;
      whole += transport[i];
      low = std::min(low, largest(arrives));
      high = std::max(high, largest(arrives));
    }
    if (divisible && most > allowed && high - low > allowed) return split(receiver, sender);
    if (!(high > 0)) return Verdict::none;
    sample.radiance = brought / whole * correction(pair, from);
    return sample.radiance == glm::vec3(0) ? Verdict::none : Verdict::link;
  }

  static Verdict split(const Element& receiver, const Element& sender) {
    if (sender.childCount > 0 && (sender.reach >= receiver.reach || receiver.childCount == 0))
      return Verdict::splitSender;
    return receiver.childCount > 0 ? Verdict::splitReceiver : Verdict::none;
  }

  /// Bounds the transport, and returns whether there may be any.
  bool measure(Pair& pair) const {
    const Element &r = pair.receiver, &s = pair.sender;
    pair.distance = glm::length(pair.offset);
    const float far = pair.distance + r.reach + s.reach, least = kGrazing * pair.distance;
    // How far an element reaches along the other's normal.
    const auto along = [](const Element& e, const glm::vec3& normal) {
      const float cosine = glm::dot(e.normal, normal);
      return e.reach * std::min(std::sqrt(std::max(1 - cosine * cosine, 0.f)) + e.spread, 1.f);
    };
    const float above = glm::dot(pair.offset, r.normal), before = -glm::dot(pair.offset, s.normal);
    const float slackAbove = along(s, r.normal) + r.spread * far,
                slackBefore = along(r, s.normal) + s.spread * far;
    if (above + slackAbove <= least || before + slackBefore <= least) return false;
    pair.cut = above - slackAbove < -least || before - slackBefore < -least;
    const float gap = std::max(pair.distance - r.reach - s.reach, 0.f);
    const float cosine = gap > 0 ? std::min((before + slackBefore) / gap, 1.f) : 1.f;
    const float up = gap > 0 ? std::min((above + slackAbove) / gap, 1.f) : 1.f;
    pair.transport = axisTransport(s.area, cosine, gap * gap) * up;
    return true;
  }

  /// Chooses the ends of ray i: a leaf's centre at the receiver, which leaves within bodies have outside, and
  /// points of the surface at the sender, where what lies within bodies is hidden.
  void chooseEnds(const Pair& pair, uint32_t r, uint32_t s, uint32_t seed, int i, End& from, End& to) const {
    const auto index = static_cast<uint32_t>(i);
    const glm::vec2 place =
        glm::fract(glsl::r2_sequence(index) + glm::vec2(unit(seed), unit(mixed(seed + 1))));
    const float stratum = (static_cast<float>(i) + unit(mixed(seed + 2))) / kRays;
    float rest = unit(mixed(seed + 3 + index));
    from.leaf = pair.receiver.childCount > 0 ? leafBelow(r, rest) : r;
    from.position = solver_.elements_[from.leaf].position;
    from.normal = solver_.elements_[from.leaf].normal;
    rest = stratum;
    to.leaf = leafBelow(s, rest);
    to.position = pointOf(to.leaf, rest, place);
    to.normal = solver_.elements_[to.leaf].normal;
  }

  /// Chooses a leaf by area; `u` in [0, 1) becomes a number of the same kind.
  uint32_t leafBelow(uint32_t slot, float& u) const {
    while (solver_.elements_[slot].childCount > 0) {
      const Element& e = solver_.elements_[slot];
      float wanted = u * e.area;
      uint32_t child = e.firstChild;
      for (; child + 1 < e.firstChild + e.childCount && wanted >= solver_.elements_[child].area; ++child)
        wanted -= solver_.elements_[child].area;
      u = std::clamp(wanted / std::max(solver_.elements_[child].area, 1e-37f), 0.f, 0x1.fffffep-1f);
      slot = child;
    }
    return slot;
  }

  /// Chooses a point of a leaf's third of the triangles around its vertex.
  glm::vec3 pointOf(uint32_t leaf, float u, glm::vec2 place) const {
    const uint32_t surfel = solver_.elements_[leaf].surfel;
    const auto& fans = solver_.fans_;
    const uint32_t first = solver_.firstFan_[surfel], end = solver_.firstFan_[surfel + 1];
    if (first == end) return solver_.elements_[leaf].position;
    const float wanted = u * fans[end - 1].area;
    uint32_t fan = first;
    while (fan + 1 < end && fans[fan].area <= wanted) ++fan;
    const auto& at = solver_.surfels_.vertices;
    const glm::vec3 &a = at[surfel], &b = at[fans[fan].second], &c = at[fans[fan].third];
    // Two triangles of equal area: vertex, middle of an edge, centroid.
    const bool second = place.x < 0.5f;
    const glm::vec3 middle = 0.5f * (a + (second ? b : c)), centroid = (a + b + c) / 3.f;
    const float root = std::sqrt(glm::fract(2 * place.x));
    return a + root * ((middle - a) + place.y * (centroid - middle));
  }

  bool blocked(const End& from, const End& to) const {
    const glm::vec3 origin =
        solver_.space_.worldPoint(from.position + solver_.clearance(from.leaf) * from.normal);
    const glm::vec3 target = solver_.space_.worldPoint(to.position + clearance_ * to.normal);
    return occlusion_.blocked(origin, target - origin, 1);
  }

  /// What a disc transports over what the sample would, on the mean of the receiving ends.
  static float correction(const Pair& pair, const std::array<End, kRays>& from) {
    const Element& s = pair.sender;
    if (pair.distance * pair.distance > kNear * kNear * s.area) return 1;
    float exact = 0, sampled = 0;
    const int ends = pair.receiver.childCount > 0 ? kRays : 1;
    for (int i = 0; i < ends; ++i) {
      const glm::vec3 offset = s.position - from[i].position;
      const float distance2 = std::max(glm::dot(offset, offset), 1e-20f);
      const glm::vec3 w = offset / std::sqrt(distance2);
      exact += discIrradiance(offset, s.normal, s.area, from[i].normal);
      sampled += axisTransport(s.area, -glm::dot(s.normal, w), distance2) *
                 std::max(glm::dot(from[i].normal, w), 0.f);
    }
    constexpr float kMost = 4;  // towards the horizon nothing that the sample says is left
    return exact < kMost * sampled ? exact / sampled : sampled > 0 ? kMost : 0;
  }

  SampleSolver& solver_;
  const Occlusion& occlusion_;
  float error_, clearance_;
  std::atomic<uint64_t> pairs_{0}, links_{0}, rays_{0};
};

ShootCounts SampleSolver::shoot(const Occlusion& occlusion) {
  for (size_t slot = 0; slot < samples_.size(); ++slot)
    firstFresh_[slot] = static_cast<uint32_t>(samples_[slot].size());
  Shooting shooting(*this, occlusion);
  if (reference_ > 0) shooting.run();
  const ShootCounts counts = shooting.counts();
  sampleCount_ += counts.links;
  tbb::parallel_for(0u, forest_.leafSlots(), [&](uint32_t leaf) { gather(leaf); });
  return counts;
}

void SampleSolver::gather(uint32_t leaf) {
  if (!(elements_[leaf].area > 0)) return;
  glm::vec3 sum(0);
  visitSamples(
      leaf, [&](uint32_t slot) { return firstFresh_[slot]; },
      [&](const glsl::IncidentLight& light) {
        sum += glm::dot(elements_[leaf].normal, light.direction) * light.irradiance;
      });
  fresh_[leaf] = sum;
  irradiance_[leaf] += sum;
}

}  // namespace limn::radiosity
