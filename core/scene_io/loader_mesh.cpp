// Meshes: attributes, triangles, morph targets.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/scene/emissive_quad.h"
#include "core/scene/primitive_tools.h"
#include "core/scene/tangents.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

int attribute(const std::map<std::string, int>& attributes, const char* name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? kNone : found->second;
}

std::vector<glm::vec2> toVec2(const Floats& f) {
  std::vector<glm::vec2> out(f.count);
  for (std::size_t i = 0; i < f.count; ++i) out[i] = {f.values[2 * i], f.values[2 * i + 1]};
  return out;
}

std::vector<glm::vec3> toVec3(const Floats& f) {
  std::vector<glm::vec3> out(f.count);
  for (std::size_t i = 0; i < f.count; ++i)
    out[i] = {f.values[3 * i], f.values[3 * i + 1], f.values[3 * i + 2]};
  return out;
}

/// Missing fourth components become 1.
std::vector<glm::vec4> toVec4(const Floats& f) {
  std::vector<glm::vec4> out(f.count, glm::vec4(1));
  const std::size_t n = static_cast<std::size_t>(f.components);
  for (std::size_t i = 0; i < f.count; ++i) {
    for (std::size_t c = 0; c < n; ++c) out[i][static_cast<int>(c)] = f.values[n * i + c];
  }
  return out;
}

/// glTF 2.0, section 3.7.2.1: strips and fans as triangles; degenerate stitches of strips are left out.
std::vector<uint32_t> toTriangles(const std::vector<uint32_t>& in, bool strip) {
  std::vector<uint32_t> out;
  for (std::size_t i = 0; i + 2 < in.size(); ++i) {
    const std::size_t odd = i % 2;
    const uint32_t a = strip ? in[i] : in[i + 1], b = strip ? in[i + 1 + odd] : in[i + 2],
                   c = strip ? in[i + 2 - odd] : in[0];
    if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
  }
  return out;
}

double unitError(const glm::vec3& v) {
  return std::abs(glm::length(glm::dvec3(v)) - 1);
}

/// Says whether a material has tangents for its height map alone, whose u rises another way than a file's
/// tangents do: those belong to the first set of coordinates, as it is before KHR_texture_transform.
bool mapTurnsTangents(const Material& material, const UvUse& uvs) {
  if (material.height == kNone || material.normalTexture.image != kNone ||
      (material.model && glsl::model_anisotropic(*material.model)))
    return false;
  return uvs.set != 0 || uvs.rotation != 0 || uvs.scale.x < 0 || uvs.scale.y < 0;
}

}  // namespace

void Loader::readMeshes() {
  for (std::size_t i = 0; i < model_->meshes.size(); ++i) {
    const tinygltf::Mesh& source = model_->meshes[i];
    const std::string label =
        source.name.empty() ? fmt::format("mesh {}", i) : fmt::format("mesh {} '{}'", i, source.name);
    Mesh mesh;
    mesh.name = source.name;
    for (const double weight : source.weights)
      mesh.morphWeights.push_back(number(weight, label + " weights"));
    std::size_t targets = 0;
    for (std::size_t k = 0; k < source.primitives.size(); ++k) {
      Primitive primitive;
      if (!readPrimitive(source.primitives[k], primitive, fmt::format("{} primitive {}", label, k))) continue;
      targets = std::max(targets, primitive.morphTargets.size());
      mesh.primitives.push_back(std::move(primitive));
    }
    mesh.morphWeights.resize(targets, 0.f);
    scene_.meshes.push_back(std::move(mesh));
  }
}

int Loader::defaultMaterial() {
  if (defaultMaterial_ == kNone) {
    defaultMaterial_ = static_cast<int>(scene_.materials.size());
    scene_.materials.push_back({});
    uvUses_.push_back({});
  }
  return defaultMaterial_;
}

