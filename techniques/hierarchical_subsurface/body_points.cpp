#include "techniques/hierarchical_subsurface/body_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/scene/diffusion_profile.h"
#include "core/scene/draw_instance.h"
#include "core/scene/normal_matrix.h"
#include "core/scene/subsurface.h"
#include "glsl/scene/light.glsl"

namespace limn::hierarchical_subsurface {
namespace {

/// Points of a mesh whose edges are halved down to L, times L^2 over its area: sides of triangles are then
/// between L / 2 and L, and a point has the area of two triangles.
constexpr float kPointsPerSquare = 2.3f;
/// Distances to points of bodies without area do not matter.
constexpr float kNoPoints = 1e9f;

/// Sets the one draw of `own` to what it is in `pose`.
void copyDraw(const scene::Pose& pose, uint32_t draw, scene::Pose& own) {
  own.instances.assign(1, pose.instances[draw]);
  scene::DrawInstance& copy = own.instances.front();
  if (copy.node == scene::kNone) own.dynamic = pose.dynamic;
  if (copy.deformed == scene::kNone) return;
  own.deformed.assign(1, pose.deformed[static_cast<size_t>(copy.deformed)]);
  copy.deformed = 0;
}

/// Returns whether a draw is in `pose` where it is in `own`, as copyDraw() left it, in the same shape.
bool stands(const scene::Pose& pose, uint32_t draw, const scene::Pose& own) {
  const scene::DrawInstance &now = pose.instances[draw], &then = own.instances.front();
  if (now.objectToWorld != then.objectToWorld) return false;
  if (now.deformed == scene::kNone) return true;
  const scene::Deformation &shape = pose.deformed[static_cast<size_t>(now.deformed)],
                           &before = own.deformed.front();
  return shape.joints == before.joints && shape.morphWeights == before.morphWeights;
}

/// Returns the inverse of a matrix, nothing where it has none.
std::optional<glm::dmat4> inverseOf(const glm::mat4& matrix) {
  const glm::dmat4 inverse = glm::inverse(glm::dmat4(matrix));
  for (int column = 0; column < 4; ++column)
    if (glm::any(glm::isnan(inverse[column])) || glm::any(glm::isinf(inverse[column]))) return std::nullopt;
  return inverse;
}

}  // namespace

BodyPoints::BodyPoints(const scene::Scene& scene, const scene::Pose& pose, int count, int64_t mostBytes)
    : scene_(scene), drawCount_(pose.instances.size()), bodies_(std::max<size_t>(drawCount_, 1)) {
  const auto check = [&](size_t nodes) {
    const size_t bytes = nodes * sizeof(glsl::ScatterNode);
    if (bytes > static_cast<size_t>(mostBytes))
      throw UsageError(fmt::format(
          "hierarchical_subsurface: {} or more points and clusters take {} MiB; a storage block holds {}",
          nodes, bytes >> 20, mostBytes >> 20));
  };
  // How many points halved edges make is not known before: long thin triangles make many.
  const size_t most = static_cast<size_t>(mostBytes) / sizeof(glsl::ScatterNode);
  size_t slots = 0;
  for (uint32_t draw = 0; draw < drawCount_; ++draw)
    if (scene::materialOf(scene, pose.instances[draw]).subsurface) {
      parts_.push_back(makeBody(draw, pose, count, most));
      slots += parts_.back().elements->forest().leafSlots();
      check(slots);  // before all other bodies have taken their memory
    }
  std::vector<const radiosity::Forest*> forests;
  for (const Body& body : parts_) forests.push_back(&body.elements->forest());
  tree_ = WalkTree(forests);
  check(tree_.nodes().size());
  points_.resize(
      tree_.leafCount(),
      {.position = glm::vec3(0), .instance = glsl::no_instance, .normal = glm::vec3(0), .reach = 0});
  for (size_t i = 0; i < parts_.size(); ++i) place(i);
}

bool BodyPoints::fits(const scene::Pose& pose) const {
  if (pose.instances.size() != drawCount_) return false;
  return std::ranges::all_of(parts_, [&](const Body& body) {
    return body.elements->fits(pose, {&pose.instances[body.draw], 1});
  });
}

void BodyPoints::update(const scene::Pose& pose) {
  for (size_t i = 0; i < parts_.size(); ++i) {
    Body& part = parts_[i];
    if (part.toOwn) {
      const glm::mat4 &now = pose.instances[part.draw].objectToWorld,
                      &made = part.pose.instances.front().objectToWorld;
      const glm::dmat4 motion = now == made ? glm::dmat4(1) : glm::dmat4(now) * *part.toOwn;
      if (motion == part.motion) continue;
      part.motion = motion;
    } else {
      if (stands(pose, part.draw, part.pose)) continue;
      copyDraw(pose, part.draw, part.pose);
      part.elements->update(part.pose);
    }
    place(i);
  }
}

BodyPoints::Body BodyPoints::makeBody(uint32_t draw, const scene::Pose& pose, int count, size_t most) const {
  constexpr size_t countable = std::numeric_limits<uint32_t>::max();
  Body body;
  body.draw = draw;
  copyDraw(pose, draw, body.pose);
  body.pose.bounds = scene::instanceBounds(scene_, pose, pose.instances[draw]);
  size_t fronts = 0;  // of elements; those on the backs of double-sided bodies are no points
  const auto create = [&](float longestEdge) {
    body.elements = std::make_unique<radiosity::SceneElements>(
        scene_, body.pose, longestEdge, static_cast<uint32_t>(std::min(most, countable)));
    const radiosity::Surfels& surfels = body.elements->surfels();
    body.areas.assign(body.elements->forest().leafSlots(), 0);
    fronts = 0;
    float area = 0, square = 0;
    for (size_t i = 0; i < surfels.size(); ++i) {
      if (surfels.origins[surfels.firstOrigin[i]].side < 0) continue;
      body.areas[body.elements->forest().leafOf()[i]] = surfels.areas[i];
      ++fronts;
      area += surfels.areas[i];
      square += surfels.areas[i] * surfels.areas[i];
    }
    body.spacing = area > 0 ? std::sqrt(square / area) : kNoPoints;
    return area;
  };
  const float area = create(10);
  const bool fewer = fronts < static_cast<size_t>(count);
  if (fewer && area > 0) create(std::sqrt(kPointsPerSquare * area / static_cast<float>(count)));
  body.elements->update(body.pose);  // clusters are where points are that left what encloses them
  if (body.pose.instances.front().deformed == scene::kNone)
    body.toOwn = inverseOf(body.pose.instances.front().objectToWorld);
  return body;
}

void BodyPoints::place(size_t index) {
  const Body& part = parts_[index];
  const radiosity::SceneElements& elements = *part.elements;
  const radiosity::ElementSpace& space = elements.space();
  const glm::dvec3 centre(space.centre());
  const glm::dvec3 way = glm::dvec3(part.motion * glm::dvec4(centre, 1)) - centre;
  tree_.place(
      index, elements.forest(), space, part.areas,
      {.turn = glm::mat3(part.motion), .shift = glm::vec3(way / static_cast<double>(space.radius()))});
  const bool still = part.motion == glm::dmat4(1);
  const glm::mat3 toNormal = scene::normalMatrix(glm::mat4(part.motion));
  for (uint32_t slot = 0; slot < elements.forest().leafSlots(); ++slot) {
    if (!(part.areas[slot] > 0)) continue;
    const radiosity::Leaf& leaf = elements.leaves()[slot];
    const glm::vec3 normal(leaf.normal);
    points_[tree_.node(index, 0, slot)] = {.position = glm::vec3(part.motion * glm::dvec4(leaf.position)),
                                           .instance = part.draw,
                                           .normal = still ? normal : glm::normalize(toNormal * normal),
                                           .reach = std::sqrt(part.areas[slot]) * space.radius()};
  }
  const scene::DrawInstance& drawn = part.pose.instances.front();
  const scene::Material& material = scene::materialOf(scene_, drawn);
  const bool textured = scene::albedoVaries(material, scene::primitiveOf(scene_, part.pose, drawn));
  bodies_[part.draw] = {.centre = space.centre(),
                        .radius = space.radius(),
                        .extinction = material.subsurface->extinction,
                        .softening = part.spacing,
                        .absorption = material.subsurface->absorption,
                        .eta = scene::subsurfaceIor(material.ior),
                        .first_node = tree_.first(index),
                        .textured = textured ? 1u : 0u,
                        .unused = glm::uvec2(0)};
}

}  // namespace limn::hierarchical_subsurface
