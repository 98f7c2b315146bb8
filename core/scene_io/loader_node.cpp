// The node graph, instances and skins.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>

#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

constexpr float kRounding = 1e-5f;  ///< of the last row of a matrix that a program has multiplied

bool inRange(int index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}

std::string label(const char* kind, std::size_t index, const std::string& name) {
  return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} {} '{}'", kind, index, name);
}

/// How many lights each mesh is where it is drawn once: the parts of its emissive rectangles.
std::vector<std::uint64_t> lightsOf(const std::vector<Mesh>& meshes) {
  std::vector<std::uint64_t> lights;
  for (const Mesh& mesh : meshes) {
    lights.push_back(0);
    for (const Primitive& primitive : mesh.primitives) lights.back() += primitive.emissiveParts.size();
  }
  return lights;
}

int lightOf(const tinygltf::Node& node) {
  const auto found = node.extensions.find("KHR_lights_punctual");
  if (found == node.extensions.end() || !found->second.IsObject()) return kNone;
  const tinygltf::Value& light = found->second.Get("light");
  return light.IsInt() ? light.GetNumberAsInt() : kNone;
}

/// Gives a matrix the last row 0, 0, 0, 1. Returns whether it had another one.
bool makeAffine(glm::mat4& m) {
  const glm::vec4 affine(0, 0, 0, 1), last = glm::row(m, 3);
  m = glm::row(m, 3, affine);
  return !glm::all(glm::lessThanEqual(glm::abs(last - affine), glm::vec4(kRounding)));
}

}  // namespace

void Loader::orderNodes() {
  const std::size_t count = model_->nodes.size();
  std::vector<int> parent(count, kNone);
  for (std::size_t i = 0; i < count; ++i) {
    for (const int child : model_->nodes[i].children) {
      const std::string what = label("node", i, model_->nodes[i].name);
      if (!inRange(child, count))
        fail(fmt::format("{}: child {} does not exist; there are {}", what, child, count));
      int& known = parent[static_cast<std::size_t>(child)];
      if (known != kNone)
        fail(fmt::format("node {} has two parents, {} and {}; one is accepted", child, known, i));
      known = static_cast<int>(i);
    }
  }
  newIndex_.assign(count, kNone);
  std::vector<int> stack;
  for (std::size_t i = count; i-- > 0;) {
    if (parent[i] == kNone) stack.push_back(static_cast<int>(i));
  }
  while (!stack.empty()) {
    const int index = stack.back();
    stack.pop_back();
    newIndex_[static_cast<std::size_t>(index)] = static_cast<int>(fileIndex_.size());
    fileIndex_.push_back(index);
    const auto& children = model_->nodes[static_cast<std::size_t>(index)].children;
    stack.insert(stack.end(), children.rbegin(), children.rend());
  }
  // With one parent each, whatever no root reaches lies on a cycle or below one.
  if (fileIndex_.size() != count) {
    const auto lost = std::find(newIndex_.begin(), newIndex_.end(), kNone) - newIndex_.begin();
    fail(fmt::format(
        "the node graph has a cycle: {} is its own ancestor or below one that is",
        label("node", static_cast<std::size_t>(lost), model_->nodes[static_cast<std::size_t>(lost)].name)));
  }
  scene_.nodes.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const int p = parent[static_cast<std::size_t>(fileIndex_[i])];
    scene_.nodes[i].parent = p == kNone ? kNone : newIndex_[static_cast<std::size_t>(p)];
  }
}

void Loader::findVisible() {
  const std::size_t count = model_->nodes.size();
  visible_.assign(count, model_->scenes.empty() ? 1 : 0);
  if (model_->scenes.empty()) return;
  const int chosen = model_->defaultScene == -1 ? 0 : model_->defaultScene;
  if (!inRange(chosen, model_->scenes.size()))
    fail(fmt::format("scene {} does not exist; there are {}", chosen, model_->scenes.size()));
  if (model_->scenes.size() > 1) warn("only the default scene is loaded");
  for (const int root : model_->scenes[static_cast<std::size_t>(chosen)].nodes) {
    if (!inRange(root, count))
      fail(fmt::format("scene {}: node {} does not exist; there are {}", chosen, root, count));
    visible_[static_cast<std::size_t>(root)] = 1;
  }
  for (const int file : fileIndex_) {  // parents first
    if (!visible_[static_cast<std::size_t>(file)]) continue;
    for (const int child : model_->nodes[static_cast<std::size_t>(file)].children)
      visible_[static_cast<std::size_t>(child)] = 1;
  }
}

