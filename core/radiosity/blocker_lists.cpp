#include "core/radiosity/blocker_lists.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "glsl/numeric/geometry.glsl"

namespace limn::radiosity {
namespace {

/// Leaves that are worked off together.
constexpr uint32_t kPart = 64;

/// Parts that are listed at a time, before what there is room for is kept: lists of 256 MiB at most, however
/// many leaves a scene has.
constexpr uint32_t kTogether = 256;

/// Directions that find whether a light's bins are all filled: as many as there are bins in a cone of 0.45
/// radians, with 16 bins a side.
constexpr int kDirections = 64;

/// Points that are nearer to a plane than this, in radii of the scene, lie in it.
constexpr float kClearance = 0x1p-16f;

std::array<glm::vec3, 3> cornersOf(const SceneElements& elements, uint32_t triangle) {
  const auto corner = [&](uint32_t k) {
    return elements.leaves()[elements.triangles()[3 * triangle + k]].vertex;
  };
  return {corner(0), corner(1), corner(2)};
}

/// Returns the sphere around a box that holds the spheres, which are all that has a radius of at least 0.
glm::vec4 around(std::span<const glm::vec4> spheres) {
  glm::vec3 low(1e30f), high(-1e30f);
  for (const glm::vec4& s : spheres) {
    if (s.w < 0) continue;
    low = glm::min(low, glm::vec3(s) - s.w);
    high = glm::max(high, glm::vec3(s) + s.w);
  }
  if (low.x > high.x) return {0, 0, 0, -1};
  const glm::vec3 centre = 0.5f * (low + high);
  float radius = 0;
  for (const glm::vec4& s : spheres)
    if (s.w >= 0) radius = std::max(radius, glm::length(glm::vec3(s) - centre) + s.w);
  return {centre, radius};
}

glm::vec4 around(const std::array<glm::vec3, 3>& corners) {
  const glm::vec4 points[] = {{corners[0], 0}, {corners[1], 0}, {corners[2], 0}};
  return around(points);
}

}  // namespace

LightBounds LightBounds::of(const glsl::Light& light) {
  LightBounds b{.object = light.own_instance};
  const float half = 0.5f * std::hypot(light.length_u, light.length_v);
  switch (glsl::light_kind(light)) {
    case glsl::light_kind_point:
      b.centre = light.position;
      break;
    case glsl::light_kind_rectangle:
      b.centre = light.position;
      b.radius = half;
      b.halves[0] = 0.5f * light.length_u * light.axis_u;
      b.halves[1] = 0.5f * light.length_v * light.axis_v;
      break;
    case glsl::light_kind_disc:
      b.centre = -light.direction;
      b.radius = std::sin(0.5f * light.angular_diameter);
      b.distant = true;
      b.wideDisc = light.angular_diameter > kWidestDisc;
      break;
    default:  // a distant rectangle: its centre is a direction
      b.centre = glm::normalize(light.position);
      b.radius = std::min(half / glm::length(light.position), 0.99f);
      b.distant = true;
      break;
  }
  return b;
}

/// The ways from a leaf's part of the surface to a light: spheres whose radius grows along an axis,
/// within the planes through the sides of a rectangle that touch the first sphere.
struct BlockerLists::Shaft {
  glm::vec3 from, normal;
  float radius, height, clearance;
  glm::vec3 axis{0};  ///< unit
  float growth = 1;   ///< of the radius per metre; 1 or more: all is within
  float lean = 0;     ///< of the shortest way to a surface of this growth: along the axis per metre away
  float length = 1e30f;
  std::array<glm::vec4, 4> sides{};  ///< dot((p, -1), side) > 0 outside
  size_t sideCount = 0;

  Shaft(const Leaf& leaf, const Receiver& receiver, const LightBounds& light, float unit)
      : from(leaf.vertex),
        normal(leaf.normal),
        radius(receiver.reach),
        height(receiver.height),
        clearance(kClearance * unit) {
    if (light.distant) {
      axis = light.centre;
      growth = light.radius;
    } else if (const float distance = glm::length(light.centre - from); distance > 0) {
      axis = (light.centre - from) / distance;
      growth = (light.radius - radius) / distance;
      length = distance;
    }
    if (std::abs(growth) < 1) lean = growth / std::sqrt(1 - growth * growth);
    for (size_t k = 0; k < 2; ++k)
      for (const float sign : {-1.f, 1.f}) bound(light, sign * light.halves[k], light.halves[1 - k]);
  }

