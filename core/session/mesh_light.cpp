#include "core/session/private/mesh_light.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace limn::session {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// The primitive that is the only light of its mesh, and emits the same everywhere; none where there is none.
int onlyEmitter(const scene::Scene& scene, const scene::Mesh& mesh) {
  int found = scene::kNone;
  std::size_t parts = 0;
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    parts += mesh.primitives[p].emissiveParts.size();
    if (!mesh.primitives[p].emissiveParts.empty()) found = static_cast<int>(p);
  }
  if (parts != 1) return scene::kNone;
  const scene::Material& material = scene.materials[at(mesh.primitives[at(found)].material)];
  return material.emissiveTexture.image == scene::kNone ? found : scene::kNone;
}

glm::mat4 inverseOf(const glm::mat3& axes, const glm::vec3& position) {
  const glm::mat3 back = glm::transpose(axes);
  return frameOf(back, -(back * position));
}

glm::vec2 sizeOf(const glsl::Light& light) {
  return {light.length_u, light.length_v};
}

}  // namespace

bool withoutArea(const glsl::Light& light) {
  return (light.flags & glsl::light_flag_geometry) != 0 && light.length_u == 0;
}

bool appearsLater(const scene::Scene& scene, int animation) {
  if (scene.animations.empty()) return false;
  const scene::Pose start = scene::evaluate(scene, 0, animation);
  std::ptrdiff_t parts = 0;
  for (const scene::DrawInstance& drawn : start.instances)
    if (drawn.node != scene::kNone)
      parts += std::ssize(scene.meshes[at(drawn.mesh)].primitives[at(drawn.primitive)].emissiveParts);
  return parts > std::ranges::count_if(start.lights, [](const glsl::Light& l) {
           return (l.flags & glsl::light_flag_geometry) != 0 && !withoutArea(l);
         });
}

AtRest atRest(const scene::Scene& scene, const scene::Pose& pose, int animation, int light, int node) {
  const glsl::Light& now = pose.lights[at(light)];
  if (!scene.animations.empty()) {
    const scene::Pose start = scene::evaluate(scene, 0, animation);
    // Meshes may be no lights at some times, or have no area; lights of nodes always are.
    if ((now.flags & glsl::light_flag_geometry) == 0)
      return {start.lights[at(light)], start.nodeToWorld[at(node)]};
    for (const glsl::Light& l : start.lights)
      if ((l.flags & glsl::light_flag_geometry) != 0 && l.own_instance == now.own_instance && !withoutArea(l))
        return {l, start.nodeToWorld[at(node)]};
  }
  return {now, pose.nodeToWorld[at(node)]};
}

glm::mat4 frameOf(const glm::mat3& axes, const glm::vec3& position) {
  glm::mat4 frame(axes);
  frame[3] = glm::vec4(position, 1);
  return frame;
}

void giveOwnMaterials(scene::Scene& scene) {
  std::vector<int> uses(scene.materials.size());
  for (const scene::Mesh& mesh : scene.meshes)
    for (const scene::Primitive& primitive : mesh.primitives) ++uses[at(primitive.material)];
  for (const scene::Scene::Dynamic& dynamic : scene.dynamic) ++uses[at(dynamic.material)];
  for (scene::Mesh& mesh : scene.meshes) {
    const int emitter = onlyEmitter(scene, mesh);
    if (emitter == scene::kNone) continue;
    int& material = mesh.primitives[at(emitter)].material;
    if (uses[at(material)] == 1) continue;
    --uses[at(material)];
    const scene::Material copy = scene.materials[at(material)];
    scene.materials.push_back(copy);
    material = static_cast<int>(scene.materials.size()) - 1;
  }
}

std::optional<MeshLight> meshLightOf(const scene::Scene& scene, const scene::Pose& pose, int light) {
  const glsl::Light& l = pose.lights[at(light)];
  if ((l.flags & glsl::light_flag_geometry) == 0) return std::nullopt;
  const scene::DrawInstance& drawn = pose.instances[l.own_instance];
  const scene::Node& node = scene.nodes[at(drawn.node)];
  const scene::Mesh& mesh = scene.meshes[at(drawn.mesh)];
  const int emitter = onlyEmitter(scene, mesh);
  if (emitter == scene::kNone || drawn.deformed != scene::kNone || !node.instances.empty())
    return std::nullopt;
  const auto holders =
      std::ranges::count_if(scene.nodes, [&](const scene::Node& n) { return n.mesh == drawn.mesh; });
  return MeshLight{drawn.node, mesh.primitives[at(emitter)].material, holders > 1};
}

void applyToMesh(scene::Scene& scene, const scene::Pose& pose, int animation, int light,
                 const MeshLight& mesh, const LightEdit& edit) {
  if (mesh.shared && (edit.size || edit.colour || edit.intensity))
    throw UsageError(
        fmt::format("--set-light {}: several nodes share its mesh, which has one size and emission; position "
                    "and rotation are accepted",
                    pose.lightNames[at(light)]));
  const glsl::Light& now = pose.lights[at(light)];
  const AtRest rest = atRest(scene, pose, animation, light, mesh.node);
  if (withoutArea(rest.light)) return;
  const glm::mat3 axes = axesOf(withoutArea(now) ? rest.light : now);
  const glm::vec2 restSize = sizeOf(rest.light), size = edit.size.value_or(restSize);
  if (edit.position || edit.rotation || edit.size) {
    const glm::mat4 wanted = frameOf(edit.rotation ? rotationOf(*edit.rotation) : axes,
                                     edit.position ? glm::vec3(*edit.position - scene.origin) : now.position);
    glm::mat4 scale(1);
    scale[0][0] = size.x / restSize.x;
    scale[1][1] = size.y / restSize.y;
    scene.nodes[at(mesh.node)].placed =
        wanted * scale * inverseOf(axesOf(rest.light), rest.light.position) * rest.nodeToWorld;
  }
  if (edit.size || edit.colour || edit.intensity) {
    const LightEdit before = describeMesh(scene, rest.light, mesh);
    scene.materials[at(mesh.material)].emission =
        edit.colour.value_or(*before.colour) * edit.intensity.value_or(*before.intensity) / (size.x * size.y);
  }
}

LightEdit describeMesh(const scene::Scene& scene, const glsl::Light& light, const MeshLight& mesh) {
  LightEdit now;
  now.position = scene.origin + glm::dvec3(light.position);
  now.rotation = anglesOf(axesOf(light));
  if (mesh.shared) return now;
  const glm::vec3 emission = scene.materials[at(mesh.material)].emission;
  const float most = std::max({emission.x, emission.y, emission.z});
  now.size = sizeOf(light);
  now.colour = most > 0 ? emission / most : glm::vec3(1);
  now.intensity = most * now.size->x * now.size->y;
  return now;
}

glm::mat3 axesOf(const glsl::Light& light) {
  return {light.axis_u, light.axis_v, -light.direction};
}

}  // namespace limn::session
