#include "techniques/texture_space_subsurface/body_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/scene/charts.h"
#include "core/scene/draw_instance.h"
#include "core/scene/instance_areas.h"
#include "glsl/diffusion/boundary.glsl"
#include "techniques/texture_space_subsurface/gaussians.h"

namespace limn::texture_space {
namespace {

/// Part of each channel's light that is looked for around a chart: more takes texels from the charts.
constexpr double kReach = 0.95;
/// Of a body's extent over its texels: a chart has at least about a texel around it, from which pixels at its
/// border are interpolated.
constexpr float kLeastMargin = 4;
/// A texel may get so much smaller before areas have changed by more than half in each plane: 1.5^(3/2).
constexpr double kShrinks = 1.84;
/// Bytes of all textures together.
constexpr int64_t kMostBytes = int64_t{2} << 30;

/// Returns the vertices of a draw in the world, m.
std::vector<glm::vec3> placesOf(const LaidOutDraw& laid, const scene::DrawInstance& draw) {
  const bool deformed = draw.deformed != scene::kNone;
  std::vector<glm::vec3> places = deformed ? laid.deformed.positions() : laid.primitive->positions;
  for (glm::vec3& p : places) p = glm::vec3(draw.objectToWorld * glm::vec4(p, 1));
  return places;
}

/// Moves the vertices of a draw to a pose, and returns the area of all its triangles before its matrix; 0 of
/// those that nothing deforms.
double deformedArea(const scene::Pose& pose, const scene::DrawInstance& draw, LaidOutDraw& laid) {
  if (draw.deformed == scene::kNone) return 0;
  laid.deformed.move(*laid.primitive, pose.deformed[static_cast<size_t>(draw.deformed)]);
  return laid.deformed.area();
}

float largestExtent(std::span<const glm::vec3> places) {
  scene::Bounds box;
  for (const glm::vec3& p : places) box.add(p);
  const glm::vec3 extent = box.high - box.low;
  return std::max({extent.x, extent.y, extent.z});
}

}  // namespace

BodyMatter bodyMatter(const scene::Scene& scene, const scene::Pose& pose, bool normalised, int count) {
  scene::TranslucentKinds kinds = scene::translucentKinds(scene, pose);
  BodyMatter result;
  result.ofMaterials = std::move(kinds.ofMaterials);
  result.textured = kinds.textured;
  for (const scene::TranslucentKind& kind : kinds.kinds) {
    const scene::Profile profile =
        scene::diffusionProfile(kind.extinction, kind.absorption, kind.ior, normalised);
    result.kinds.push_back(
        {.reflectance = glm::vec3(profile[0].reflectance, profile[1].reflectance, profile[2].reflectance),
         .eta = kind.ior,
         .entering = glsl::diffusion_boundary(kind.ior).entering,
         .textured = kind.textured ? 1u : 0u,
         .unused = glm::uvec2(0)});
    for (const Gaussian& g : fitGaussians(profile, count))
      result.gaussians.push_back({.weight = glm::vec3(g.weight), .sigma = static_cast<float>(g.sigma)});
    double& reach = result.reach.emplace_back(0);
    for (const scene::ChannelProfile& channel : profile)
      if (channel.reflectance > 0) reach = std::max(reach, radiusOfShare(channel, kReach));
  }
  return result;
}

std::vector<LaidOutDraw> translucentDraws(const scene::Scene& scene, const scene::Pose& pose,
                                          const BodyMatter& matter) {
  std::vector<LaidOutDraw> result;
  for (uint32_t draw = 0; draw < pose.instances.size(); ++draw) {
    const scene::DrawInstance& instance = pose.instances[draw];
    LaidOutDraw laid{};
    laid.draw = draw;
    laid.kind = matter.ofMaterials[static_cast<size_t>(scene::materialIndexOf(scene, instance))];
    if (laid.kind == glsl::no_kind) continue;
    if (instance.node == scene::kNone)
      laid.source = pose.dynamic[static_cast<size_t>(instance.mesh)].primitive;
    laid.primitive = &scene::primitiveOf(scene, pose, instance);
    laid.mirrored = scene::mirrored(instance);
    laid.areas = scene::areaFactors(instance.objectToWorld);
    laid.area = deformedArea(pose, instance, laid);
    result.push_back(std::move(laid));
  }
  return result;
}

bool fits(const scene::Pose& pose, std::span<LaidOutDraw> draws) {
  return std::ranges::all_of(draws, [&](LaidOutDraw& laid) {
    const scene::DrawInstance& instance = pose.instances[laid.draw];
    const bool same =
        !laid.source || pose.dynamic[static_cast<size_t>(instance.mesh)].primitive == laid.source;
    return same && scene::mirrored(instance) == laid.mirrored &&
           scene::areasAlike(scene::areaFactors(instance.objectToWorld), laid.areas) &&
           scene::areasAlike(glm::dvec3(deformedArea(pose, instance, laid)), glm::dvec3(laid.area));
  });
}

int firstSpread(const BodyTextures& textures, const BodyMatter& matter, int count) {
  const auto spreads = [&](int gaussian) {
    for (size_t i = 0; i < textures.bodies.size(); ++i) {
      const size_t at = textures.bodies[i].kind * static_cast<size_t>(count) + static_cast<size_t>(gaussian);
      if (2 * static_cast<double>(matter.gaussians[at].sigma) >= textures.ranges[i].texel) return true;
    }
    return false;
  };
  int first = 0;
  while (first < count && !spreads(first)) ++first;
  return first;
}

void checkLayers(const BodyTextures& textures, int texels, const TextureLimits& limits) {
  const int64_t most = std::min(limits.layers, kMostBytes / limits.layerBytes);
  if (static_cast<int64_t>(textures.bodies.size()) > most)
    throw UsageError(
        fmt::format("texture_space_subsurface: {} translucent bodies; textures of {} x {} texels are made "
                    "for {} at most, with {} MiB",
                    textures.bodies.size(), texels, texels, most, most * limits.layerBytes >> 20));
}

BodyTextures bodyTextures(const scene::Pose& pose, std::span<const LaidOutDraw> draws,
                          const BodyMatter& matter, int texels, int64_t cornerBytes) {
  BodyTextures result;
  const auto mostCorners = static_cast<size_t>(cornerBytes) / sizeof(glsl::ChartCorner);
  const auto slots = static_cast<size_t>(texels / 3);  // a chart takes 3 x 3 texels at least
  for (const LaidOutDraw& laid : draws) {
    const scene::DrawInstance& instance = pose.instances[laid.draw];
    const scene::Primitive& primitive = *laid.primitive;
    const std::vector<glm::vec3> places = placesOf(laid, instance);
    const double least = static_cast<double>(kLeastMargin * largestExtent(places)) / texels;
    auto made =
        scene::makeCharts(places, primitive.indices, std::max(matter.reach[laid.kind], least),
                          {.charts = slots * slots, .triangles = (mostCorners - result.corners.size()) / 3});
    if (made && made->empty()) continue;  // it has no area
    const double scale = made ? scene::packCharts(*made, texels) : 0;
    if (!(scale > 0)) {
      ++result.tooMany;
      continue;
    }
    const std::vector<scene::Chart>& charts = *made;
    CornerRange range{.first = static_cast<uint32_t>(result.corners.size()),
                      .texel = instance.deformed == scene::kNone ? 1 / (scale * kShrinks) : 0};
    const auto add = [&](std::vector<uint32_t> scene::Chart::*triangles) {
      const size_t before = result.corners.size();
      for (size_t c = 0; c < charts.size(); ++c)
        for (const uint32_t t : charts[c].*triangles)
          for (size_t k = 0; k < 3; ++k) {
            const uint32_t vertex = primitive.indices[3 * static_cast<size_t>(t) + k];
            const glm::dvec2 place =
                glm::dvec2(scene::acrossAxis(places[vertex], charts[c].axis) - charts[c].lowest);
            result.corners.push_back({.place = glm::vec2(place * scale + glm::dvec2(charts[c].corner)),
                                      .vertex = vertex,
                                      .chart = static_cast<uint32_t>(c + 1)});
          }
      return static_cast<uint32_t>(result.corners.size() - before);
    };
    range.surroundings = add(&scene::Chart::surroundings);
    range.own = add(&scene::Chart::triangles);
    result.ranges.push_back(range);
    result.bodies.push_back({.instance = laid.draw, .kind = laid.kind, .unused = glm::uvec2(0)});
  }
  return result;
}

}  // namespace limn::texture_space
