// Writes the fuzzer's seed corpus: one small file per feature of the loader. Usage: limn_scene_seeds FOLDER
#include <meshoptimizer.h>

#include <cstdio>
#include <filesystem>
#include <functional>

#include "core/base/file.h"
#include "tests/support/gltf_builder.h"

namespace {

using limn::test::GltfBuilder;
using json = nlohmann::json;

/// A 2 x 2 RGBA picture with stored (uncompressed) data.
constexpr unsigned char kPng[] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0, 0, 0, 13, 'I', 'H', 'D',
                                  'R',  0,   0,   0,   2,  0,  0,  0,  2, 8, 0, 0,  0,   0};

void skinnedAndMorphed(GltfBuilder& b) {
  const int positions = b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const int delta = b.vec3({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
  const int joints = b.accessor(std::vector<glm::u8vec4>{{0, 1, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}},
                                GltfBuilder::kUbyte, "VEC4");
  const int weights = b.vec4({{0.5f, 0.5f, 0, 0}, {1, 0, 0, 0}, {0.3f, 0.3f, 0, 0}});
  const int mesh = b.mesh({{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
  b.root["meshes"][0]["primitives"][0]["targets"] = json::array({{{"POSITION", delta}}});
  b.root["meshes"][0]["weights"] = {0.5};
  b.node({{"mesh", mesh}, {"skin", 0}});
  b.node({{"children", {2}}, {"translation", {0, 1, 0}}});
  b.node({{"scale", {1, 2, 1}}});
  const int bind = b.accessor(std::vector<glm::mat4>(2, glm::mat4(1)), GltfBuilder::kFloat, "MAT4");
  b.append("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", bind}});
}

void animated(GltfBuilder& b) {
  skinnedAndMorphed(b);
  const int times = b.floats({0, 0.5f, 1});
  const int turns = b.vec4({{0, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 0, 1}});
  const int moves = b.vec3(std::vector<glm::vec3>(9, glm::vec3(1, 2, 3)));
  const int weights = b.floats({0, 1, 0});
  b.append("animations", {{"samplers",
                           {{{"input", times}, {"output", turns}},
                            {{"input", times}, {"output", moves}, {"interpolation", "CUBICSPLINE"}},
                            {{"input", times}, {"output", weights}, {"interpolation", "STEP"}}}},
                          {"channels",
                           {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}},
                            {{"sampler", 1}, {"target", {{"node", 2}, {"path", "translation"}}}},
                            {{"sampler", 2}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
}

void lights(GltfBuilder& b) {
  b.light({{"type", "point"}, {"color", {1, 0.5, 0.2}}, {"intensity", 3}},
          {{"extras", {{"limn_area", {1, 2}}}}});
  b.light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}});
  b.light({{"type", "directional"}}, {{"extras", {{"limn_angle", 0.01}}}});
  b.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
  b.node({{"camera", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}}});
  b.append("scenes", {{"nodes", {0, 1, 2, 3}},
                      {"extras",
                       {{"limn_medium",
                         {{"sigma_a", 0.1},
                          {"sigma_s", {0.1, 0.2, 0.3}},
                          {"g", 0.5},
                          {"smoke", {{"low", {-1, 0, -1}}, {"high", {1, 2, 1}}, {"rise", 0.1}}}}}}}});
}

void materials(GltfBuilder& b) {
  std::vector<std::byte> png(sizeof kPng);
  std::memcpy(png.data(), kPng, sizeof kPng);
  const int material = b.texturedMaterial(png);
  b.root["materials"][0].update(
      {{"alphaMode", "MASK"},
       {"emissiveFactor", {1, 1, 1}},
       {"doubleSided", true},
       {"extensions",
        {{"KHR_materials_ior", {{"ior", 1.3}}},
         {"KHR_materials_specular", {{"specularColorFactor", {1, 1, 0}}}},
         {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 2}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}});
  b.triangle(material);
}

void heights(GltfBuilder& b) {
  std::vector<std::byte> png(sizeof kPng);
  std::memcpy(png.data(), kPng, sizeof kPng);
  const int material = b.texturedMaterial(png);
  b.append("samplers", {{"wrapS", 33071}, {"wrapT", 33071}});
  b.root["textures"][0]["sampler"] = 0;
  b.root["materials"][0]["extras"]["limn_height"] = {
      {"texture", {{"index", 0}, {"texCoord", 0}}}, {"scale", 0.1}, {"offset", -0.05}, {"tile", {1, 2}}};
  b.triangle(material);
}

void translucent(GltfBuilder& b) {
  const int coefficients =
      b.append("materials",
               {{"extras", {{"limn_subsurface", {{"sigma_a", {32, 170, 480}}, {"sigma_s_prime", 900}}}}}});
  b.append("materials", {{"extras", {{"limn_subsurface", {{"mean_free_path", {0.003, 0.002, 0.001}}}}}}});
  b.append("materials",
           {{"extensions",
             {{"KHR_materials_volume",
               {{"thicknessFactor", 1}, {"attenuationDistance", 0.1}, {"attenuationColor", {0.5, 0.4, 0.3}}}},
              {"KHR_materials_scatter", {{"multiscatterColorFactor", {0.9, 0.8, 0.7}}}},
              {"KHR_materials_volume_scatter",
               {{"multiscatterColor", {0.9, 0.8, 0.7}}, {"scatterAnisotropy", 0.5}}}}}});
  b.triangle(coefficients);
}

void emissiveQuad(GltfBuilder& b) {
  const int material = b.append("materials", {{"emissiveFactor", {1, 1, 1}}});
  const int positions = b.vec3({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  b.meshNode(b.mesh({{"POSITION", positions}}, b.indices({0, 1, 2, 0, 2, 3}), material));
}

void instanced(GltfBuilder& b) {
  const int node = b.triangle();
  const int t = b.vec3({{0, 0, 0}, {1, 0, 0}});
  const int r =
      b.accessor(std::vector<glm::i8vec4>{{0, 0, 0, 127}, {0, 127, 0, 0}}, GltfBuilder::kByte, "VEC4");
  b.root["accessors"][static_cast<std::size_t>(r)]["normalized"] = true;
  b.root["nodes"][static_cast<std::size_t>(node)]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", t}, {"ROTATION", r}};
}

void sparseStrip(GltfBuilder& b) {
  const int positions = b.vec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
  const int index = b.view("\3", 1);
  const glm::vec3 value(2, 2, 0);
  b.root["accessors"][static_cast<std::size_t>(positions)]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", index}, {"componentType", GltfBuilder::kUbyte}}},
      {"values", {{"bufferView", b.view(&value, sizeof value)}}}};
  b.meshNode(b.mesh({{"POSITION", positions}}));
  b.root["meshes"][0]["primitives"][0]["mode"] = 5;
}

/// Positions that meshoptimizer compressed.
void meshoptCompressed(GltfBuilder& b) {
  const std::vector<glm::vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(3, sizeof(glm::vec3)));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), corners.data(), 3, sizeof(glm::vec3)));
  b.meshNode(b.mesh({{"POSITION", b.vec3(corners)}}));
  const int view = b.view(bytes.data(), bytes.size());
  json& views = b.root["bufferViews"];
  views[0]["extensions"]["EXT_meshopt_compression"] = {
      {"buffer", 0},      {"byteOffset", views[static_cast<std::size_t>(view)]["byteOffset"]},
      {"byteStride", 12}, {"byteLength", bytes.size()},
      {"count", 3},       {"mode", "ATTRIBUTES"},
      {"filter", "NONE"}};
}