void Loader::readNodes() {
  orderNodes();
  findVisible();
  for (std::size_t i = 0; i < fileIndex_.size(); ++i) {
    const std::size_t file = static_cast<std::size_t>(fileIndex_[i]);
    const tinygltf::Node& source = model_->nodes[file];
    const int parent = scene_.nodes[i].parent;
    scene_.nodes[i] = readNode(source, label("node", file, source.name));
    scene_.nodes[i].parent = parent;
    if (visible_[file]) continue;
    Node& hidden = scene_.nodes[i];
    hidden.mesh = hidden.skin = hidden.camera = hidden.light = kNone;
    hidden.instances.clear();
  }
}

Node Loader::readNode(const tinygltf::Node& source, const std::string& what) {
  Node node;
  node.name = source.name;
  if (source.matrix.size() == 16) {
    glm::mat4 m;
    for (std::size_t i = 0; i < 16; ++i)
      m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = number(source.matrix[i], what + " matrix");
    if (makeAffine(m)) warn(what + " matrix: its last row is not 0, 0, 0, 1, which is taken instead");
    node.matrix = m;
  }
  if (source.translation.size() == 3) {
    for (int c = 0; c < 3; ++c)
      node.transform.translation[c] =
          number(source.translation[static_cast<std::size_t>(c)], what + " translation");
  }
  if (source.scale.size() == 3) {
    for (int c = 0; c < 3; ++c)
      node.transform.scale[c] = number(source.scale[static_cast<std::size_t>(c)], what + " scale");
  }
  if (source.rotation.size() == 4) {
    const glm::dquat q(source.rotation[3], source.rotation[0], source.rotation[1], source.rotation[2]);
    node.transform.rotation = unitRotation(q, what + " rotation");
  }
  for (const double w : source.weights) node.morphWeights.push_back(number(w, what + " weights"));

  const auto reference = [&](int index, std::size_t size, const char* kind) {
    if (index != kNone && !inRange(index, size))
      fail(fmt::format("{}: {} {} does not exist; there are {}", what, kind, index, size));
    return index;
  };
  node.mesh = reference(source.mesh, scene_.meshes.size(), "mesh");
  node.skin = reference(source.skin, model_->skins.size(), "skin");
  const int camera = reference(source.camera, cameraIndex_.size(), "camera");
  node.camera = camera == kNone ? kNone : cameraIndex_[static_cast<std::size_t>(camera)];
  // Of the file's own: each node with a limn_angle adds one to the scene's.
  node.light = reference(lightOf(source), model_->lights.size(), "light");
  readNodeLight(source, node, what);
  readInstances(source, node, what);
  return node;
}

glm::quat Loader::unitRotation(const glm::dquat& q, const std::string& what) const {
  const double length = glm::length(q);
  if (!std::isfinite(length) || !(length > 1e-12)) fail(fmt::format("{} is not a rotation", what));
  return glm::quat(q / length);
}

void Loader::readNodeLight(const tinygltf::Node& source, Node& node, const std::string& what) {
  if (!source.extras.IsObject() || node.light == kNone) return;
  const uint32_t type = scene_.lights[static_cast<std::size_t>(node.light)].type;
  if (const auto angle = readAngle(source.extras, type, what)) {
    LightSource own = scene_.lights[static_cast<std::size_t>(node.light)];
    own.angle = *angle;
    node.light = static_cast<int>(scene_.lights.size());
    scene_.lights.push_back(std::move(own));
  }
  if (source.extras.Has("limn_area")) {
    const std::vector<float> area = numbers(source.extras.Get("limn_area"), 2, what + " limn_area");
    if (!(area[0] > 0 && area[1] > 0))
      fail(fmt::format("{} limn_area: sides {} and {}; two positive lengths in metres are accepted", what,
                       area[0], area[1]));
    const LightSource& light = scene_.lights[static_cast<std::size_t>(node.light)];
    if (light.type == glsl::light_directional) {
      warn(what + ": limn_area has no meaning for a directional light and is ignored");
    } else {
      const float brightest = std::max({light.colour.x, light.colour.y, light.colour.z});
      number(brightest * (light.intensity / (area[0] * area[1])), what + " limn_area: intensity / area");
      node.limnArea = {area[0], area[1]};
    }
  }
}

