#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "core/base/error.h"
#include "core/radiosity/disc_transport.h"
#include "core/radiosity/sample_solver.h"
#include "glsl/indirect/illumination_sample.glsl"
#include "glsl/materials/material_model.glsl"
#include "glsl/numeric/sampling.glsl"

namespace limn::radiosity {
namespace {

constexpr int kRays = 4;  ///< of a link

/// Rays of a link that cannot be refined further where these vary too much: between elements next to each
/// other, whose directions cover many lobes.
constexpr int kMostRays = 32;

/// Links that would transport less than this part of the error allowed are not made.
constexpr float kNegligible = 1e-3f;

/// Into narrow lobes, which allow less error than that, links are made down to this part of what they allow:
/// all of their light may come over such links. At roughness 0.2 and above it asks for no more of them.
constexpr float kNegligibleOfLobe = 0.2f;

/// Links into lobes are refined until the sender spans less than this many of the lobe's widths.
constexpr float kSenderLobeWidths = 2.5f;

/// Light may vary over the directions and places of a link, by lobes or because a horizon cuts an end, by
/// this multiple of the error allowed: these are bounds, and what rays find is far less; without them narrow
/// lobes and ends below the horizon pass between the rays.
constexpr float kBoundsExcess = 8;

/// Senders nearer than this many square roots of their area are made to transport what a disc does.
constexpr float kNear = 6;

/// Of a unit's distance: what lies in a plane sees nothing else in it.
constexpr float kGrazing = 1e-4f;

/// A cluster is flat where its normals differ by less: it does not see itself.
constexpr float kFlat = 1e-3f;

uint32_t mixed(uint32_t x) {
  x ^= x >> 16, x *= 0x7feb352du;
  x ^= x >> 15, x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

float unit(uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24f;
}

}  // namespace

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
  /// Of the irradiance that a link brings, largest channel.
  struct Bounds {
    float most, varies;
  };
  /// What the rays of a link find.
  struct Rays {
    glm::vec3 radiance{0};  ///< mean of the sender's, what is hidden taken off
    float varies = 0;       ///< the irradiance along single rays, largest channel
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
    if (solver_.pairCount_ + pairs_ > solver_.settings_.pairs)
      throw UsageError(
          fmt::format("illumination samples: links look at more than the {:g} million pairs of elements "
                      "allowed: a larger link_error or longest_edge makes fewer, a larger pairs allows more",
                      double(solver_.settings_.pairs) * 1e-6));
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
    const bool divisible = sender.childCount > 0 || receiver.childCount > 0;
    const bool lobe = solver_.settings_.receiver && receiver.glossy;
    const float allowed = error_ * (lobe ? receiver.tolerance : 1.f);
    const Bounds bounds = bound(pair, s, divisible ? allowed : 1e30f);
    if (!(bounds.most > std::min(kNegligible * error_, kNegligibleOfLobe * allowed))) return Verdict::none;
    if (divisible && bounds.most > allowed) {
      if (bounds.varies > kBoundsExcess * allowed) return split(receiver, sender);
      if (lobe && sender.childCount > 0 && wide(pair)) return Verdict::splitSender;
    }

    // What transports less than a part of the error allowed is known well enough by as many rays fewer.
    const int count = static_cast<int>(std::ceil(kRays * std::clamp(bounds.most / allowed, 0x1p-10f, 1.f)));
    Rays rays = trace(pair, r, s, count, counts);
    if (bounds.most > allowed && rays.varies > allowed) {
      if (divisible) return split(receiver, sender);
      rays = trace(pair, r, s, kMostRays, counts);
    }
    sample.radiance = rays.radiance;
    return sample.radiance == glm::vec3(0) ? Verdict::none : Verdict::link;
  }

  /// Returns whether the sender is too wide for the narrowest lobe of the receiver.
  static bool wide(const Pair& pair) {
    const float up = glm::dot(pair.offset, pair.receiver.normal) / std::max(pair.distance, 1e-20f);
    return glsl::sender_spread(pair.sender.area, pair.distance * pair.distance) >
           kSenderLobeWidths * pair.receiver.alpha * std::max(up, 0.1f);
  }

