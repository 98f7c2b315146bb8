#include "core/shadow/private/map_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/same_bytes.h"
#include "core/gpu/device.h"
#include "core/shadow/light_fit.h"
#include "core/shadow/private/map_memory.h"

namespace limn::shadow {
namespace {

constexpr int64_t kKeptBytesPerTexel = 8;        // linear depth, and rasterised depth beside it
constexpr int64_t kReflectiveBytesPerTexel = 8;  // normal, and albedo or instance, on top

int64_t layerBytes(const ShadowMapDesc& desc) {
  return int64_t{desc.size} * desc.size *
         (kKeptBytesPerTexel + (desc.reflective ? kReflectiveBytesPerTexel : 0));
}

std::string_view projectionName(const LightLayout& layout) {
  if (layout.projection == glsl::shadow_orthographic) return "orthographic";
  if (layout.faces == glsl::shadow_faces_cube) return "cube";
  return layout.faces == glsl::shadow_faces_hemicube ? "hemicube" : "perspective";
}

/// What --stats says about a light with such views, of those that show something the first.
ShadowMapStats shownBy(std::span<const glsl::ShadowView> views, ShadowMapStats light) {
  const auto shown = std::ranges::find_if_not(views, showsNothing);
  if (shown == views.end()) return light;
  light.near = shown->near;
  light.far = shown->far;
  if (shown->projection == glsl::shadow_perspective) light.halfAngle = std::atan(0.5f / shown->scale);
  return light;
}

}  // namespace

int layersOf(const glsl::Light& light, const LightLayout& layout, const ShadowMapDesc& desc) {
  return static_cast<int>(glsl::shadow_face_count(layout.faces) * layout.parts() *
                          samplesOf(light, desc).size());
}

size_t MapRequest::count() const {
  return directions.empty() ? lights.size() : directions.size();
}

glsl::Light MapRequest::lightAt(const LitScene& scene, size_t i) const {
  if (directions.empty()) return scene.light(lights[i]);
  glsl::Light parallel{};
  parallel.direction = directions[i];
  parallel.type = glsl::light_directional;
  parallel.own_instance = glsl::no_instance;
  return parallel;
}

std::vector<LightLayout> MapRequest::layoutsIn(const LitScene& scene) const {
  std::vector<LightLayout> result;
  std::vector<scene::Bounds> others;
  int64_t layers = 0;
  for (size_t i = 0; i < count(); ++i) {
    const glsl::Light light = lightAt(scene, i);
    const std::span<const scene::Bounds> around = scene.boxesFor(light, others);
    result.push_back(fitLayout(light, around, desc));
    layers += layersOf(light, result.back(), desc);
    if (desc.views != 0 || result.back().parts() == 1 || layers * layerBytes(desc) <= kKeptLimit) continue;
    layers -= layersOf(light, result.back(), desc);
    ShadowMapDesc whole = desc;
    whole.views = 1;
    result.back() = fitLayout(light, around, whole);
    layers += layersOf(light, result.back(), whole);
  }
  return result;
}

bool MapRequest::fit(const LitScene& scene) {
  std::vector<glsl::ShadowView> fittedViews;
  std::vector<glsl::ShadowLight> fittedLights;
  std::vector<scene::Bounds> others;
  const size_t entries = stride();
  for (size_t i = 0; i < count(); ++i) {
    const glsl::Light light = lightAt(scene, i);
    appendViews(light, directions.empty() ? lights[i] : glsl::no_light, layouts[i],
                scene.boxesFor(light, others), desc, scene.visible(), fittedViews, fittedLights);
    fittedLights.resize((i + 1) * entries, fittedLights.back());
  }
  depthViews.clear();
  for (const glsl::ShadowView& view : fittedViews) {
    const bool ofScene = view.light != glsl::no_light;
    if (ofScene && !desc.punctual && !glsl::light_has_extent(scene.light(view.light))) continue;
    depthViews.push_back({.volume = cullVolume(view),
                          .skipInstance = ofScene ? scene.light(view.light).own_instance : glsl::no_instance,
                          .view = view.layer,
                          .layer = static_cast<int>(view.layer),
                          .surfaces = desc.specular ? scene::Surfaces::all : scene::Surfaces::matte});
  }
  const bool changed = !sameBytes(fittedViews, views) || !sameBytes(fittedLights, shadowLights);
  views = std::move(fittedViews);
  shadowLights = std::move(fittedLights);
  return changed;
}

void MapRequest::check(const LitScene& scene, const gpu::Device& device) const {
  size_t layers = 0;
  for (size_t i = 0; i < count(); ++i)
    layers += static_cast<size_t>(layersOf(lightAt(scene, i), layouts[i], desc));
  const int size = desc.size, largest = device.limits().maxTextureSize;
  if (size < 1 || size > largest)
    throw UsageError(fmt::format("shadow map of {} texels: the size must be from 1 to {}", size, largest));
  const auto most = static_cast<size_t>(device.limits().maxArrayLayers);
  if (layers > most)
    throw UsageError(
        fmt::format("shadow maps in {} layers: the device has at most {} in one array", layers, most));
  const int64_t needed = layerBytes(desc) * static_cast<int64_t>(layers);
  if (needed > kMemoryLimit)
    throw UsageError(
        fmt::format("shadow maps of {} layers of {} x {} texels take {} MiB, more than the {} MiB that one "
                    "request may; ask for smaller maps or fewer lights at once",
                    layers, size, size, needed >> 20, kMemoryLimit >> 20));
}

bool MapRequest::followsView() const {
  return desc.fit == MapFit::view && std::ranges::any_of(layouts, [&](const LightLayout& layout) {
           return layout.faces == glsl::shadow_faces_single ||
                  (!desc.samples.empty() && glsl::shadow_face_count(layout.faces) > 2);
         });
}

bool MapRequest::hasRange(const LitScene& scene) const {
  return std::ranges::any_of(lights, [&](uint32_t light) { return scene.light(light).range > 0; });
}

bool MapRequest::cuts() const {
  return std::ranges::any_of(layouts, [](const LightLayout& layout) { return layout.parts() > 1; });
}

size_t MapRequest::stride() const {
  size_t most = std::max<size_t>(desc.samples.size(), 1);
  for (const LightLayout& layout : layouts) most = std::max<size_t>(most, layout.parts());
  return most;
}

int64_t MapRequest::bytes() const {
  return layerBytes(desc) * maps.layers;
}

void MapRequest::report(const LitScene& scene, std::vector<ShadowMapStats>& all) const {
  if (!directions.empty() && !views.empty())
    all.push_back(
        shownBy(views, {.light = "parallel light", .projection = "orthographic", .layers = maps.layers}));
  const size_t entries = stride();
  for (size_t i = 0; i < lights.size(); ++i) {
    const LightLayout& layout = layouts[i];
    const uint32_t first = shadowLights[i * entries].first_layer;
    const std::span<const glsl::ShadowView> faces =
        std::span(views).subspan(first, glsl::shadow_face_count(layout.faces));
    all.push_back(shownBy(faces, {.light = scene.lightName(lights[i]),
                                  .projection = std::string(projectionName(layout)),
                                  .layers = layersOf(scene.light(lights[i]), layout, desc)}));
  }
}

}  // namespace limn::shadow
