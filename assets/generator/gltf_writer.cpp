#include "assets/generator/gltf_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/file.h"
#include "core/brdf/measured_file.h"

namespace limn::assets {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126, kUint32 = 5125, kUint16 = 5123, kUint8 = 5121;
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963, kNoTarget = 0;

template <int N>
json array(const glm::vec<N, float>& v) {
  json result = json::array();
  for (int i = 0; i < N; ++i) result.push_back(v[i]);
  return result;
}
json array(const glm::quat& q) {
  return {q.x, q.y, q.z, q.w};
}

/// One number where both, or all three, are equal.
template <int N>
json shortest(const glm::vec<N, float>& v) {
  return v == glm::vec<N, float>(v[0]) ? json(v[0]) : array(v);
}

/// The object of extras.limn_material.
json reflectionModel(const ReflectionModel& m) {
  json entry = {{"model", m.model}};
  if (m.roughness) entry["roughness"] = shortest(*m.roughness);
  if (m.eta) entry["eta"] = shortest(*m.eta);
  if (m.k) entry["k"] = shortest(*m.k);
  if (m.kd) entry["kd"] = shortest(*m.kd);
  if (m.ks) entry["ks"] = shortest(*m.ks);
  if (m.exponent) entry["exponent"] = *m.exponent;
  if (!m.distribution.empty()) entry["distribution"] = m.distribution;
  if (!m.masking.empty()) entry["masking"] = m.masking;
  if (!m.banks.empty()) entry["banks"] = m.banks;
  if (!m.combine.empty()) entry["combine"] = m.combine;
  if (!m.file.empty()) entry["file"] = m.file;
  return entry;
}

/// The object of extras.limn_height.
json heightMap(const HeightMap& m) {
  json entry = {{"texture", {{"index", m.texture}}}, {"scale", m.scale}, {"tile", array(m.tile)}};
  if (m.offset != 0) entry["offset"] = m.offset;
  return entry;
}

/// The object of extras.limn_subsurface.
json subsurface(const Subsurface& s) {
  if (s.meanFreePath) return {{"mean_free_path", shortest(*s.meanFreePath)}};
  return {{"sigma_a", shortest(s.sigmaA)}, {"sigma_s_prime", shortest(s.sigmaSPrime)}};
}

/// Collects the binary chunk and the JSON that points into it.
class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene) {}

  std::string binary() {
    writeTextures();
    writeMaterials();
    writeMeshes();
    writeNodes();
    writeAnimations();
    writeRoot();
    return glb();
  }

 private:
  template <class T>
  int accessor(const std::vector<T>& data, int componentType, const char* type, int target,
               const json& bounds = {}) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const std::size_t offset = bytes_.size(), size = data.size() * sizeof(T);
    bytes_.resize(offset + size);
    std::memcpy(bytes_.data() + offset, data.data(), size);
    json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}};
    if (target != kNoTarget) view["target"] = target;
    root_["bufferViews"].push_back(view);
    json entry = {{"bufferView", root_["bufferViews"].size() - 1},
                  {"componentType", componentType},
                  {"count", data.size()},
                  {"type", type}};
    if (!bounds.is_null()) entry.update(bounds);
    root_["accessors"].push_back(entry);
    return static_cast<int>(root_["accessors"].size()) - 1;
  }

  int positionAccessor(const std::vector<glm::vec3>& positions) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::vec3& p : positions) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    return accessor(positions, kFloat, "VEC3", kVertexBuffer, {{"min", array(low)}, {"max", array(high)}});
  }

  int indexAccessor(const std::vector<std::uint32_t>& indices, std::size_t vertexCount) {
    if (vertexCount > 65535) return accessor(indices, kUint32, "SCALAR", kIndexBuffer);
    return accessor(std::vector<std::uint16_t>(indices.begin(), indices.end()), kUint16, "SCALAR",
                    kIndexBuffer);
  }

  void writeTextures() {
    if (scene_.textures.empty()) return;
    root_["samplers"] = {{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}};
    for (const Texture& texture : scene_.textures) {
      root_["textures"].push_back(
          {{"name", texture.name}, {"sampler", 0}, {"source", root_["images"].size()}});
      root_["images"].push_back({{"name", texture.name}, {"uri", texture.name + ".png"}});
    }
  }

  void writeMaterials() {
    for (const Material& m : scene_.materials) {
      json pbr = {{"baseColorFactor", array(m.baseColour)},
                  {"roughnessFactor", m.roughness},
                  {"metallicFactor", m.metallic}};
      if (m.baseColourTexture >= 0) pbr["baseColorTexture"]["index"] = m.baseColourTexture;
      json entry = {{"name", m.name}, {"pbrMetallicRoughness", pbr}};
      if (m.normalTexture >= 0)
        entry["normalTexture"] = {{"index", m.normalTexture}, {"scale", m.normalScale}};
      if (m.emissive != glm::vec3(0)) entry["emissiveFactor"] = array(m.emissive);
      if (m.doubleSided) entry["doubleSided"] = true;
      if (m.alphaCutoff) entry.update({{"alphaMode", "MASK"}, {"alphaCutoff", *m.alphaCutoff}});
      if (m.specularFactor != 1) {
        entry["extensions"]["KHR_materials_specular"]["specularFactor"] = m.specularFactor;
        extensions_.insert("KHR_materials_specular");
      }
      if (m.emissiveStrength != 1) {
        entry["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = m.emissiveStrength;
        extensions_.insert("KHR_materials_emissive_strength");
      }
      if (m.transmission > 0) {
        json& extensions = entry["extensions"];
        extensions["KHR_materials_transmission"]["transmissionFactor"] = m.transmission;
        extensions["KHR_materials_volume"]["thicknessFactor"] = m.thickness;
        extensions_.insert({"KHR_materials_transmission", "KHR_materials_volume"});
      }
      if (m.transmission > 0 || m.ior != 1.5f) {
        entry["extensions"]["KHR_materials_ior"]["ior"] = m.ior;
        extensions_.insert("KHR_materials_ior");
      }
      if (m.model) entry["extras"]["limn_material"] = reflectionModel(*m.model);
      if (m.height) entry["extras"]["limn_height"] = heightMap(*m.height);
      if (m.subsurface) entry["extras"]["limn_subsurface"] = subsurface(*m.subsurface);
      root_["materials"].push_back(entry);
    }
  }

  json primitive(const Primitive& p) {
    const Mesh& mesh = p.mesh;
    json attributes = {{"POSITION", positionAccessor(mesh.positions)},
                       {"NORMAL", accessor(mesh.normals, kFloat, "VEC3", kVertexBuffer)}};
    const Material& material = scene_.materials.at(static_cast<std::size_t>(p.material));
    if (material.baseColourTexture >= 0 || material.normalTexture >= 0 || material.height) {
      attributes["TEXCOORD_0"] = accessor(mesh.uvs, kFloat, "VEC2", kVertexBuffer);
    }
    if (!mesh.tangents.empty())
      attributes["TANGENT"] = accessor(mesh.tangents, kFloat, "VEC4", kVertexBuffer);
    if (!mesh.joints.empty()) {
      attributes["JOINTS_0"] = accessor(mesh.joints, kUint8, "VEC4", kVertexBuffer);
      attributes["WEIGHTS_0"] = accessor(mesh.weights, kFloat, "VEC4", kVertexBuffer);
    }
    return {{"attributes", attributes},
            {"indices", indexAccessor(mesh.indices, mesh.positions.size())},
            {"material", p.material}};
  }

  void writeMeshes() {
    for (const MeshAsset& mesh : scene_.meshes) {
      json primitives = json::array();
      for (const Primitive& p : mesh.primitives) primitives.push_back(primitive(p));
      root_["meshes"].push_back({{"name", mesh.name}, {"primitives", primitives}});
    }
  }

  json instancing(const std::vector<Instance>& instances) {
    std::vector<glm::vec3> translations, scales;
    std::vector<glm::vec4> rotations;
    for (const Instance& i : instances) {
      translations.push_back(i.translation);
      rotations.emplace_back(i.rotation.x, i.rotation.y, i.rotation.z, i.rotation.w);
      scales.push_back(i.scale);
    }
    extensions_.insert("EXT_mesh_gpu_instancing");
    return {{"attributes",
             {{"TRANSLATION", accessor(translations, kFloat, "VEC3", kNoTarget)},
              {"ROTATION", accessor(rotations, kFloat, "VEC4", kNoTarget)},
              {"SCALE", accessor(scales, kFloat, "VEC3", kNoTarget)}}}};
  }

  json node(const Node& n) {
    json entry = {{"name", n.name}};
    if (n.translation != glm::vec3(0)) entry["translation"] = array(n.translation);
    if (n.rotation != glm::quat(1, 0, 0, 0)) entry["rotation"] = array(n.rotation);
    if (n.scale != glm::vec3(1)) entry["scale"] = array(n.scale);
    if (n.mesh >= 0) entry["mesh"] = n.mesh;
    if (n.camera >= 0) entry["camera"] = n.camera;
    if (n.skin >= 0) entry["skin"] = n.skin;
    if (!n.children.empty()) entry["children"] = n.children;
    if (n.area) entry["extras"]["limn_area"] = array(*n.area);
    if (n.angle) entry["extras"]["limn_angle"] = *n.angle;
    if (n.metaballs) {
      entry["extras"]["limn_metaballs"] = {{"count", n.metaballs->count},
                                           {"resolution", n.metaballs->resolution},
                                           {"radius", n.metaballs->radius},
                                           {"seed", n.metaballs->seed},
                                           {"material", n.metaballs->material}};
    }
    if (n.light >= 0) {
      entry["extensions"]["KHR_lights_punctual"]["light"] = n.light;
      extensions_.insert("KHR_lights_punctual");
    }
    if (!n.instances.empty()) entry["extensions"]["EXT_mesh_gpu_instancing"] = instancing(n.instances);
    return entry;
  }

  json light(const Light& l, const std::string& name) {
    const char* types[] = {"point", "spot", "directional"};
    json entry = {{"name", name},
                  {"type", types[static_cast<int>(l.type)]},
                  {"color", array(l.colour)},
                  {"intensity", l.intensity}};
    if (l.type == Light::Type::spot) {
      entry["spot"] = {{"innerConeAngle", l.innerConeAngle}, {"outerConeAngle", l.outerConeAngle}};
      if (l.texture >= 0) entry["extras"]["limn_texture"] = l.texture;
    }
    return entry;
  }

  void writeNodes() {
    std::set<int> children;
    for (const Node& n : scene_.nodes) {
      children.insert(n.children.begin(), n.children.end());
      root_["nodes"].push_back(node(n));
      if (n.camera >= 0) {
        const Camera& camera = scene_.cameras.at(static_cast<std::size_t>(n.camera));
        root_["cameras"].push_back({{"name", n.name},
                                    {"type", "perspective"},
                                    {"perspective", {{"yfov", camera.yfov}, {"znear", camera.near}}}});
      }
      if (n.light >= 0) {
        root_["extensions"]["KHR_lights_punctual"]["lights"].push_back(
            light(scene_.lights.at(static_cast<std::size_t>(n.light)), n.name));
      }
    }
    json roots = json::array();
    for (int i = 0; i < static_cast<int>(scene_.nodes.size()); ++i) {
      if (!children.count(i)) roots.push_back(i);
    }
    root_["scene"] = 0;
    root_["scenes"] = json::array({{{"name", scene_.name}, {"nodes", roots}}});
    if (scene_.medium) {
      root_["scenes"][0]["extras"]["limn_medium"] = {
          {"sigma_a", scene_.medium->sigmaA}, {"sigma_s", scene_.medium->sigmaS}, {"g", scene_.medium->g}};
      if (const std::optional<Smoke>& s = scene_.medium->smoke)
        root_["scenes"][0]["extras"]["limn_medium"]["smoke"] = {{"low", {s->low.x, s->low.y, s->low.z}},
                                                                {"high", {s->high.x, s->high.y, s->high.z}},
                                                                {"whirl", s->whirl},
                                                                {"rise", s->rise},
                                                                {"seed", s->seed},
                                                                {"resolution", s->resolution}};
    }
    if (scene_.environment) root_["scenes"][0]["extras"]["limn_environment"] = "environment.exr";
    for (const Skin& skin : scene_.skins) {
      const int matrices = accessor(skin.inverseBind, kFloat, "MAT4", kNoTarget);
      root_["skins"].push_back({{"joints", skin.joints}, {"inverseBindMatrices", matrices}});
    }
  }

  void writeAnimations() {
    for (const Animation& animation : scene_.animations) {
      json samplers = json::array(), channels = json::array();
      for (const Channel& channel : animation.channels) {
        const bool rotates = !channel.rotations.empty();
        std::vector<glm::vec4> rotations;
        for (const glm::quat& q : channel.rotations) rotations.emplace_back(q.x, q.y, q.z, q.w);
        const int input = accessor(channel.times, kFloat, "SCALAR", kNoTarget,
                                   {{"min", {channel.times.front()}}, {"max", {channel.times.back()}}});
        const int output = rotates ? accessor(rotations, kFloat, "VEC4", kNoTarget)
                                   : accessor(channel.translations, kFloat, "VEC3", kNoTarget);
        channels.push_back(
            {{"sampler", samplers.size()},
             {"target", {{"node", channel.node}, {"path", rotates ? "rotation" : "translation"}}}});
        samplers.push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
      }
      root_["animations"].push_back(
          {{"name", animation.name}, {"samplers", samplers}, {"channels", channels}});
    }
  }

  void writeRoot() {
    root_["asset"] = {{"version", "2.0"}, {"generator", "limn-make-scenes"}};
    if (!extensions_.empty()) root_["extensionsUsed"] = extensions_;
    if (extensions_.count("EXT_mesh_gpu_instancing"))
      root_["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    root_["buffers"] = json::array({{{"byteLength", bytes_.size()}}});
  }

  std::string glb() const {
    std::string text = root_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t padded = (bytes_.size() + 3) / 4 * 4;
    std::string out;
    const auto word = [&](std::size_t value) {
      for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
    };
    out += "glTF";
    word(2);
    word(12 + 8 + text.size() + 8 + padded);
    word(text.size());
    out += "JSON" + text;
    word(padded);
    out += std::string("BIN\0", 4);
    out.append(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    out.resize(out.size() + padded - bytes_.size(), '\0');
    return out;
  }

  const Scene& scene_;
  json root_;
  std::vector<std::uint8_t> bytes_;
  std::set<std::string> extensions_;
};

}  // namespace

void writeScene(const Scene& scene, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const Texture& texture : scene.textures) {
    const std::filesystem::path file = folder / (texture.name + ".png");
    if (texture.heights)
      writeHeights(texture.image, file);
    else
      writePng(texture.image, texture.linear, file);
  }
  if (scene.environment) writeExr(*scene.environment, folder / "environment.exr");
  for (const Scene::Measured& measured : scene.measured) {
    brdf::writeMeasured(folder / measured.file, measured.table);
  }
  writeTextFile(folder / (scene.name + ".glb"), Writer(scene).binary());
}

}  // namespace limn::assets