  /// Bounds the irradiance that a link brings: the most, and how much it may vary over the directions and
  /// places that the link stands for. Light of more than `allowed` is looked at more closely.
  Bounds bound(const Pair& pair, uint32_t s, float allowed) const {
    const float diffuse = solver_.most_[s];
    Bounds bounds{diffuse * pair.transport, 0};
    if (pair.sender.glossy) {
      const float distance = std::max(pair.distance, 1e-20f);
      const glm::vec3 towards = -pair.offset / distance;
      const float sine = (pair.receiver.reach + pair.sender.reach) / distance;
      // Balls around the ends that meet have lines between them in all directions.
      const float cosine = sine < 1 ? std::sqrt(1 - sine * sine) : -1;
      const float lobes = solver_.caps_[s].most(towards, cosine);
      bounds = {(diffuse + lobes) * pair.transport, lobes * pair.transport};
      // A pair that a horizon cuts is divided for its diffuse light alone, whatever the lobes send.
      const bool divided = pair.cut && diffuse * pair.transport > kBoundsExcess * allowed;
      if (bounds.most > allowed && !divided && solver_.flat(s)) {
        const DirectionBounds closer =
            solver_.trees_[s].bounds(glsl::to_local(solver_.frames_[s], towards), cosine);
        const float high = glsl::largest_channel(closer.high), low = glsl::largest_channel(closer.low);
        bounds = {(diffuse + high) * pair.transport, (high - low) * pair.transport};
      }
    }
    if (pair.cut) bounds.varies = bounds.most;
    return bounds;
  }

  /// Takes the light along rays of a link, at most kMostRays.
  Rays trace(const Pair& pair, uint32_t r, uint32_t s, int count, ShootCounts& counts) const {
    const uint32_t seed = mixed(r + mixed(s));
    std::array<End, kMostRays> from;
    glm::vec3 brought(0);
    float low = 1e30f, high = 0, whole = 0;
    for (int i = 0; i < count; ++i) {
      End to;
      chooseEnds(pair, r, s, seed, i, count, from[i], to);
      const glm::vec3 way = to.position - from[i].position;
      const float distance2 = std::max(glm::dot(way, way), 1e-20f);
      const glm::vec3 w = way / std::sqrt(distance2);
      const float transport = glsl::axis_transport(pair.sender.area, -glm::dot(to.normal, w), distance2) *
                              std::max(glm::dot(from[i].normal, w), 0.f);
      glm::vec3 arrives(0);
      if (transport > 0) {
        ++counts.rays;
        if (!blocked(from[i], to)) {
          glm::vec3 light = solver_.unshot_[s];
          if (pair.sender.glossy) light += solver_.treeValue(s, to.leaf, -w);
          arrives = transport * light;
        }
      }
      brought += arrives;
      whole += transport;
      low = std::min(low, glsl::largest_channel(arrives));
      high = std::max(high, glsl::largest_channel(arrives));
    }
    if (!(high > 0)) return {};
    return {brought / whole * correction(pair, {from.data(), static_cast<size_t>(count)}), high - low};
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
    pair.transport = glsl::axis_transport(s.area, cosine, gap * gap) * up;
    return true;
  }

  /// Chooses the ends of ray i of a number of them: a leaf's centre at the receiver, which leaves within
  /// bodies have outside, and points of the surface at the sender, where what lies within bodies is hidden.
  void chooseEnds(const Pair& pair, uint32_t r, uint32_t s, uint32_t seed, int i, int count, End& from,
                  End& to) const {
    const auto index = static_cast<uint32_t>(i);
    const glm::vec2 place =
        glm::fract(glsl::r2_sequence(index) + glm::vec2(unit(seed), unit(mixed(seed + 1))));
    const float stratum = (static_cast<float>(i) + unit(mixed(seed + 2))) / static_cast<float>(count);
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
  static float correction(const Pair& pair, std::span<const End> from) {
    const Element& s = pair.sender;
    if (pair.distance * pair.distance > kNear * kNear * s.area) return 1;
    float exact = 0, sampled = 0;
    const size_t ends = pair.receiver.childCount > 0 ? from.size() : 1;
    for (size_t i = 0; i < ends; ++i) {
      const glm::vec3 offset = s.position - from[i].position;
      const float distance2 = std::max(glm::dot(offset, offset), 1e-20f);
      const glm::vec3 w = offset / std::sqrt(distance2);
      exact += discIrradiance(offset, s.normal, s.area, from[i].normal);
      sampled += glsl::axis_transport(s.area, -glm::dot(s.normal, w), distance2) *
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
  pairCount_ += counts.pairs;
  tbb::parallel_for(0u, forest_.leafSlots(), [&](uint32_t leaf) { gather(leaf); });
  return counts;
}

}  // namespace limn::radiosity
