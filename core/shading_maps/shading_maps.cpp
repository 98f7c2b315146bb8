#include "core/shading_maps/shading_maps.h"

#include "core/scene/environment_light.h"
#include "core/shading/environment.h"
#include "core/shading/ltc_table.h"
#include "glsl/materials/material_model.glsl"

namespace limn::shading_maps {

using frame::Access;
using frame::TextureHandle;

ShadingMapService::ShadingMapService(gpu::Device& device, const scene::Scene& scene)
    : device_(device), scene_(scene) {}
ShadingMapService::~ShadingMapService() = default;

const scene::EnvironmentLight& ShadingMapService::environmentLight() {
  if (!light_) light_ = std::make_unique<scene::EnvironmentLight>(scene_.environment);
  return *light_;
}

void ShadingMapService::begin() {
  for (Entry* entry : {&radiance_, &levels_, &ltc_, &irradiance_, &filtered_, &grazing_}) {
    // What the last graph did without would count in the memory of other techniques.
    if (!entry->handle) entry->texture = {};
    entry->handle = {};
  }
}

const scene::Environment& ShadingMapService::environment() const {
  static const scene::Environment black = [] {
    scene::Environment e;
    e.width = e.height = 2;
    e.texels.assign(4, glm::vec3(0));
    return e;
  }();
  return scene_.environment ? scene_.environment : black;
}

template <class Make>
TextureHandle ShadingMapService::import(Entry& entry, const char* name, Make make) {
  if (!entry.texture) entry.texture = make();
  return handleOf(entry, name);
}

TextureHandle ShadingMapService::handleOf(Entry& entry, const char* name) {
  if (!entry.handle) entry.handle = context().graph.importTexture(name, entry.texture);
  return entry.handle;
}

TextureHandle ShadingMapService::radiance() {
  if (!scene_.environment) return {};
  return import(radiance_, "environment map", [&] {
    const scene::Environment& e = scene_.environment;
    gpu::Texture map(device_, "environment map", {.format = GL_RGB32F, .width = e.width, .height = e.height});
    map.setSampling(GL_LINEAR, GL_LINEAR, GL_REPEAT, GL_CLAMP_TO_EDGE);
    map.upload(0, 0, GL_RGB, GL_FLOAT, e.texels.data());
    return map;
  });
}

TextureHandle ShadingMapService::radianceLevels() {
  return import(levels_, "levels of the environment's map",
                [&] { return shading::makeRadianceTexture(device_, environment()); });
}

TextureHandle ShadingMapService::ltcTable() {
  return import(ltc_, "table of linearly transformed cosines",
                [&] { return shading::makeLtcTexture(device_); });
}

void ShadingMapService::readReflected(frame::PassBuilder& pass, uint32_t modelKinds) {
  if (!irradiance_.texture) {
    const auto filtered = shading::keptEnvironment(environment());
    irradiance_.texture = shading::makeIrradianceTexture(device_, filtered->irradiance);
    filtered_.texture = shading::makeFilteredTexture(device_, *filtered);
  }
  pass.read(handleOf(irradiance_, "environment irradiance"), Access::sampled, "environment_irradiance",
            "diffuse light")
      .read(handleOf(filtered_, "filtered environment"), Access::sampled, "environment_filtered",
            "glossy light")
      .read(ltcTable(), Access::sampled, "ltc_table", "glossy reflectance");
  constexpr uint32_t entered = 1u << glsl::model_coated | 1u << glsl::model_entry;
  if ((modelKinds & entered) == 0) return;
  const TextureHandle grazing = import(grazing_, "grazing irradiance of the environment", [&] {
    return shading::makeIrradianceTexture(device_, *shading::keptGrazing(environment()));
  });
  pass.read(grazing, Access::sampled, "environment_grazing", "light that enters coats and bodies");
}

}  // namespace limn::shading_maps
