// The state of a scene at a time: animation, world matrices, skins, cameras, lights, bounds.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/normal_matrix.h"
#include "core/scene/private/animate.h"
#include "core/scene/private/finite.h"
#include "core/scene/private/world_light.h"
#include "core/scene/scene.h"

namespace limn::scene {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

Bounds morphReach(const Primitive& primitive, const std::vector<float>& weights) {
  Bounds reach{glm::vec3(0), glm::vec3(0)};
  for (std::size_t t = 0; t < std::min(weights.size(), primitive.morphTargets.size()); ++t) {
    const Bounds& delta = primitive.morphTargets[t].deltaBounds;
    if (delta.empty()) continue;
    reach.low += glm::min(weights[t] * delta.low, weights[t] * delta.high);
    reach.high += glm::max(weights[t] * delta.low, weights[t] * delta.high);
  }
  return reach;
}

const Animation* chooseAnimation(const Scene& scene, double time, int animation) {
  if (!std::isfinite(time)) throw UsageError("time: a finite number of seconds is accepted");
  if (animation == kNone) return scene.animations.empty() ? nullptr : &scene.animations.front();
  if (animation < 0 || at(animation) >= scene.animations.size())
    throw UsageError(
        fmt::format("animation {} does not exist; the scene has {}", animation, scene.animations.size()));
  return &scene.animations[at(animation)];
}

double wrapped(double time, double duration) {
  if (!(duration > 0)) return 0;
  const double rest = std::fmod(time, duration);
  return rest < 0 ? rest + duration : rest;
}

void animate(const Scene& scene, const Animation* animation, double time, Pose& pose) {
  pose.nodeLocal.resize(scene.nodes.size());
  pose.weightChannel.assign(scene.nodes.size(), kNone);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) pose.nodeLocal[i] = scene.nodes[i].transform;
  if (!animation) return;
  for (std::size_t k = 0; k < animation->channels.size(); ++k) {
    const AnimationChannel& channel = animation->channels[k];
    if (channel.path == AnimationChannel::Path::weights) {
      pose.weightChannel[at(channel.node)] = static_cast<int>(k);
      continue;
    }
    Transform& local = pose.nodeLocal[at(channel.node)];
    std::array<float, 4> v{};
    const bool rotation = channel.path == AnimationChannel::Path::rotation;
    sampleChannel(channel, time, std::span(v).first(rotation ? 4 : 3));
    if (rotation) {
      local.rotation = glm::quat(v[3], v[0], v[1], v[2]);
    } else if (channel.path == AnimationChannel::Path::translation) {
      local.translation = {v[0], v[1], v[2]};
    } else {
      local.scale = {v[0], v[1], v[2]};
    }
  }
}

/// Far from the file's origin translations cancel: in double, and from Scene::origin.
void updateExactMatrices(const Scene& scene, Pose& pose) {
  pose.nodeToWorldExact.resize(scene.nodes.size());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    glm::dmat4& world = pose.nodeToWorldExact[i];
    if (node.placed) {
      world = glm::dmat4(*node.placed);
      continue;
    }
    world = glm::dmat4(node.matrix ? *node.matrix : pose.nodeLocal[i].matrix());
    world[3] += glm::dvec4(node.parent == kNone ? node.base - scene.origin : node.base, 0);
    if (node.parent != kNone) world = pose.nodeToWorldExact[at(node.parent)] * world;
  }
}

void updateWorldMatrices(const Scene& scene, Pose& pose) {
  pose.origin = scene.origin;
  pose.nodeToWorld.resize(scene.nodes.size());
  if (scene.origin != glm::dvec3(0)) {
    updateExactMatrices(scene, pose);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
      pose.nodeToWorld[i] = glm::mat4(pose.nodeToWorldExact[i]);
    return;
  }
  pose.nodeToWorldExact.clear();
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    if (node.placed) {
      pose.nodeToWorld[i] = *node.placed;
      continue;
    }
    const glm::mat4 local = node.matrix ? *node.matrix : pose.nodeLocal[i].matrix();
    pose.nodeToWorld[i] = node.parent == kNone ? local : pose.nodeToWorld[at(node.parent)] * local;
  }
}

/// Node to world times `local`, rounded once.
glm::mat4 inWorld(const Pose& pose, std::size_t node, const glm::mat4& local) {
  if (pose.nodeToWorldExact.empty()) return pose.nodeToWorld[node] * local;
  return glm::mat4(pose.nodeToWorldExact[node] * glm::dmat4(local));
}

