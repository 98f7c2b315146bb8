#include "core/shadow/alike_lights.h"

#include <algorithm>
#include <array>

#include "core/frame/array_block.h"

namespace limn::shadow {

using frame::Access;

namespace {

/// The length of light_layers in glsl/shadow/alike_lights.glsl.
constexpr size_t kDispatchLights = 8;
constexpr std::array<const char*, kDispatchLights> kLightLayerNames{
    "light_layers[0]", "light_layers[1]", "light_layers[2]", "light_layers[3]",
    "light_layers[4]", "light_layers[5]", "light_layers[6]", "light_layers[7]"};

}  // namespace

void AlikeLights::define(std::map<std::string, std::string>& defines) const {
  if (!layout) return;
  defines["SHADOW_PROJECTION"] = std::to_string(layout->projection);
  defines["SHADOW_FACES"] = std::to_string(layout->faces);
  defines["LIGHT_KIND"] = std::to_string(layout->kind);
  if (layout->parts() == 1) return;
  defines["LIGHT_PARTS_U"] = std::to_string(layout->partsU);
  defines["LIGHT_PARTS_V"] = std::to_string(layout->partsV);
}

void AlikeLights::bind(gpu::Program& program) const {
  for (size_t i = 0; i < layers.size(); ++i) program.set(kLightLayerNames[i], layers[i]);
}

std::vector<AlikeLights> alikeLights(std::span<const LightLayout> layouts) {
  std::vector<AlikeLights> groups;
  for (size_t i = 0; i < layouts.size(); ++i) {
    const auto joins = [&](const AlikeLights& group) {
      return group.layout == layouts[i] && group.layers.size() < kDispatchLights;
    };
    auto group = std::ranges::find_if(groups, joins);
    if (group == groups.end()) group = groups.insert(groups.end(), {layouts[i], {}});
    group->layers.push_back(static_cast<int>(i));
  }
  return groups;
}

void readMaps(frame::PassBuilder& pass, const gpu::Device& device, const ShadowMaps& maps,
              std::map<std::string, std::string>& defines) {
  const Access views =
      frame::arrayBlock<glsl::ShadowView>(device.limits(), maps.layers, "SHADOW_VIEW_COUNT", defines);
  const Access lights =
      frame::arrayBlock<glsl::ShadowLight>(device.limits(), maps.lightSamples, "SHADOW_LIGHT_COUNT", defines);
  if (maps.stride > 1) defines["SHADOW_LIGHT_STRIDE"] = std::to_string(maps.stride);
  pass.read(maps.depth, Access::sampled, "shadow_depth", "shadow maps")
      .read(maps.views, views, "ShadowViews", "projections")
      .read(maps.lights, lights, "ShadowLights", "layers of each light");
}

}  // namespace limn::shadow