  /// Adds the plane through the side of a rectangle at `half` from its centre, along `other`.
  void bound(const LightBounds& light, const glm::vec3& half, const glm::vec3& other) {
    if (half == glm::vec3(0) || other == glm::vec3(0)) return;
    const glm::vec3 along = glm::normalize(other), out = glm::normalize(half);
    const glm::vec3 to = light.centre + half - from, across = to - glm::dot(to, along) * along;
    const float distance = glm::length(across);
    if (!(distance > 1.001f * radius)) return;
    const float cosine = radius / distance, sine = std::sqrt(1 - cosine * cosine);
    glm::vec3 turned = glm::cross(along, across / distance);
    if (glm::dot(turned, out) < 0) turned = -turned;
    const glm::vec3 m = cosine * across / distance + sine * turned;
    if (glm::dot(m, out) >= 0) sides[sideCount++] = {m, glm::dot(m, from) + radius};
  }

  /// Returns whether the sphere meets it: the distance to the axis, less the radius there, is least where
  /// its derivative vanishes.
  bool meets(const glm::vec4& sphere) const {
    if (std::abs(growth) >= 1) return true;
    const glm::vec3 to = glm::vec3(sphere) - from;
    const float along = glm::dot(to, axis), away = glm::length(to - along * axis);
    const float at = std::clamp(along + away * lean, 0.f, length);
    const float rest = along - at, reach = radius + growth * at + sphere.w;
    if (reach < 0 || rest * rest + away * away > reach * reach) return false;
    for (size_t k = 0; k < sideCount; ++k)
      if (glm::dot(glm::vec3(sides[k]), glm::vec3(sphere)) - sides[k].w > sphere.w) return false;
    return true;
  }

