#include "techniques/subtractive_shadows/radiance_cache.h"

#include <fmt/format.h>

#include <map>

#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/draw_instance.h"
#include "core/shading_maps/shading_maps.h"
#include "glsl/materials/material_model.glsl"
#include "glsl/scene/blocks.glsl"
#include "techniques/subtractive_shadows/cache_place.glsl"

namespace limn::subtractive_shadows {

using frame::Access;

namespace {

/// Why a material is not in the cache; null: it may be, or has no lobe.
const char* reasonAgainst(const scene::Material& m, bool answered) {
  if (!m.model) return m.metalRoughTexture.image == scene::kNone ? nullptr : "its roughness is textured";
  if (glsl::model_anisotropic(*m.model)) return "its lobe turns with the tangent";
  return answered ? "its lobe is another technique's" : nullptr;
}

bool hasLobe(const scene::Material& m) {
  const bool mirrors = m.model && m.model->kind == glsl::model_coated;
  return !m.lambertian() && !m.specularSurface() && !mirrors;
}

}  // namespace

CachedMaterials::CachedMaterials(const scene::Scene& scene, const scene::Pose& pose, bool answered)
    : places(scene.materials.size(), glsl::no_instance) {
  std::vector<bool> drawn(scene.materials.size());
  for (const scene::DrawInstance& instance : pose.instances)
    drawn[static_cast<size_t>(scene::materialIndexOf(scene, instance))] = true;
  std::map<float, uint32_t> ofRoughness;  // places of materials without a model, whose colours pixels have
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const scene::Material& m = scene.materials[i];
    if (!drawn[i] || !hasLobe(m)) continue;
    const char* why = reasonAgainst(m, answered);
    const auto known = m.model ? ofRoughness.end() : ofRoughness.find(m.roughness);
    if (!why && known != ofRoughness.end()) {
      places[i] = known->second;
      continue;
    }
    if (!why && materials.size() == kMostCached) why = "there are more materials than the cache holds";
    if (why) {
      uncached.push_back({static_cast<int>(i), why});
      continue;
    }
    places[i] = static_cast<uint32_t>(materials.size());
    materials.push_back(static_cast<uint32_t>(i));
    if (!m.model) ofRoughness.emplace(m.roughness, places[i]);
  }
}

bool RadianceCache::add(frame::FrameGraph& graph, const TechniqueInputs& inputs, std::string_view technique,
                        int samples) {
  const SceneHandles& handles = inputs.handles;
  const CachedMaterials cached(inputs.scene, inputs.pose, handles.surface != nullptr);
  for (const UncachedMaterial& m : cached.uncached)
    graph.leaveOut(
        fmt::format("radiance cache of '{}'", inputs.scene.materials[static_cast<size_t>(m.material)].name),
        technique, fmt::format("{}: its light is from filtered maps", m.why));
  if (cached.materials.empty()) return false;
  gpu::Device& device = inputs.gpuScene.device();
  materials_ = gpu::Buffer::of<uint32_t>(device, "cached materials", cached.materials);
  places_ = gpu::Buffer::of<uint32_t>(device, "places in the radiance cache", cached.places);
  sampler_ = gpu::Sampler(device, GL_LINEAR, GL_LINEAR);
  placesHandle_ = graph.importBuffer("places in the radiance cache", places_);

  frame::PassBuilder pass = graph.addPass("radiance cache", technique);
  pass.read(handles.frame, Access::uniformBuffer, "FrameBlock", "camera, rotation, scale")
      .read(handles.materials, Access::storageLoad, "Materials", "roughness")
      .constant("CachedMaterials", materials_)
      .read(inputs.service<shading_maps::ShadingMapService>().radianceLevels(), Access::sampled,
            "environment_levels_map", "light of lobes");
  if (handles.models)  // the block of instances counts as used wherever it is declared
    pass.read(handles.models, Access::storageLoad, "MaterialModels", "how materials reflect light")
        .read(handles.instances, Access::storageLoad, "Instances", "declared with the models");
  if (handles.measured)
    pass.read(handles.measured, Access::storageLoad, "MeasuredValues", "measured reflectance");
  const int layers = 2 * static_cast<int>(cached.materials.size());
  texture_ = pass.write(graph.createTexture("radiance cache", {.target = GL_TEXTURE_2D_ARRAY,
                                                               .format = GL_RGBA32F,
                                                               .width = glsl::cache_size,
                                                               .height = glsl::cache_size,
                                                               .layers = layers}),
                        Access::imageStore, "radiance_cache", "light of lobes by normal");
  const auto program = pass.program({.files = {"techniques/subtractive_shadows/radiance_cache.comp.glsl"},
                                     .defines = {{"MATERIAL_MODELS", fmt::format("{}", handles.modelKinds)},
                                                 {"SURFACE_TANGENTS", "0"},
                                                 {"SURFACE_PLACES", "0"}}});
  pass.cacheable();
  pass.execute([program, samples, layers](frame::PassContext& context) {
    context.use(program).set("brdf_samples", samples);
    context.dispatch(glsl::cache_size, glsl::cache_size, layers / 2, 8, 8);
  });
  return true;
}

void RadianceCache::read(frame::PassBuilder& pass, const TechniqueInputs& inputs, bool instances) const {
  pass.read(texture_, Access::sampled, frame::ShaderName("radiance_cache").sampledWith(&sampler_),
            "light of lobes by normal")
      .read(placesHandle_, Access::storageLoad, "CachePlaces", "which materials are in the cache");
  if (inputs.handles.models) return;
  pass.read(inputs.handles.instances, Access::storageLoad, "Instances", "materials of surfaces");
  if (instances)
    pass.read(inputs.gbuffer.instance, Access::sampled, kGBufferNames.instance, "materials of surfaces");
}

}  // namespace limn::subtractive_shadows