/// A triangle that Draco would decode.
void dracoCompressed(GltfBuilder& b) {
  const int indices =
      b.append("accessors", {{"componentType", GltfBuilder::kUshort}, {"count", 3}, {"type", "SCALAR"}});
  const int positions =
      b.append("accessors", {{"componentType", GltfBuilder::kFloat}, {"count", 3}, {"type", "VEC3"}});
  b.meshNode(b.mesh({{"POSITION", positions}}, indices));
  const char bytes[] = "DRACO";
  b.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", b.view(bytes, sizeof bytes)}, {"attributes", {{"POSITION", 0}}}};
}

void otherMaterials(GltfBuilder& b) {
  b.texturedMaterial(
      {reinterpret_cast<const std::byte*>(kPng), reinterpret_cast<const std::byte*>(kPng) + sizeof kPng});
  b.root["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
  b.root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 0;
  b.append("materials", {{"extensions",
                          {{"KHR_materials_pbrSpecularGlossiness",
                            {{"diffuseFactor", {1, 0.5, 0.25, 1}},
                             {"specularFactor", {0.2, 0.3, 0.4}},
                             {"glossinessFactor", 0.5},
                             {"specularGlossinessTexture", {{"index", 0}}}}}}}});
  b.triangle(1);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: limn_scene_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  const std::pair<const char*, std::function<void(GltfBuilder&)>> seeds[] = {
      {"empty", [](GltfBuilder&) {}},
      {"triangle", [](GltfBuilder& b) { b.triangle(); }},
      {"skin", skinnedAndMorphed},
      {"animation", animated},
      {"lights", lights},
      {"materials", materials},
      {"heights", heights},
      {"translucent", translucent},
      {"quad", emissiveQuad},
      {"instances", instanced},
      {"sparse_strip", sparseStrip},
      {"meshopt", meshoptCompressed},
      {"draco", dracoCompressed},
      {"other_materials", otherMaterials},
  };
  for (const auto& [name, fill] : seeds) {
    GltfBuilder builder;
    fill(builder);
    limn::writeFile(folder / (std::string(name) + ".glb"), builder.glb());
  }
  return 0;
}