/// Appends elements to a vector whose elements own memory, without giving that memory back between frames.
template <class T>
class Refill {
 public:
  explicit Refill(std::vector<T>& values) : values_(values) {}
  ~Refill() { values_.resize(count_); }
  T& next() {
    if (count_ == values_.size()) values_.emplace_back();
    return values_[count_++];
  }
  int count() const { return static_cast<int>(count_); }

 private:
  std::vector<T>& values_;
  std::size_t count_ = 0;
};

void setWeights(const Scene& scene, const Animation* animation, double time, const Pose& pose, int node,
                std::vector<float>& weights) {
  const Node& source = scene.nodes[at(node)];
  const std::vector<float>& mesh = scene.meshes[at(source.mesh)].morphWeights;
  const std::vector<float>& start = source.morphWeights.empty() ? mesh : source.morphWeights;
  weights.assign(start.begin(), start.end());
  const int channel = pose.weightChannel[at(node)];
  if (animation && channel != kNone) sampleChannel(animation->channels[at(channel)], time, weights);
}

void setJoints(const Skin& skin, const Pose& pose, std::vector<glm::mat4>& joints) {
  joints.resize(skin.joints.size());
  for (std::size_t j = 0; j < skin.joints.size(); ++j)
    joints[j] = inWorld(pose, at(skin.joints[j]), skin.inverseBind[j]);
}

/// Index into pose.deformed of one primitive of a node, or none if it is rigid.
int addDeformation(const Scene& scene, const Animation* animation, double time, int nodeIndex,
                   int primitiveIndex, Pose& pose, Refill<Deformation>& deformed) {
  const Node& node = scene.nodes[at(nodeIndex)];
  const Primitive& primitive = scene.meshes[at(node.mesh)].primitives[at(primitiveIndex)];
  const bool skinned = node.skin != kNone && !primitive.joints.empty();
  if (!skinned && primitive.morphTargets.empty()) return kNone;
  const int index = deformed.count();
  Deformation& out = deformed.next();
  out.mesh = node.mesh;
  out.primitive = primitiveIndex;
  out.joints.clear();
  out.morphWeights.clear();
  if (skinned) setJoints(scene.skins[at(node.skin)], pose, out.joints);
  if (!primitive.morphTargets.empty()) setWeights(scene, animation, time, pose, nodeIndex, out.morphWeights);
  return index;
}

void addInstances(const Scene& scene, const Animation* animation, double time, Pose& pose) {
  Refill<Deformation> deformed(pose.deformed);
  pose.instances.clear();
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const Node& node = scene.nodes[n];
    if (node.mesh == kNone) continue;
    const std::size_t primitives = scene.meshes[at(node.mesh)].primitives.size();
    const std::size_t firstInstance = pose.instances.size();
    const std::size_t copies = std::max<std::size_t>(1, node.instances.size());
    for (std::size_t copy = 0; copy < copies; ++copy) {
      const glm::mat4 world =
          node.instances.empty() ? pose.nodeToWorld[n] : inWorld(pose, n, node.instances[copy].matrix());
      for (std::size_t p = 0; p < primitives; ++p) {
        DrawInstance instance;
        instance.node = static_cast<int>(n);
        instance.mesh = node.mesh;
        instance.primitive = static_cast<int>(p);
        // Copies share their node's skin and morph state.
        instance.deformed = copy > 0 ? pose.instances[firstInstance + p].deformed
                                     : addDeformation(scene, animation, time, instance.node,
                                                      instance.primitive, pose, deformed);
        const bool skinned =
            instance.deformed != kNone && !pose.deformed[at(instance.deformed)].joints.empty();
        instance.objectToWorld = skinned ? glm::mat4(1) : world;
        instance.mirroredSkin = skinned && mirrors(world);
        pose.instances.push_back(instance);
      }
    }
  }
  for (std::size_t i = 0; i < scene.dynamic.size(); ++i) {
    DrawInstance instance;
    instance.mesh = static_cast<int>(i);
    pose.instances.push_back(instance);
  }
}

