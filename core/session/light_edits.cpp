#include "core/session/light_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/session/private/mesh_light.h"
#include "core/session/view.h"

namespace limn::session {
namespace {

constexpr const char* kProperties =
    "position=x,y,z (m), rotation=pitch,yaw,roll (degrees), size=u,v (m; directional: "
    "radians), colour=r,g,b, intensity=I";

[[noreturn]] void refuse(const std::string& setting, const std::string& why) {
  throw UsageError(fmt::format("--set-light '{}' is not accepted: {}; expected NAME.PROPERTY=VALUE with {}",
                               setting, why, kProperties));
}

/// N numbers with commas between them; where `alike`, a single one stands for all.
template <int N, class T = float>
glm::vec<N, T> numbers(const std::string& setting, std::string_view text, bool alike = false) {
  const std::string wanted = N == 1 ? "one number is wanted" : fmt::format("{} numbers are wanted", N);
  glm::vec<N, T> values(0);
  int count = 0;
  for (bool more = true; more;) {
    if (count == N) refuse(setting, wanted);
    const size_t comma = text.find(',');
    const auto number = parseNumber(text.substr(0, comma));
    if (!number || !(std::abs(*number) <= 1e9)) refuse(setting, "a number is wrong");
    values[count++] = static_cast<T>(*number);
    more = comma != std::string_view::npos;
    if (more) text.remove_prefix(comma + 1);
  }
  if (count == 1 && alike) return glm::vec<N, T>(values[0]);
  if (count < N) refuse(setting, wanted);
  return values;
}

void add(LightEdit& edit, const std::string& setting, std::string_view property, std::string_view value) {
  if (property == "position") edit.position = numbers<3, double>(setting, value);
  if (property == "rotation") edit.rotation = numbers<3>(setting, value);
  if (property == "size") edit.size = numbers<2>(setting, value, true);
  if (property == "colour") edit.colour = numbers<3>(setting, value, true);
  if (property == "intensity") edit.intensity = numbers<1>(setting, value).x;
  // Of smaller ones the area, by which intensities are divided, is 0 or makes light infinite.
  constexpr float kLeastSize = 1e-9f;
  if (edit.size && !(edit.size->x >= kLeastSize && edit.size->y >= kLeastSize))
    refuse(setting, "sizes are above 0, at least 1e-9");
  if (edit.colour && glm::any(glm::lessThan(*edit.colour, glm::vec3(0))))
    refuse(setting, "colours are not negative");
  if (edit.intensity && *edit.intensity < 0) refuse(setting, "intensities are not negative");
}

/// Node of a punctual light of the pose; none for meshes and the environment's, for which no node is looked
/// at: there may be hundreds, described with every picture of a window. Pose::lights has those of nodes
/// first.
int nodeOf(const scene::Scene& scene, const scene::Pose& pose, int light) {
  constexpr uint32_t kOfNoNode = glsl::light_flag_geometry | glsl::light_flag_environment;
  if ((pose.lights[static_cast<size_t>(light)].flags & kOfNoNode) != 0) return scene::kNone;
  for (size_t n = 0; n < scene.nodes.size(); ++n)
    if (scene.nodes[n].light != scene::kNone && light-- == 0) return static_cast<int>(n);
  return scene::kNone;
}

scene::LightSource& ownSource(scene::Scene& scene, scene::Node& node) {
  scene.lights.push_back(scene.lights[static_cast<size_t>(node.light)]);  // nodes may share one
  node.light = static_cast<int>(scene.lights.size()) - 1;
  return scene.lights.back();
}

/// World coordinates, with no more digits than a float where they are one.
std::string text(const glm::dvec3& v) {
  const auto one = [](double x) {
    const auto rounded = static_cast<float>(x);
    return rounded == x ? fmt::format("{}", rounded) : fmt::format("{}", x);
  };
  return fmt::format("{},{},{}", one(v.x), one(v.y), one(v.z));
}

/// Node to world of a node whose light gets that frame, with the node's scale, which its mesh and what hangs
/// on it have. Where there is none the frame is kept to the bit; a node that is flat has no axes to turn.
glm::mat4 placed(const glm::mat3& axes, const glm::vec3& position, const AtRest& rest) {
  const glm::mat3 scale = glm::transpose(axesOf(rest.light)) * glm::mat3(rest.nodeToWorld), one(1);
  constexpr float kRounding = 1e-5f;
  bool scaled = false;
  for (int c = 0; c < 3; ++c)
    scaled = scaled || glm::any(glm::greaterThan(glm::abs(scale[c] - one[c]), glm::vec3(kRounding)));
  const bool kept = scaled && glm::determinant(glm::dmat3(scale)) != 0;
  return frameOf(kept ? axes * scale : axes, position);
}

void apply(scene::Scene& scene, const scene::Pose& pose, int animation, int light, const std::string& name,
           const LightEdit& edit, int index) {
  const glsl::Light& now = pose.lights[static_cast<size_t>(light)];
  scene::Node& node = scene.nodes[static_cast<size_t>(index)];
  scene::LightSource& source = ownSource(scene, node);
  const bool directional = source.type == glsl::light_directional;
  if (edit.position && directional)
    throw UsageError(
        fmt::format("--set-light {}.position: a directional light has none; it has rotation", name));
  if (edit.position || edit.rotation) {
    node.placed = placed(edit.rotation ? rotationOf(*edit.rotation) : axesOf(now),
                         edit.position ? glm::vec3(*edit.position - scene.origin) : now.position,
                         atRest(scene, pose, animation, light, index));
  }
  if (edit.size && directional) source.angle = edit.size->x;
  if (edit.size && !directional) node.limnArea = *edit.size;
  if (edit.colour) source.colour = *edit.colour;
  if (edit.intensity) source.intensity = *edit.intensity;
}

}  // namespace

LightEdits parseLightEdits(const std::vector<std::string>& settings) {
  LightEdits edits;
  for (const std::string& setting : settings) {
    // The last one: a name may hold what looks like a property, a value holds numbers alone.
    std::string_view property;
    size_t nameEnd = 0, valueBegin = 0;
    for (const std::string_view candidate : {"position", "rotation", "size", "colour", "intensity"}) {
      const std::string separator = fmt::format(".{}=", candidate);
      const size_t at = setting.rfind(separator);
      if (at == std::string::npos || at <= nameEnd) continue;
      property = candidate;
      nameEnd = at;
      valueBegin = at + separator.size();
    }
    if (property.empty()) refuse(setting, "it names no property");
    add(edits[setting.substr(0, nameEnd)], setting, property, std::string_view(setting).substr(valueBegin));
  }
  return edits;
}

std::vector<std::string> printed(const LightEdits& edits) {
  std::vector<std::string> settings;
  for (const auto& [name, edit] : edits) {
    const auto say = [&settings, &name = name](const char* property, const std::string& value) {
      settings.push_back(fmt::format("{}.{}={}", name, property, value));
    };
    if (edit.position) say("position", text(*edit.position));
    if (edit.rotation) say("rotation", text(*edit.rotation));
    if (edit.size) say("size", fmt::format("{},{}", edit.size->x, edit.size->y));
    if (edit.colour) say("colour", text(*edit.colour));
    if (edit.intensity) say("intensity", fmt::format("{}", *edit.intensity));
  }
  return settings;
}

void applyLightEdits(scene::Scene& scene, const scene::Pose& pose, const LightEdits& edits, int animation) {
  for (const auto& [name, edit] : edits) {
    const int light = findNamed("light", name, pose.lightNames);
    if (const int node = nodeOf(scene, pose, light); node != scene::kNone)
      apply(scene, pose, animation, light, name, edit, node);
    else if (const auto mesh = meshLightOf(scene, pose, light))
      applyToMesh(scene, pose, animation, light, *mesh, edit);
    else
      throw UsageError(fmt::format(
          "--set-light {}: only lights of nodes and emissive quads can be changed; this one is {}", name,
          (pose.lights[static_cast<size_t>(light)].flags & glsl::light_flag_environment) != 0
              ? "part of the environment"
              : "one of several of its mesh, or its mesh is textured, instanced or deformed"));
  }
}

bool followTime(const LightEdits& edits) {
  return std::ranges::any_of(edits, [](const auto& named) {
    const LightEdit& edit = named.second;
    return (edit.position || edit.rotation || edit.size) && !(edit.position && edit.rotation);
  });
}

bool changeMeshes(const scene::Pose& pose, const LightEdits& edits) {
  return std::ranges::any_of(edits, [&](const auto& named) {
    const int light = findNamed("light", named.first, pose.lightNames);
    return (pose.lights[static_cast<size_t>(light)].flags & glsl::light_flag_geometry) != 0;
  });
}

bool isEditable(const scene::Scene& scene, const scene::Pose& pose, int index) {
  if (withoutArea(pose.lights[static_cast<size_t>(index)])) return false;
  if (nodeOf(scene, pose, index) == scene::kNone && !meshLightOf(scene, pose, index)) return false;
  // Last, since parts of an environment, of which there may be hundreds, do not come this far.
  const auto first = std::ranges::find(pose.lightNames, pose.lightNames[static_cast<size_t>(index)]);
  return first - pose.lightNames.begin() == index;
}

LightEdit describeLight(const scene::Scene& scene, const scene::Pose& pose, int index) {
  LightEdit now;
  const int node = nodeOf(scene, pose, index);
  if (node == scene::kNone) {
    const auto mesh = meshLightOf(scene, pose, index);
    return mesh ? describeMesh(scene, pose.lights[static_cast<size_t>(index)], *mesh) : now;
  }
  const scene::Node& holder = scene.nodes[static_cast<size_t>(node)];
  const scene::LightSource& source = scene.lights[static_cast<size_t>(holder.light)];
  const glsl::Light& light = pose.lights[static_cast<size_t>(index)];
  const bool directional = source.type == glsl::light_directional;
  if (!directional) now.position = scene.origin + glm::dvec3(light.position);
  now.rotation = anglesOf(axesOf(light));
  now.size = directional ? glm::vec2(source.angle) : holder.limnArea;
  now.colour = source.colour;
  now.intensity = source.intensity;
  return now;
}

glm::mat3 rotationOf(const glm::vec3& degrees) {
  const glm::vec3 a = glm::radians(degrees);
  const glm::mat4 one(1);
  return glm::mat3(glm::rotate(one, a.y, {0, 1, 0}) * glm::rotate(one, a.x, {1, 0, 0}) *
                   glm::rotate(one, a.z, {0, 0, 1}));
}

glm::vec3 anglesOf(const glm::mat3& r) {
  const float pitch = std::atan2(-r[2].y, std::hypot(r[2].x, r[2].z));
  // Straight up or down roll and yaw are one: all of it is called yaw.
  const bool upright = std::hypot(r[0].y, r[1].y) < 1e-6f;
  const float yaw = upright ? std::atan2(-r[0].z, r[0].x) : std::atan2(r[2].x, r[2].z);
  const float roll = upright ? 0.f : std::atan2(r[0].y, r[1].y);
  return glm::degrees(glm::vec3(pitch, yaw, roll));
}

}  // namespace limn::session