bool Loader::readPrimitive(const tinygltf::Primitive& source, Primitive& out, const std::string& what) {
  if (source.mode < TINYGLTF_MODE_POINTS || source.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    fail(fmt::format("{}: mode {} is not one of glTF 2.0", what, source.mode));
  if (source.mode < TINYGLTF_MODE_TRIANGLES) {
    warn("points and lines are not drawn");
    return false;
  }
  if (attribute(source.attributes, "POSITION") == kNone) {
    warn(what + " has no positions and is left out");
    return false;
  }
  out.material = source.material;
  if (source.material == kNone) {
    out.material = defaultMaterial();
  } else if (source.material < 0 || static_cast<std::size_t>(source.material) >= model_->materials.size()) {
    fail(fmt::format("{}: material {} does not exist; there are {}", what, source.material,
                     model_->materials.size()));
  }
  readAttributes(source, out, what);
  readTriangles(source, out, what);
  if (out.indices.empty()) return false;
  readMorphTargets(source, out, what);
  completePrimitive(out, what);
  return true;
}

void Loader::readAttributes(const tinygltf::Primitive& source, Primitive& out, const std::string& what) {
  const auto& attributes = source.attributes;
  out.positions = toVec3(readFloats(attribute(attributes, "POSITION"), {3}, -1, what + " POSITION"));
  const auto count = static_cast<std::int64_t>(out.positions.size());
  if (const int normal = attribute(attributes, "NORMAL"); normal != kNone)
    out.normals = toVec3(readFloats(normal, {3}, count, what + " NORMAL"));
  const Material& material = scene_.materials[static_cast<std::size_t>(out.material)];
  if (const int tangent = attribute(attributes, "TANGENT");
      tangent != kNone && material.tangents() &&
      !mapTurnsTangents(material, uvUses_[static_cast<std::size_t>(out.material)]))
    out.tangents = toVec4(readFloats(tangent, {4}, count, what + " TANGENT"));
  if (const int colour = attribute(attributes, "COLOR_0"); colour != kNone)
    out.colours = toVec4(readFloats(colour, {3, 4}, count, what + " COLOR_0"));
  for (glm::vec4& c : out.colours) c = glm::clamp(c, 0.f, 1.f);  // glTF 2.0, section 3.7.2.1
  // Coefficients say what their surface reflects; of its colours only a mask's alpha is left.
  if (material.subsurface && !material.subsurface->albedoFromBaseColour) {
    if (material.alphaCutoff == 0) out.colours.clear();
    for (glm::vec4& c : out.colours) c = glm::vec4(glm::vec3(1), c.a);
  }
  readUvs(source, out, what);
  readSkinAttributes(source, out, what);
}

void Loader::readUvs(const tinygltf::Primitive& source, Primitive& out, const std::string& what) {
  const UvUse& use = uvUses_[static_cast<std::size_t>(out.material)];
  if (!use.used) return;
  const std::string name = fmt::format("TEXCOORD_{}", use.set);
  const int accessor = attribute(source.attributes, name.c_str());
  if (accessor == kNone) {
    if (!scene_.materials[static_cast<std::size_t>(out.material)].textured()) return;
    warn(fmt::format("{}: no {} for the textures of its material; (0, 0) is used", what, name));
    out.uvs.assign(out.positions.size(), glm::vec2(0));
    return;
  }
  out.uvs =
      toVec2(readFloats(accessor, {2}, static_cast<std::int64_t>(out.positions.size()), what + " " + name));
  if (use.scale == glm::vec2(1) && use.offset == glm::vec2(0) && use.rotation == 0) return;
  const std::string place = what + " transformed " + name;
  // KHR_texture_transform: translation * rotation * scale.
  const float c = std::cos(use.rotation), s = std::sin(use.rotation);
  for (glm::vec2& uv : out.uvs) {
    const glm::vec2 scaled = use.scale * uv;
    uv = use.offset + glm::vec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x);
    number(uv.x, place);
    number(uv.y, place);
  }
}

void Loader::readSkinAttributes(const tinygltf::Primitive& source, Primitive& out, const std::string& what) {
  const int joints = attribute(source.attributes, "JOINTS_0"),
            weights = attribute(source.attributes, "WEIGHTS_0");
  if (joints == kNone && weights == kNone) return;
  if (joints == kNone || weights == kNone) fail(what + ": JOINTS_0 and WEIGHTS_0 must come together");
  if (attribute(source.attributes, "JOINTS_1") != kNone)
    warn(what + ": only the first four joints of a vertex are used");
  const auto count = static_cast<std::int64_t>(out.positions.size());
  const std::vector<std::uint32_t> indices = readIntegers(joints, 4, count, what + " JOINTS_0");
  out.weights = toVec4(readFloats(weights, {4}, count, what + " WEIGHTS_0"));
  out.joints.resize(out.positions.size());
  bool changed = false;
  for (std::size_t i = 0; i < out.weights.size(); ++i) {
    glm::vec4& w = out.weights[i];
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t joint = indices[4 * i + static_cast<std::size_t>(k)];
      if (joint > 65535) fail(fmt::format("{} JOINTS_0: joint {} of vertex {} is too large", what, joint, i));
      w[k] = std::max(w[k], 0.f);
      out.joints[i][k] = static_cast<std::uint16_t>(joint);
    }
    const double sum = static_cast<double>(w.x) + w.y + w.z + w.w;
    // One quantisation step of 8-bit weights may be missing from each; that is rounding, not a fault.
    changed = changed || std::abs(sum - 1) > 4.0 / 255;
    w = sum > 0 ? glm::vec4(glm::dvec4(w) / sum) : glm::vec4(0);
    // Only joints that move the vertex must exist; a weight may vanish in the division.
    for (int k = 0; k < 4; ++k)
      if (!(w[k] > 0)) out.joints[i][k] = 0;
    if (!(sum > 0)) w.x = 1;
  }
  if (changed) warn(what + ": skin weights do not sum to 1; normalised");
}