void Loader::readInstances(const tinygltf::Node& source, Node& node, const std::string& what) {
  const auto found = source.extensions.find("EXT_mesh_gpu_instancing");
  if (found == source.extensions.end() || !found->second.IsObject() || node.mesh == kNone) return;
  const tinygltf::Value& attributes = found->second.Get("attributes");
  if (!attributes.IsObject()) fail(what + " EXT_mesh_gpu_instancing: no attributes");
  if (node.skin != kNone) {
    warn(what + ": instances of a skinned mesh are ignored");
    return;
  }
  std::int64_t count = -1;
  const auto read = [&](const char* name, int components) {
    const tinygltf::Value& accessor = attributes.Get(name);
    if (!accessor.IsInt()) return Floats{};
    Floats f = readFloats(accessor.GetNumberAsInt(), {components}, count, what + " instances " + name);
    count = static_cast<std::int64_t>(f.count);
    return f;
  };
  const Floats translation = read("TRANSLATION", 3), rotation = read("ROTATION", 4), scale = read("SCALE", 3);
  node.instances.resize(static_cast<std::size_t>(std::max<std::int64_t>(count, 0)));
  for (std::size_t i = 0; i < node.instances.size(); ++i) {
    Transform& t = node.instances[i];
    if (translation.count)
      t.translation = {translation.values[3 * i], translation.values[3 * i + 1],
                       translation.values[3 * i + 2]};
    if (scale.count) t.scale = {scale.values[3 * i], scale.values[3 * i + 1], scale.values[3 * i + 2]};
    if (rotation.count) {
      const float* q = &rotation.values[4 * i];
      t.rotation =
          unitRotation(glm::dquat(q[3], q[0], q[1], q[2]), fmt::format("{} instance {} rotation", what, i));
    }
  }
}

void Loader::readSkins() {
  for (std::size_t i = 0; i < model_->skins.size(); ++i) {
    const tinygltf::Skin& source = model_->skins[i];
    const std::string what = label("skin", i, source.name);
    Skin skin;
    for (const int joint : source.joints) {
      if (!inRange(joint, newIndex_.size()))
        fail(fmt::format("{}: joint node {} does not exist; there are {}", what, joint, newIndex_.size()));
      skin.joints.push_back(newIndex_[static_cast<std::size_t>(joint)]);
    }
    skin.inverseBind.assign(skin.joints.size(), glm::mat4(1));
    if (source.inverseBindMatrices != kNone) {
      const Floats f = readFloats(source.inverseBindMatrices, {16}, -1, what + " inverseBindMatrices");
      if (f.count < skin.joints.size())
        fail(fmt::format("{}: {} inverse bind matrices for {} joints", what, f.count, skin.joints.size()));
      bool changed = false;
      for (std::size_t k = 0; k < skin.joints.size(); ++k) {
        for (std::size_t e = 0; e < 16; ++e)
          skin.inverseBind[k][static_cast<int>(e / 4)][static_cast<int>(e % 4)] = f.values[16 * k + e];
        changed = makeAffine(skin.inverseBind[k]) || changed;
      }
      if (changed)
        warn(what + " inverseBindMatrices: the last row of one is not 0, 0, 0, 1, which is taken instead");
    }
    scene_.skins.push_back(std::move(skin));
  }
}

void Loader::checkNodeUses() {
  const std::vector<std::uint64_t> meshLights = lightsOf(scene_.meshes);
  std::uint64_t instances = 0, joints = 0, lights = 0, weights = 0;
  for (const Node& node : scene_.nodes) {
    if (node.mesh == kNone) continue;
    const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(node.mesh)];
    const std::uint64_t copies = std::max<std::uint64_t>(1, node.instances.size());
    instances += copies * mesh.primitives.size();
    lights += copies * meshLights[static_cast<std::size_t>(node.mesh)];
    weights += mesh.morphWeights.size() * mesh.primitives.size();
    if (node.skin != kNone)
      joints += scene_.skins[static_cast<std::size_t>(node.skin)].joints.size() * mesh.primitives.size();
  }
  if (std::max({instances, joints, lights, weights}) > limits_.instances)
    fail(
        fmt::format("{} drawn primitives, {} joint matrices, {} lights of emissive rectangles and {} morph "
                    "weights; at most {} of each are accepted",
                    instances, joints, lights, weights, limits_.instances));
  for (Node& node : scene_.nodes) {
    if (node.mesh == kNone) continue;
    const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(node.mesh)];
    node.morphWeights.resize(node.morphWeights.empty() ? 0 : mesh.morphWeights.size(), 0.f);
    if (node.skin == kNone) continue;
    const std::size_t count = scene_.skins[static_cast<std::size_t>(node.skin)].joints.size();
    for (const Primitive& primitive : mesh.primitives) {
      if (!primitive.jointBounds.empty() && primitive.jointBounds.back().first >= count)
        fail(fmt::format("mesh '{}': a vertex names joint {}; skin {} has {}", mesh.name,
                         primitive.jointBounds.back().first, node.skin, count));
    }
  }
}

}  // namespace limn::scene