/// Throws Error for triangles that would read what is not there.
void check(const Scene::Dynamic& dynamic, const Primitive& primitive) {
  const std::size_t vertices = primitive.positions.size();
  const auto fail = [&](const std::string& what) {
    throw Error(fmt::format("geometry source '{}': {}", dynamic.name, what));
  };
  if (primitive.indices.size() % 3 != 0)
    fail(fmt::format("{} indices, which is no multiple of 3", primitive.indices.size()));
  if (primitive.normals.size() != vertices)
    fail(fmt::format("{} normals for {} positions", primitive.normals.size(), vertices));
  const auto perVertex = [&](std::size_t count, const char* what) {
    if (count != 0 && count != vertices) fail(fmt::format("{} {} for {} positions", count, what, vertices));
  };
  perVertex(primitive.tangents.size(), "tangents");
  perVertex(primitive.uvs.size(), "texture coordinates");
  perVertex(primitive.colours.size(), "colours");
  for (const std::uint32_t index : primitive.indices)
    if (index >= vertices) fail(fmt::format("index {} of {} positions", index, vertices));
  for (const glm::vec3& p : primitive.positions)
    if (!glm::all(glm::lessThan(glm::abs(p), glm::vec3(1e30f)))) fail("a position that is not finite");
}

void updateDynamic(const Scene& scene, double time, Pose& pose) {
  static const std::shared_ptr<const Primitive> nothing = std::make_shared<Primitive>();
  pose.dynamic.resize(scene.dynamic.size());
  for (std::size_t i = 0; i < scene.dynamic.size(); ++i) {
    DynamicGeometry& geometry = pose.dynamic[i];
    std::shared_ptr<const Primitive> now = scene.dynamic[i].source->at(time);
    if (!now) now = nothing;
    if (now == geometry.primitive) continue;
    check(scene.dynamic[i], *now);
    geometry.bounds = {};
    for (const glm::vec3& p : now->positions) geometry.bounds.add(p);
    geometry.primitive = std::move(now);
  }
}

void addCameras(const Scene& scene, Pose& pose) {
  Refill<CameraPose> cameras(pose.cameras);
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    if (scene.nodes[n].camera == kNone) continue;
    const CameraLens& lens = scene.cameras[at(scene.nodes[n].camera)];
    CameraPose& camera = cameras.next();
    setName(camera.name, scene.nodes[n].name, lens.name, cameras.count() - 1);
    camera.worldToView = worldToView(pose.nodeToWorld[n]);
    camera.yfov = lens.yfov;
    camera.near = lens.near;
  }
}

void addLights(const Scene& scene, Pose& pose) {
  Refill<std::string> names(pose.lightNames);
  pose.lights.clear();
  // Names are written where they stay, so that no frame takes memory for them.
  const auto add = [&](glsl::Light light) -> std::string& {
    light.index = static_cast<uint32_t>(pose.lights.size());
    pose.lights.push_back(light);
    return names.next();
  };
  const auto addNamed = [&](const glsl::Light& light, const std::string& first, const std::string& second) {
    std::string& name = add(light);
    setName(name, first, second, names.count() - 1);
  };
  const auto addNumbered = [&](const glsl::Light& light, std::string_view of, std::size_t number) {
    std::string& name = add(light);
    name.clear();
    fmt::format_to(std::back_inserter(name), "{}#{}", of, number);
  };
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const Node& node = scene.nodes[n];
    if (node.light == kNone) continue;
    const LightSource& source = scene.lights[at(node.light)];
    addNamed(punctualLight(source, node.limnArea, pose.nodeToWorld[n]), node.name, source.name);
  }
  for (std::size_t i = 0; i < pose.instances.size(); ++i) {
    const DrawInstance& instance = pose.instances[i];
    if (instance.node == kNone) continue;
    const Mesh& mesh = scene.meshes[at(instance.mesh)];
    const Primitive& primitive = mesh.primitives[at(instance.primitive)];
    for (std::size_t k = 0; k < primitive.emissiveParts.size(); ++k) {
      const auto light = quadLight(primitive.emissiveParts[k], scene.materials[at(primitive.material)],
                                   instance.objectToWorld, static_cast<uint32_t>(i));
      if (!light) continue;
      const std::string& given = scene.nodes[at(instance.node)].name;
      if (primitive.emissiveParts.size() == 1)
        addNamed(*light, given, mesh.name);
      else
        addNumbered(*light, given.empty() ? mesh.name : given, k);
    }
  }
  for (std::size_t i = 0; i < scene.environment.lights.size(); ++i)
    addNumbered(distantLight(scene.environment.lights[i], scene.environment), "env", i);
}

