// The table of document_schema.h. Sections are those of the glTF 2.0 specification, and of its extensions.
// Ranges of light and colour are not here: the loader clamps these, with a warning. Nor are limn's extras,
// which it checks where it reads them.
#include <limits>

#include "core/scene_io/private/document_schema.h"

namespace limn::scene {
namespace {

using Type = PropertyRule::Type;
using Rules = std::vector<PropertyRule>;

/// tinygltf holds indices and sparse counts as int.
constexpr double kMaxInt = std::numeric_limits<int>::max();

PropertyRule flag(const char* path) {
  return {path, Type::boolean};
}
PropertyRule text(const char* path, std::vector<std::string> choices = {}) {
  return {path, Type::text, 0, 0, std::move(choices)};
}
PropertyRule number(const std::string& path) {
  return {path, Type::number};
}
PropertyRule index(const std::string& path) {
  return {path, Type::whole, 0, kMaxInt};
}
/// Bytes and elements; integers beyond 2^53 are refused before.
PropertyRule size(const char* path) {
  return {path, Type::whole, 0};
}
PropertyRule code(const char* path, std::vector<std::string> choices) {
  return {path, Type::whole, 0, kMaxInt, std::move(choices)};
}
PropertyRule object(const char* path) {
  return {path, Type::object};
}

Rules documentRules() {
  return {
      // 3.6 Binary data storage
      size("buffers[].byteLength!"),
      text("buffers[].uri"),
      index("bufferViews[].buffer!"),
      size("bufferViews[].byteOffset"),
      size("bufferViews[].byteLength!"),
      {"bufferViews[].byteStride", Type::whole, 0, 252},
      // EXT_meshopt_compression
      flag("buffers[].extensions.EXT_meshopt_compression.fallback"),
      index("bufferViews[].extensions.EXT_meshopt_compression.buffer!"),
      size("bufferViews[].extensions.EXT_meshopt_compression.byteOffset"),
      size("bufferViews[].extensions.EXT_meshopt_compression.byteLength!"),
      {"bufferViews[].extensions.EXT_meshopt_compression.byteStride!", Type::whole, 1, 256},
      size("bufferViews[].extensions.EXT_meshopt_compression.count!"),
      text("bufferViews[].extensions.EXT_meshopt_compression.mode!", {"ATTRIBUTES", "TRIANGLES", "INDICES"}),
      text("bufferViews[].extensions.EXT_meshopt_compression.filter",
           {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"}),
      index("accessors[].bufferView"),
      size("accessors[].byteOffset"),
      code("accessors[].componentType!", {"5120", "5121", "5122", "5123", "5125", "5126"}),
      flag("accessors[].normalized"),
      size("accessors[].count!"),
      text("accessors[].type!", {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}),
      index("accessors[].sparse.count!"),
      object("accessors[].sparse.indices!"),
      index("accessors[].sparse.indices.bufferView!"),
      index("accessors[].sparse.indices.byteOffset"),
      code("accessors[].sparse.indices.componentType!", {"5121", "5123", "5125"}),
      object("accessors[].sparse.values!"),
      index("accessors[].sparse.values.bufferView!"),
      index("accessors[].sparse.values.byteOffset"),
      // 3.5 Scene hierarchy
      index("scene"),
      index("scenes[].nodes[]"),
      text("nodes[].name"),
      index("nodes[].children[]"),
      number("nodes[].matrix[16]"),
      number("nodes[].translation[3]"),
      number("nodes[].rotation[4]"),
      number("nodes[].scale[3]"),
      number("nodes[].weights[]"),
      index("nodes[].mesh"),
      index("nodes[].skin"),
      index("nodes[].camera"),
      // 3.7 Geometry
      text("meshes[].name"),
      number("meshes[].weights[]"),
      object("meshes[].primitives![]"),
      index("meshes[].primitives[].attributes!{}"),
      index("meshes[].primitives[].indices"),
      index("meshes[].primitives[].material"),
      {"meshes[].primitives[].mode", Type::whole, 0, 6},
      index("meshes[].primitives[].targets[]{}"),
      // KHR_draco_mesh_compression
      index("meshes[].primitives[].extensions.KHR_draco_mesh_compression.bufferView!"),
      index("meshes[].primitives[].extensions.KHR_draco_mesh_compression.attributes!{}"),
      text("skins[].name"),
      index("skins[].joints![]"),
      index("skins[].inverseBindMatrices"),
      // 3.8 Texture data
      index("textures[].sampler"),
      index("textures[].source"),
      index("textures[].extensions.EXT_texture_webp.source"),
      text("images[].name"),
      text("images[].uri"),
      index("images[].bufferView"),
      code("samplers[].wrapS", {"10497", "33071", "33648"}),
      code("samplers[].wrapT", {"10497", "33071", "33648"}),
      // 3.9 Materials
      text("materials[].name"),
      number("materials[].pbrMetallicRoughness.baseColorFactor[4]"),
      number("materials[].pbrMetallicRoughness.metallicFactor"),
      number("materials[].pbrMetallicRoughness.roughnessFactor"),
      number("materials[].normalTexture.scale"),
      number("materials[].emissiveFactor[3]"),
      text("materials[].alphaMode", {"OPAQUE", "MASK", "BLEND"}),
      number("materials[].alphaCutoff"),
      flag("materials[].doubleSided"),
      // 3.10 Cameras
      text("cameras[].name"),
      text("cameras[].type!", {"perspective", "orthographic"}),
      number("cameras[].perspective.yfov!"),
      number("cameras[].perspective.znear!"),
      // 3.11 Animations
      text("animations[].name"),
      index("animations[].samplers![].input!"),
      index("animations[].samplers[].output!"),
      text("animations[].samplers[].interpolation", {"LINEAR", "STEP", "CUBICSPLINE"}),
      index("animations[].channels![].sampler!"),
      object("animations[].channels[].target!"),
      index("animations[].channels[].target.node"),
      text("animations[].channels[].target.path!"),
      // KHR_lights_punctual
      text("extensions.KHR_lights_punctual.lights![].name"),
      text("extensions.KHR_lights_punctual.lights[].type!", {"point", "spot", "directional"}),
      number("extensions.KHR_lights_punctual.lights[].color[3]"),
      number("extensions.KHR_lights_punctual.lights[].intensity"),
      number("extensions.KHR_lights_punctual.lights[].range"),
      number("extensions.KHR_lights_punctual.lights[].spot.innerConeAngle"),
      number("extensions.KHR_lights_punctual.lights[].spot.outerConeAngle"),
      index("nodes[].extensions.KHR_lights_punctual.light!"),
      // EXT_mesh_gpu_instancing
      index("nodes[].extensions.EXT_mesh_gpu_instancing.attributes!{}"),
      // KHR_materials_...
      number("materials[].extensions.KHR_materials_emissive_strength.emissiveStrength"),
      number("materials[].extensions.KHR_materials_ior.ior"),
      object("materials[].extensions.KHR_materials_unlit"),
      number("materials[].extensions.KHR_materials_pbrSpecularGlossiness.diffuseFactor[4]"),
      number("materials[].extensions.KHR_materials_pbrSpecularGlossiness.specularFactor[3]"),
      number("materials[].extensions.KHR_materials_pbrSpecularGlossiness.glossinessFactor"),
      number("materials[].extensions.KHR_materials_specular.specularFactor"),
      number("materials[].extensions.KHR_materials_specular.specularColorFactor[3]"),
      number("materials[].extensions.KHR_materials_transmission.transmissionFactor"),
      number("materials[].extensions.KHR_materials_volume.thicknessFactor"),
      number("materials[].extensions.KHR_materials_volume.attenuationDistance"),
      number("materials[].extensions.KHR_materials_volume.attenuationColor[3]"),
      number("materials[].extensions.KHR_materials_scatter.multiscatterColorFactor[3]"),
      number("materials[].extensions.KHR_materials_scatter.scatterAnisotropy"),
      number("materials[].extensions.KHR_materials_volume_scatter.multiscatterColor[3]"),
      number("materials[].extensions.KHR_materials_volume_scatter.scatterAnisotropy"),
  };
}

/// What the materials' textures have in common: 3.9.2 Texture info, and KHR_texture_transform.
void addTextureRules(Rules& rules) {
  for (const char* place :
       {"pbrMetallicRoughness.baseColorTexture", "pbrMetallicRoughness.metallicRoughnessTexture",
        "normalTexture", "emissiveTexture", "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture",
        "extensions.KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture"}) {
    const std::string info = std::string("materials[].") + place;
    const std::string transform = info + ".extensions.KHR_texture_transform";
    rules.push_back(index(info + ".index!"));
    rules.push_back(index(info + ".texCoord"));
    rules.push_back(number(transform + ".offset[2]"));
    rules.push_back(number(transform + ".scale[2]"));
    rules.push_back(number(transform + ".rotation"));
    rules.push_back(index(transform + ".texCoord"));
  }
}

}  // namespace

std::span<const PropertyRule> propertyRules() {
  static const Rules rules = [] {
    Rules all = documentRules();
    addTextureRules(all);
    return all;
  }();
  return rules;
}

}  // namespace limn::scene