void Loader::readTriangles(const tinygltf::Primitive& source, Primitive& out, const std::string& what) {
  std::vector<uint32_t> indices;
  if (source.indices != kNone) {
    indices = readIntegers(source.indices, 1, -1, what + " indices");
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] >= out.positions.size())
        fail(fmt::format("{} indices (accessor {}): index {} at {}; there are {} vertices", what,
                         source.indices, indices[i], i, out.positions.size()));
    }
  } else {
    if (out.positions.size() > UINT32_MAX) fail(what + ": more than 2^32 vertices");
    indices.resize(out.positions.size());
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<uint32_t>(i);
  }
  if (source.mode == TINYGLTF_MODE_TRIANGLES) {
    if (indices.size() % 3 != 0)
      warn(what + ": the number of indices is no multiple of 3; the rest is ignored");
    indices.resize(indices.size() / 3 * 3);
    out.indices = std::move(indices);
  } else {
    spend(2 * indices.size(), what);
    out.indices = toTriangles(indices, source.mode == TINYGLTF_MODE_TRIANGLE_STRIP);
  }
  if (out.indices.empty()) warn(what + " has no triangle and is left out");
}

void Loader::readMorphTargets(const tinygltf::Primitive& source, Primitive& out, const std::string& what) {
  const auto count = static_cast<std::int64_t>(out.positions.size());
  for (std::size_t t = 0; t < source.targets.size(); ++t) {
    const auto& attributes = source.targets[t];
    const std::string place = fmt::format("{} target {}", what, t);
    MorphTarget target;
    if (const int a = attribute(attributes, "POSITION"); a != kNone)
      target.positions = toVec3(readFloats(a, {3}, count, place + " POSITION"));
    if (const int a = attribute(attributes, "NORMAL"); a != kNone && !out.normals.empty())
      target.normals = toVec3(readFloats(a, {3}, count, place + " NORMAL"));
    if (const int a = attribute(attributes, "TANGENT");
        a != kNone && !out.tangents.empty() && !out.normals.empty())
      target.tangents = toVec3(readFloats(a, {3}, count, place + " TANGENT"));
    for (const auto& [name, accessor] : attributes)
      if ((name == "COLOR_0" && !out.colours.empty()) || (name.starts_with("TEXCOORD_") && !out.uvs.empty()))
        warn(fmt::format("{}: morph targets of {} are ignored", what, oneLine(name, 40)));
    out.morphTargets.push_back(std::move(target));
  }
}

void Loader::completeNormals(Primitive& out, const std::string& what) {
  if (out.normals.empty()) {
    spend(out.indices.size() * (1 + out.morphTargets.size()), what);
    splitFlat(out);
    return;
  }
  std::vector<glm::vec3> smooth;
  bool changed = false;
  for (std::size_t i = 0; i < out.normals.size(); ++i) {
    glm::vec3& n = out.normals[i];
    const double length = glm::length(glm::dvec3(n));
    changed = changed || std::abs(length - 1) > 0.05;
    if (length > 0) {
      n = glm::vec3(glm::dvec3(n) / length);
      continue;
    }
    if (smooth.empty()) smooth = smoothNormals(out.positions, out.indices);
    n = unitError(smooth[i]) < 0.5 ? smooth[i] : glm::vec3(0, 1, 0);
  }
  if (changed) warn(what + ": normals are not unit vectors; normalised");
}

void Loader::completePrimitive(Primitive& out, const std::string& what) {
  const Material& material = scene_.materials[static_cast<std::size_t>(out.material)];
  completeNormals(out, what);
  if (!material.tangents()) {
    out.tangents.clear();
  } else if (out.tangents.empty()) {
    const std::size_t vertices = out.positions.size();
    splitMirrored(out);
    spend((out.positions.size() - vertices) * (1 + out.morphTargets.size()), what);
    out.tangents = generateTangents(out.positions, out.normals, out.uvs, out.indices);
  } else {
    std::vector<glm::vec4> own;
    for (std::size_t i = 0; i < out.tangents.size(); ++i) {
      glm::vec4& t = out.tangents[i];
      const double length = glm::length(glm::dvec3(t));
      if (length > 0) {
        t = glm::vec4(glm::vec3(glm::dvec3(t) / length), t.w < 0 ? -1.f : 1.f);
        continue;
      }
      if (own.empty()) own = generateTangents(out.positions, out.normals, out.uvs, out.indices);
      t = own[i];
    }
  }
  computeBounds(out);
  checkHeightUvs(out);
  if (material.emission == glm::vec3(0) || material.unlit) return;
  if (const auto quad = material.alphaCutoff > 0 ? std::nullopt : findRectangle(out))
    out.emissiveParts = emissiveParts(scene_, out, *quad);
  if (out.emissiveParts.empty())
    warn("emissive meshes other than rectangles are displayed but light nothing");
}

}  // namespace limn::scene
