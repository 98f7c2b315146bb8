#include "core/indirect/scene_points.h"

#include <algorithm>
#include <cmath>

#include "core/scene/draw_instance.h"
#include "core/scene/instance_areas.h"
#include "glsl/numeric/sampling.glsl"

namespace limn::indirect {
namespace {

/// Index of the first element above `u` times the last one.
uint32_t indexAt(std::span<const float> upTo, float u) {
  auto found = std::upper_bound(upTo.begin(), upTo.end(), u * upTo.back());
  if (found == upTo.end()) found = std::lower_bound(upTo.begin(), upTo.end(), upTo.back());
  return static_cast<uint32_t>(found - upTo.begin());
}

/// Whether `m` changes the lengths of all vectors, and so all areas, by one factor.
bool scalesAlike(const glm::dmat3& m) {
  const glm::dmat3 products = glm::transpose(m) * m;
  constexpr double rounding = 1e-5;  // of a matrix of floats
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::abs(products[i][j] - (i == j ? products[0][0] : 0)) > rounding * products[0][0]) return false;
  return true;
}

}  // namespace

void AreaTable::fill(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                     const glm::dmat3& toWorld) {
  upTo.resize(indices.size() / 3);
  double sum = 0;
  for (size_t i = 0; i < upTo.size(); ++i) {
    const glm::dvec3 a(positions[indices[3 * i]]), b(positions[indices[3 * i + 1]]),
        c(positions[indices[3 * i + 2]]);
    sum += 0.5 * glm::length(glm::cross(toWorld * (b - a), toWorld * (c - a)));
    upTo[i] = static_cast<float>(sum);
  }
}

uint32_t AreaTable::triangle(float u) const {
  return indexAt(upTo, u);
}

ScenePoints::ScenePoints(gpu::Device& device, const scene::Scene& scene, const scene::Pose& pose, int count)
    : scene_(scene), points_(static_cast<size_t>(count)) {
  for (const scene::Mesh& mesh : scene.meshes) {
    firstOfMesh_.push_back(fixed_.size());
    fixed_.resize(fixed_.size() + mesh.primitives.size());
  }
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  for (const scene::Deformation& d : pose.deformed) {
    const scene::Primitive& p =
        scene.meshes[static_cast<size_t>(d.mesh)].primitives[static_cast<size_t>(d.primitive)];
    scene::deform(p, d, positions, normals, tangents);
    deformed_.emplace_back().fill(positions, p.indices);
  }
  dynamic_.resize(scene.dynamic.size());
  choose(pose);
  buffer_ =
      gpu::Buffer::of<glsl::ScenePoint>(device, "points of the scene", points_, gpu::BufferUse::updated);
}

frame::BufferHandle ScenePoints::import(frame::FrameGraph& graph) {
  graph_ = &graph;
  return handle_ = graph.importBuffer("points of the scene", buffer_);
}

void ScenePoints::update(const scene::Pose& pose) {
  const auto same = [](const std::shared_ptr<const scene::Primitive>& known,
                       const scene::DynamicGeometry& now) { return known == now.primitive; };
  const auto alike = [](const glm::dvec3& known, const scene::DrawInstance& now) {
    return scene::areasAlike(known, scene::areaFactors(now.objectToWorld));
  };
  if (std::ranges::equal(known_, pose.dynamic, same) && std::ranges::equal(areas_, pose.instances, alike))
    return;
  choose(pose);
  buffer_.update(0, points_.data(), points_.size() * sizeof(points_[0]));
  graph_->touch(handle_);
}

/// Areas of all instances.
void ScenePoints::measure(const scene::Pose& pose) {
  known_.resize(pose.dynamic.size());
  for (size_t i = 0; i < pose.dynamic.size(); ++i) {
    if (known_[i] == pose.dynamic[i].primitive) continue;
    known_[i] = pose.dynamic[i].primitive;
    dynamic_[i].fill(known_[i]->positions, known_[i]->indices);
  }
  tables_.resize(pose.instances.size());
  stretched_.resize(pose.instances.size());
  upTo_.resize(pose.instances.size());
  areas_.resize(pose.instances.size());
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  double sum = 0;
  for (size_t i = 0; i < pose.instances.size(); ++i) {
    const scene::DrawInstance& drawn = pose.instances[i];
    const auto mesh = static_cast<size_t>(drawn.mesh);
    if (drawn.node == scene::kNone) {
      tables_[i] = &dynamic_[mesh];
    } else if (drawn.deformed != scene::kNone) {
      tables_[i] = &deformed_[static_cast<size_t>(drawn.deformed)];
    } else {
      AreaTable& table = fixed_[firstOfMesh_[mesh] + static_cast<size_t>(drawn.primitive)];
      const scene::Primitive& p = scene::primitiveOf(scene_, pose, drawn);
      if (table.upTo.empty()) table.fill(p.positions, p.indices);
      tables_[i] = &table;
    }
    areas_[i] = scene::areaFactors(drawn.objectToWorld);
    const glm::dmat3 toWorld{glm::dmat4(drawn.objectToWorld)};
    double scale = std::cbrt(std::abs(glm::determinant(toWorld)));
    if (!scalesAlike(toWorld)) {
      const scene::Primitive& p = scene::primitiveOf(scene_, pose, drawn);
      if (drawn.deformed != scene::kNone)
        scene::deform(p, pose.deformed[static_cast<size_t>(drawn.deformed)], positions, normals, tangents);
      stretched_[i].fill(drawn.deformed != scene::kNone ? positions : p.positions, p.indices, toWorld);
      tables_[i] = &stretched_[i];
      scale = 1;
    }
    sum += tables_[i]->total() * scale * scale;
    upTo_[i] = static_cast<float>(sum);
  }
  area_ = static_cast<float>(sum);
}

void ScenePoints::choose(const scene::Pose& pose) {
  measure(pose);
  if (!(area_ > 0) || !std::isfinite(area_)) {
    area_ = 0;
    return;
  }
  chosen_.assign(pose.instances.size(), 0);
  for (size_t i = 0; i < points_.size(); ++i) {
    // Each instance has a sequence of its own: of one sequence for all, a small instance would get a thin
    // slice, whose points cluster.
    const uint32_t instance = indexAt(upTo_, glsl::r2_sequence(static_cast<uint32_t>(i) + 1).x);
    const glm::vec3 u = glsl::r3_sequence(++chosen_[instance]);
    const uint32_t triangle = tables_[instance]->triangle(u.x);
    const scene::Primitive& p = scene::primitiveOf(scene_, pose, pose.instances[instance]);
    const uint32_t* corner = &p.indices[3 * size_t{triangle}];
    const float root = std::sqrt(u.y);
    points_[i] = {.corners = {corner[0], corner[1], corner[2]},
                  .instance = instance,
                  .place = {root * (1 - u.z), root * u.z},
                  .unused = {}};
  }
}

}  // namespace limn::indirect
