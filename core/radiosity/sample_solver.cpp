#include "core/radiosity/sample_solver.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/radiosity/illumination.h"
#include "core/radiosity/private/tree_memory.h"
#include "glsl/indirect/illumination_sample.glsl"
#include "glsl/materials/material_model.glsl"
#include "glsl/numeric/srgb.glsl"

namespace limn::radiosity {
namespace {

/// Of the error allowed, lobes allow this multiple of alpha^2 over their reflectance, at most all: about what
/// their peak and the light of white paint are apart.
constexpr float kLobeTolerance = 3;

/// Elements whose normals differ by more have no tree over one hemisphere: their leaves' trees stand for
/// them.
constexpr float kCurved = 0.5f;

float lobeTolerance(const glsl::SurfaceBrdf& brdf) {
  const float reflectance =
      glsl::largest_channel(brdf.f0 + (brdf.f90 - brdf.f0) / 21.f);  // Schlick's, on average
  return std::min(kLobeTolerance * brdf.alpha * brdf.alpha / std::max(reflectance, 1e-6f), 1.f);
}

}  // namespace

SampleSolver::SampleSolver(const Surfels& surfels, const Forest& forest, const ElementSpace& space,
                           std::span<const LeafMaterial> materials, const SampleSettings& settings)
    : surfels_(surfels), forest_(forest), space_(space), settings_(settings), materials_(materials) {
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
  caps_.assign(slots, {});
  lights_.resize(leaves);
  trees_.resize(slots);
  shown_.resize(leaves);
  samples_.resize(slots);
  firstFresh_.assign(slots, 0);
  for (auto& lights : lights_) lights.clear();
  for (auto& tree : trees_) tree.clear();
  for (auto& tree : shown_) tree.clear();
  for (auto& samples : samples_) samples.clear();
  lightBytes_ = 0;
  sampleCount_ = evaluations_ = pairCount_ = 0;
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
        e.alpha = e.glossy ? brdf(4 * g + lane).alpha : 1;
        e.tolerance = e.glossy ? lobeTolerance(brdf(4 * g + lane)) : 1;
        continue;
      }
      e.firstChild = 4 * (group.children + lane);
      e.childCount = groups[group.children + lane].lanes;
      e.reach = 0;
      e.alpha = 1;
      e.tolerance = 1;
      e.glossy = false;
      for (uint32_t c = e.firstChild; c < e.firstChild + e.childCount; ++c) {
        e.reach = std::max(e.reach, glm::length(elements_[c].position - e.position) + elements_[c].reach);
        e.alpha = std::min(e.alpha, elements_[c].alpha);
        e.tolerance = std::min(e.tolerance, elements_[c].tolerance);
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

Sender SampleSolver::sender(uint32_t slot) const {
  const Element& e = elements_[slot];
  if (e.surfel == glsl::no_link) return {e.position, e.normal, std::sqrt(e.area) * frames_[slot].t, e.area};
  // Leaves lie a little above their surface, so that what touches it would lie behind them.
  const float above = std::max(glm::dot(e.position - surfels_.vertices[e.surfel], e.normal), 0.f);
  return {e.position - above * e.normal, e.normal, longSide(slot), e.area};
}

glm::vec3 SampleSolver::longSide(uint32_t leaf) const {
  const Element& e = elements_[leaf];
  const glsl::Frame& frame = frames_[leaf];
  // Twice the sums over triangles of area, and of places from the vertex and their products times area.
  float whole = 0;
  glm::vec2 place(0);
  glm::vec3 products(0);  // xx, yy, xy
  for (uint32_t f = firstFan_[e.surfel]; f < firstFan_[e.surfel + 1]; ++f) {
    const glm::vec3 &a = surfels_.vertices[e.surfel], &b = surfels_.vertices[fans_[f].second],
                    &c = surfels_.vertices[fans_[f].third];
    const glm::vec3 middle = (b + c - 2.f * a) / 3.f;
    for (const glm::vec3& edge : {0.5f * (b - a), 0.5f * (c - a)}) {
      const glm::vec2 p(glm::dot(edge, frame.t), glm::dot(edge, frame.b));
      const glm::vec2 q(glm::dot(middle, frame.t), glm::dot(middle, frame.b));
      const float area = glm::length(glm::cross(edge, middle));
      whole += area;
      place += area / 3 * (p + q);
      // Over a triangle with a corner at 0: area / 12 (p p + q q + s s), s = p + q.
      for (const glm::vec2& corner : {p, q, p + q})
        products += area / 12 * glm::vec3(corner.x * corner.x, corner.y * corner.y, corner.x * corner.y);
    }
  }
  if (!(whole > 0)) return std::sqrt(e.area) * frame.t;
  place /= whole;
  products = products / whole - glm::vec3(place.x * place.x, place.y * place.y, place.x * place.y);
  const float mean = 0.5f * (products.x + products.y), half = 0.5f * (products.x - products.y);
  const float root = std::sqrt(half * half + products.z * products.z);
  const float angle = 0.5f * std::atan2(products.z, half);
  // Sides are as the roots of the moments along them, at most eight to one.
  if (!(mean + root > 0)) return std::sqrt(e.area) * frame.t;
  const float aspect = std::sqrt((mean + root) / std::max(mean - root, (mean + root) / 64));
  return std::sqrt(e.area * aspect) * (std::cos(angle) * frame.t + std::sin(angle) * frame.b);
}

void SampleSolver::light(uint32_t leaf, const glm::vec3& irradiance,
                         std::span<const glsl::IncidentLight> incident) {
  fresh_[leaf] = irradiance;
  if (!glossy(leaf)) return;
  if ((lightBytes_ += incident.size_bytes()) > settings_.memory)
    throw UsageError(
        fmt::format("illumination samples: the light of lights at glossy elements takes more than the {} MiB "
                    "allowed: fewer lights or a larger longest_edge make it less",
                    settings_.memory >> 20));
  lights_[leaf].reserve(lights_[leaf].size() + incident.size());
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
          w, glsl::sender_spread(sender.area, distance2),
          sample.radiance * glsl::axis_transport(sender.area, -glm::dot(sender.normal, w), distance2)});
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

void SampleSolver::reflect(Worker& worker, uint32_t leaf, const glm::vec3& diffuse,
                           const TreeSettings& settings, DirectionalTree& tree) {
  tree.clear();
  const float beside = glsl::luminance(diffuse);
  if (!settings_.immediate) {
    worker.lobes.set(brdf(leaf), worker.lights, settings_.widen);
    if (worker.lobes.size() > 0) worker.builder.build(worker.lobes, settings, tree, beside);
    count(tree);
    return;
  }
  for (const glsl::IncidentLight& light : worker.lights) {
    worker.lobes.set(brdf(leaf), {&light, 1}, settings_.widen);
    if (worker.lobes.size() == 0) continue;
    worker.builder.build(worker.lobes, settings, worker.single, beside);
    if (tree.empty())
      std::swap(tree, worker.single);
    else
      tree.add(worker.single);
  }
  count(tree);
}

void SampleSolver::count(const DirectionalTree& tree) {
  if ((treeBytes_ += tree.memory()) > settings_.memory) refuseTrees(settings_.memory);
}

void SampleSolver::reflect() {
  const size_t leaves = forest_.leafSlots();
  if (reference_ == 0) {
    double flux = 0, area = 0;
    for (size_t leaf = 0; leaf < leaves; ++leaf) {
      flux += double(elements_[leaf].area) * glsl::largest_channel(fresh_[leaf]);
      area += elements_[leaf].area;
    }
    reference_ = area > 0 ? static_cast<float>(flux / area) : 0;
  }
  const bool first = sampleCount_ == 0;
  treeBytes_ = 0;
  tbb::enumerable_thread_specific<Worker> workers;
  tbb::parallel_for(0u, static_cast<uint32_t>(leaves), [&](uint32_t leaf) {
    unshot_[leaf] = glsl::diffuse_albedo(brdf(leaf)) * fresh_[leaf] * glsl::inverse_pi;
    most_[leaf] = glsl::largest_channel(unshot_[leaf]);
    caps_[leaf].clear();
    if (!elements_[leaf].glossy) return;
    Worker& worker = workers.local();
    if (first)
      worker.lights.swap(lights_[leaf]);
    else
      collect(leaf, true, worker.lights);
    lights_[leaf].clear();
    reflect(worker, leaf, unshot_[leaf], settings_.tree, trees_[leaf]);
    caps_[leaf].include(trees_[leaf], frames_[leaf]);
  });
  fresh_.assign(leaves, glm::vec3(0));
  pullUp(forest_, unshot_);
  for (const Forest::Level& level : forest_.levels().subspan(1))
    tbb::parallel_for(4 * level.first, 4 * (level.first + level.count), [&](uint32_t slot) {
      const Element& e = elements_[slot];
      most_[slot] = 0;
      caps_[slot].clear();
      for (uint32_t c = e.firstChild; c < e.firstChild + e.childCount; ++c) {
        most_[slot] = std::max(most_[slot], most_[c]);
        if (elements_[c].glossy) caps_[slot].include(caps_[c]);
      }
      if (e.glossy && flat(slot)) pullTree(workers.local(), slot);
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
    worker.parts.push_back(
        {.tree = &trees_[c], .frame = frames_[c], .area = elements_[c].area, .diffuse = unshot_[c]});
  worker.builder.pull(worker.parts, frames_[slot], settings_.tree, trees_[slot]);
  count(trees_[slot]);
}

uint64_t SampleSolver::mostSamplesAround() const {
  const std::span<const uint32_t> corners = forest_.triangles(), parents = forest_.parents();
  uint64_t most = 0;
  for (size_t t = 0; t + 2 < corners.size(); t += 3) {
    std::array<uint32_t, 3> at{corners[t], corners[t + 1], corners[t + 2]};
    if (std::ranges::none_of(at, [&](uint32_t leaf) { return glossy(leaf); })) continue;
    uint64_t samples = 0;
    while (std::ranges::any_of(at, [](uint32_t slot) { return slot != glsl::no_link; })) {
      for (size_t k = 0; k < at.size(); ++k) {
        const bool counted = (k > 0 && at[k] == at[0]) || (k > 1 && at[k] == at[1]);
        if (at[k] != glsl::no_link && !counted) samples += samples_[at[k]].size();
      }
      for (uint32_t& slot : at)
        if (slot != glsl::no_link) slot = parents[slot / 4];
    }
    most = std::max(most, samples);
  }
  return most;
}

glm::vec3 SampleSolver::treeValue(uint32_t slot, uint32_t leaf, const glm::vec3& direction) const {
  const uint32_t from = flat(slot) ? slot : leaf;
  return trees_[from].empty() ? glm::vec3(0) : trees_[from].value(glsl::to_local(frames_[from], direction));
}

bool SampleSolver::flat(uint32_t slot) const {
  return elements_[slot].childCount == 0 || elements_[slot].spread < kCurved;
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
    reflect(worker, leaf, glsl::diffuse_albedo(brdf(leaf)) * irradiance_[leaf] * glsl::inverse_pi, settings,
            shown_[leaf]);
  });
  for (const Worker& worker : workers) evaluations_ += worker.builder.evaluations();
}

uint64_t SampleSolver::cellCount() const {
  uint64_t count = 0;
  for (const DirectionalTree& tree : trees_) count += tree.cellCount();
  return count;
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