/// Throws Error where nodes have grown or gone beyond what floats hold.
void checkFinite(const Scene& scene, const Pose& pose) {
  const auto fail = [&](const std::string& what) {
    const std::string file = scene.file.empty() ? "" : scene.file.string() + ": ";
    const std::string when = pose.time == 0 ? "" : fmt::format("at {} s ", pose.time);
    throw Error(oneLine(fmt::format("{}{}{}", file, when, what)));
  };
  // Bounds pass over what is no number, as 0 times an infinite scale is.
  const bool allFinite =
      std::ranges::all_of(pose.instances, [](const DrawInstance& d) { return finite(d.objectToWorld); }) &&
      std::ranges::all_of(pose.deformed, [](const Deformation& d) {
        return std::ranges::all_of(d.joints, [](const glm::mat4& joint) { return finite(joint); });
      });
  if (!allFinite || (!pose.bounds.empty() && !std::isfinite(pose.bounds.radius())))
    fail("the scene's extent is not a finite number; check the scales of its nodes");
  for (const Deformation& d : pose.deformed)
    if (!std::ranges::all_of(d.morphWeights, [](float weight) { return std::isfinite(weight); }))
      fail(fmt::format("a morph weight of mesh {} is not a finite number; check its animation", d.mesh));
  const auto checkPlace = [&](const glm::vec3& place, const char* kind, const std::string& name) {
    if (!finite(place))
      fail(fmt::format("the place of {} '{}' is not finite; check the scales of the nodes above it", kind,
                       name));
  };
  for (std::size_t i = 0; i < pose.lights.size(); ++i)
    checkPlace(pose.lights[i].position, "light", pose.lightNames[i]);
  for (const CameraPose& camera : pose.cameras)
    checkPlace(glm::vec3(camera.worldToView[3]), "camera", camera.name);
}

}  // namespace

glm::mat4 Transform::matrix() const {
  glm::mat4 m = glm::mat4_cast(rotation);
  for (int c = 0; c < 3; ++c) m[c] *= scale[c];
  m[3] = glm::vec4(translation, 1);
  return m;
}

uint64_t Scene::triangles() const {
  uint64_t count = 0;
  for (const Node& node : nodes) {
    if (node.mesh == kNone) continue;
    uint64_t one = 0;
    for (const Primitive& primitive : meshes[at(node.mesh)].primitives) one += primitive.indices.size() / 3;
    count += one * std::max<uint64_t>(1, node.instances.size());
  }
  return count;
}

Bounds transformed(const Bounds& box, const glm::mat4& matrix) {
  if (box.empty()) return box;
  const glm::vec3 centre(matrix * glm::vec4(0.5f * box.low + 0.5f * box.high, 1));
  const glm::vec3 half = 0.5f * box.high - 0.5f * box.low;
  const glm::vec3 extent = glm::abs(glm::vec3(matrix[0])) * half.x + glm::abs(glm::vec3(matrix[1])) * half.y +
                           glm::abs(glm::vec3(matrix[2])) * half.z;
  return {centre - extent, centre + extent};
}

Bounds deformedBounds(const Primitive& primitive, const Deformation& state) {
  const Bounds reach = morphReach(primitive, state.morphWeights);
  const auto grown = [&](const Bounds& box) {
    return box.empty() ? box : Bounds{box.low + reach.low, box.high + reach.high};
  };
  if (state.joints.empty()) return grown(primitive.bounds);
  // A blended position is a convex combination of what its joints make of it.
  Bounds bounds;
  for (const auto& [joint, box] : primitive.jointBounds)
    bounds.add(transformed(grown(box), state.joints[joint]));
  return bounds;
}

Bounds instanceBounds(const Scene& scene, const Pose& pose, const DrawInstance& instance) {
  if (instance.node == kNone) return pose.dynamic[at(instance.mesh)].bounds;
  const Primitive& primitive = scene.meshes[at(instance.mesh)].primitives[at(instance.primitive)];
  if (instance.deformed == kNone) return transformed(primitive.bounds, instance.objectToWorld);
  const Deformation& state = pose.deformed[at(instance.deformed)];
  const Bounds bounds = deformedBounds(primitive, state);
  return state.joints.empty() ? transformed(bounds, instance.objectToWorld) : bounds;
}

void evaluate(const Scene& scene, double time, int animation, Pose& pose) {
  const Animation* chosen = chooseAnimation(scene, time, animation);
  const double local = chosen ? wrapped(time, chosen->duration) : 0;
  pose.time = time;
  animate(scene, chosen, local, pose);
  updateWorldMatrices(scene, pose);
  addInstances(scene, chosen, local, pose);
  updateDynamic(scene, time, pose);
  addCameras(scene, pose);
  addLights(scene, pose);
  pose.bounds = {};
  for (const DrawInstance& instance : pose.instances) pose.bounds.add(instanceBounds(scene, pose, instance));
  checkFinite(scene, pose);
}

Pose evaluate(const Scene& scene, double time, int animation) {
  Pose pose;
  evaluate(scene, time, animation, pose);
  return pose;
}

}  // namespace limn::scene