  /// Returns whether a way may cross the triangle's plane from its front, or, if `backs`, either way.
  bool crosses(const Triangle& triangle, const LightBounds& light, bool backs) const {
    const float cosine = glm::dot(triangle.normal, normal);
    const float sine = glm::length(glm::cross(triangle.normal, normal));
    const float extent = std::min(radius * sine + std::abs(cosine) * height, radius);
    const float here = glm::dot(triangle.normal, from) - triangle.offset;
    const float there = glm::dot(triangle.normal, light.centre) - (light.distant ? 0 : triangle.offset);
    if (here + extent > 0 && there <= light.radius) return true;
    return backs && here - extent < -clearance && there >= -light.radius;
  }
};

void BlockerLists::bound(const SceneElements& elements) {
  const Forest& forest = elements.forest();
  bounds_.resize(forest.slots());
  const auto levels = forest.levels();
  shapes_.resize(elements.triangles().size() / 3);
  tbb::parallel_for(size_t{0}, shapes_.size(), [&](size_t t) {
    const auto corners = cornersOf(elements, static_cast<uint32_t>(t));
    const glm::vec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const float size = glm::length(across);
    const glm::vec3 normal = size > 0 ? across / size : glm::vec3(0);
    shapes_[t] = {around(corners), normal, glm::dot(normal, corners[0])};
  });
  tbb::parallel_for(0u, forest.leafSlots(), [&](uint32_t leaf) {
    glm::vec4 all(0, 0, 0, -1);
    for (uint32_t t = forest.firstTriangle()[leaf]; t < forest.firstTriangle()[leaf + 1]; ++t) {
      const glm::vec4 both[] = {all, shapes_[t].sphere};
      all = around(both);
    }
    bounds_[leaf] = all;
  });
  for (size_t level = 1; level < levels.size(); ++level)
    tbb::parallel_for(levels[level].first, levels[level].first + levels[level].count, [&](uint32_t g) {
      const glsl::ElementGroup& group = forest.groups()[g];
      for (uint32_t lane = 0; lane < 4; ++lane)
        bounds_[4 * g + lane] =
            lane < group.lanes ? around(std::span(bounds_).subspan(size_t{4} * (group.children + lane), 4))
                               : glm::vec4(0, 0, 0, -1);
    });
}

void BlockerLists::findHidden(const SceneElements& elements, const Links& links, const LightBounds& light) {
  const Forest& forest = elements.forest();
  const ElementSpace& space = elements.space();
  const auto n = static_cast<uint32_t>(links.resolution());
  const auto place = [&](uint32_t slot) {
    const glsl::ElementGroup& g = forest.groups()[slot / 4];
    const auto lane = static_cast<int>(slot % 4);
    return glm::vec3(g.x[lane], g.y[lane], g.z[lane]);
  };
  tbb::parallel_for(0u, forest.leafSlots(), [&](uint32_t leaf) {
    hidden_[leaf] = 0;
    if (elements.leaves()[leaf].used == 0) return;
    const glm::vec3 way =
        light.distant ? light.centre : light.centre - glm::vec3(elements.leaves()[leaf].position);
    const float distance = light.distant ? 1 : glm::length(way);
    if (!(distance > light.radius)) return;
    const float most = light.distant ? 1e30f : (distance - light.radius) / space.radius();
    // The light with a bin around it, as a disc at distance 1.
    const float extent =
        std::tan(std::min(std::asin(light.radius / distance) + 0.5f * glsl::pi / float(n), 1.5f));
    const glm::vec3 axis = space.direction(way / distance), own = place(leaf);
    const glsl::Frame side = glsl::frame_around(axis);
    for (int i = 0; i < kDirections; ++i) {  // a spiral of even density
      const float r = extent * std::sqrt((float(i) + 0.5f) / kDirections), turn = 2.39996323f * float(i);
      const glm::vec3 to = axis + r * (std::cos(turn) * side.t + std::sin(turn) * side.b);
      const uint32_t link = links.of(leaf)[glsl::bin_of(to, n)];
      if (link == glsl::no_link) return;
      if (glm::length(place(link & ~glsl::link_back) - own) > most) return;
    }
    hidden_[leaf] = 1;
  });
}

/// Sets the extents of the leaves' parts of the surface, which no light changes.
void BlockerLists::measureReceivers(const SceneElements& elements) {
  receivers_.assign(elements.forest().leafSlots(), {});
  const auto triangles = elements.triangles();
  for (size_t t = 0; t < shapes_.size(); ++t) {
    const uint32_t* const corners = &triangles[3 * t];
    const auto place = [&](size_t k) { return elements.leaves()[corners[k % 3]].vertex; };
    const glm::vec3 middle = (place(0) + place(1) + place(2)) / 3.f;
    for (size_t k = 0; k < 3; ++k) {
      Receiver& receiver = receivers_[corners[k]];
      const glm::vec3 normal(elements.leaves()[corners[k]].normal);
      for (const glm::vec3 to :
           {0.5f * (place(k + 1) - place(k)), 0.5f * (place(k + 2) - place(k)), middle - place(k)}) {
        receiver.reach = std::max(receiver.reach, glm::length(to));
        receiver.height = std::max(receiver.height, std::abs(glm::dot(to, normal)));
      }
    }
  }
}

void BlockerLists::findReceivers(const SceneElements& elements, const LightBounds& light) {
  for (Receiver& receiver : receivers_) receiver.listed = false;
  const auto triangles = elements.triangles();
  for (size_t t = 0; t < shapes_.size(); ++t) {
    const uint32_t* const corners = &triangles[3 * t];
    const float there = glm::dot(shapes_[t].normal, light.centre) - (light.distant ? 0 : shapes_[t].offset);
    const bool faces = there > -light.radius;
    const bool hidden = hidden_[corners[0]] && hidden_[corners[1]] && hidden_[corners[2]];
    if (!faces || hidden) continue;
    for (size_t k = 0; k < 3; ++k) receivers_[corners[k]].listed = true;
  }
}

void BlockerLists::list(const SceneElements& elements, const LightBounds& light, uint32_t leaf,
                        Part& part) const {
  auto& [out, waiting] = part;
  const Forest& forest = elements.forest();
  const Shaft shaft(elements.leaves()[leaf], receivers_[leaf], light, elements.space().radius());
  const uint32_t leafGroups = forest.levels().front().count;
  const size_t most = out.size() + kLongest;
  waiting.assign(forest.roots().begin(), forest.roots().end());
  while (!waiting.empty() && out.size() <= most) {
    const uint32_t g = waiting.back();
    waiting.pop_back();
    const glsl::ElementGroup& group = forest.groups()[g];
    if (group.object == light.object) continue;
    for (uint32_t lane = 0; lane < group.lanes; ++lane) {
      const uint32_t slot = 4 * g + lane;
      if (bounds_[slot].w < 0 || !shaft.meets(bounds_[slot])) continue;
      if (g >= leafGroups) {
        waiting.push_back(group.children + lane);
        continue;
      }
      for (uint32_t t = forest.firstTriangle()[slot]; t < forest.firstTriangle()[slot + 1]; ++t) {
        const Triangle& triangle = shapes_[t];
        const bool backs = group.backs != 0;
        if (shaft.crosses(triangle, light, backs) && shaft.meets(triangle.sphere))
          out.push_back(backs ? t | kBothSides : t);
      }
    }
  }
}

void BlockerLists::build(const SceneElements& elements, const Links* links,
                         std::span<const LightBounds> lights, size_t perLight) {
  const uint32_t leaves = elements.forest().leafSlots(), parts = (leaves + kPart - 1) / kPart;
  ranges_.resize(lights.size() * leaves);
  triangles_.clear();
  if (leaves == 0) return;
  if (std::ranges::all_of(lights, &LightBounds::wideDisc)) {
    std::ranges::fill(ranges_, Range{});
    return;
  }
  bound(elements);
  measureReceivers(elements);
  parts_.resize(std::min(parts, kTogether));
  hidden_.assign(leaves, 0);
  for (size_t l = 0; l < lights.size(); ++l) {
    const std::span<Range> ranges = std::span(ranges_).subspan(l * leaves, leaves);
    if (lights[l].wideDisc) {
      std::ranges::fill(ranges, Range{});
      continue;
    }
    if (links) findHidden(elements, *links, lights[l]);
    findReceivers(elements, lights[l]);
    const size_t most = triangles_.size() + perLight;
    for (uint32_t first = 0; first < parts; first += kTogether)
      listParts(elements, lights[l], first, std::min(first + kTogether, parts), most, ranges);
  }
}

void BlockerLists::listParts(const SceneElements& elements, const LightBounds& light, uint32_t firstPart,
                             uint32_t endPart, size_t most, std::span<Range> ranges) {
  const auto leavesOf = [&](uint32_t part) {
    return std::pair(kPart * part, std::min(kPart * (part + 1), static_cast<uint32_t>(ranges.size())));
  };
  tbb::parallel_for(firstPart, endPart, [&](uint32_t part) {
    std::vector<uint32_t>& out = parts_[part - firstPart].triangles;
    out.clear();
    const auto [firstLeaf, endLeaf] = leavesOf(part);
    for (uint32_t leaf = firstLeaf; leaf < endLeaf; ++leaf) {
      const size_t first = out.size();
      ranges[leaf] = {};
      if (!receivers_[leaf].listed) continue;
      list(elements, light, leaf, parts_[part - firstPart]);
      const size_t count = out.size() - first;
      if (count <= kLongest)
        ranges[leaf] = {static_cast<uint32_t>(first), static_cast<uint32_t>(count)};
      else
        out.resize(first);
    }
  });
  for (uint32_t part = firstPart; part < endPart; ++part) {
    const std::vector<uint32_t>& own = parts_[part - firstPart].triangles;
    const bool room = triangles_.size() + own.size() <= most;
    const auto [firstLeaf, endLeaf] = leavesOf(part);
    for (uint32_t leaf = firstLeaf; leaf < endLeaf; ++leaf) {
      if (ranges[leaf].count == kUnlisted) continue;
      if (ranges[leaf].count == 0)
        ranges[leaf].first = 0;
      else if (room)
        ranges[leaf].first += static_cast<uint32_t>(triangles_.size());
      else
        ranges[leaf] = {};
    }
    if (room) triangles_.insert(triangles_.end(), own.begin(), own.end());
  }
}

}  // namespace limn::radiosity
