#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "core/base/error.h"
#include "core/rays/private/body_space.h"
#include "core/rays/ray_geometry.h"
#include "core/scene/draw_instance.h"

namespace limn::rays {
namespace {

/// Triangles that a primitive whose topology changes has room for at least.
constexpr uint32_t kLeastCapacity = 64;
constexpr int64_t kTriangleBytes = 3 * sizeof(glm::vec4);

uint32_t triangleCount(const scene::Primitive& primitive) {
  return static_cast<uint32_t>(primitive.indices.size() / 3);
}

uint32_t capacityFor(uint32_t triangles) {
  return std::bit_ceil(std::max(triangles, kLeastCapacity));
}

void toWorld(const scene::Primitive& primitive, const glm::mat4& place, std::vector<glm::vec3>& positions) {
  positions.clear();
  for (const glm::vec3& p : primitive.positions) positions.emplace_back(place * glm::vec4(p, 1));
}

/// Whether the mask is open here and closed there.
bool hasOwnMask(const scene::Primitive& primitive, const scene::Material& material) {
  const bool textured = material.baseColourTexture.image != scene::kNone && !primitive.uvs.empty();
  return material.alphaCutoff > 0 && (textured || !primitive.colours.empty());
}

}  // namespace

/// What the instance is made of. Only one that moved may have become flat, or solid, since.
RayGeometryService::Source RayGeometryService::sourceOf(const scene::Pose& pose, uint32_t draw) const {
  const scene::DrawInstance& instance = pose.instances[draw];
  Source source{instance.node == scene::kNone, instance.mesh, instance.primitive, instance.deformed};
  if (built_ && matrices_[draw] == instance.objectToWorld)
    source.flat = sources_[draw].flat;
  else if (instance.deformed == scene::kNone && extentOf(instance.objectToWorld) == Extent::flat)
    source.flat = static_cast<int>(draw);
  return source;
}

/// Whether the pose consists of what was built.
bool RayGeometryService::fits(const scene::Pose& pose) const {
  if (!built_ || pose.instances.size() != sources_.size()) return false;
  for (uint32_t draw = 0; draw < sources_.size(); ++draw)
    if (sourceOf(pose, draw) != sources_[draw]) return false;
  return true;
}

void RayGeometryService::checkSize(const scene::Pose& pose) const {
  std::map<Source, int64_t> triangles;
  for (uint32_t draw = 0; draw < pose.instances.size(); ++draw) {
    const Source source = sourceOf(pose, draw);
    const uint32_t count = triangleCount(scene::primitiveOf(scene_, pose, pose.instances[draw]));
    triangles[source] = source.dynamic ? capacityFor(count) : count;
  }
  int64_t sum = 0;
  for (const auto& [source, count] : triangles) sum += count;
  // Nodes take 64 bytes, but most of them stand for more than one triangle.
  const int64_t bytes = sum * kTriangleBytes, most = device_.limits().maxStorageBlockBytes;
  if (bytes > most || sum >= int64_t{glsl::ray_leaf_mask} - glsl::ray_leaf_items)
    throw UsageError(
        fmt::format("{} triangles that rays are to meet take {} MiB, more than the {} MiB of a "
                    "storage buffer; ask for a technique with shadow maps, or a smaller scene",
                    sum, bytes >> 20, most >> 20));
}

void RayGeometryService::build(const scene::Pose& pose) {
  built_ = false;
  checkSize(pose);
  sources_.clear();
  meshes_.clear();
  meshOf_.clear();
  meshStack_ = 0;
  topCapacity_ = std::max<uint32_t>(static_cast<uint32_t>(pose.instances.size()), 1);
  Parts parts{.nodes = std::vector<glsl::RayNode>(topCapacity_),
              .triangles = {},
              .corners = {},
              .refits = {},
              .coverage = CoverageTable(scene_)};
  // Deformed primitives come last, so that their triangles lie together.
  std::map<Source, uint32_t> known;
  for (uint32_t draw = 0; draw < pose.instances.size(); ++draw) sources_.push_back(sourceOf(pose, draw));
  meshOf_.resize(sources_.size());
  bool updated = false;
  for (const bool deformed : {false, true}) {
    if (deformed) firstMoving_ = static_cast<uint32_t>(parts.triangles.size() / 3);
    for (uint32_t draw = 0; draw < sources_.size(); ++draw) {
      if ((sources_[draw].deformed != scene::kNone) != deformed) continue;
      const auto [found, fresh] = known.emplace(sources_[draw], static_cast<uint32_t>(meshes_.size()));
      if (fresh) meshes_.push_back(addMesh(parts, pose, draw));
      meshOf_[draw] = found->second;
      updated = updated || sources_[draw].dynamic || sources_[draw].flat != scene::kNone;
    }
  }
  moving_ = static_cast<uint32_t>(parts.triangles.size() / 3) - firstMoving_;
  const auto nodeBytes = static_cast<int64_t>(parts.nodes.size() * sizeof(glsl::RayNode));
  const auto maskBytes = static_cast<int64_t>(parts.coverage.words().size() * sizeof(uint32_t));
  if (std::max(nodeBytes, maskBytes) > device_.limits().maxStorageBlockBytes)
    throw UsageError(
        fmt::format("boxes and alpha masks for rays take {} MiB, more than the {} MiB of a "
                    "storage buffer; ask for a technique with shadow maps, or a smaller scene",
                    std::max(nodeBytes, maskBytes) >> 20, device_.limits().maxStorageBlockBytes >> 20));
  nodeBuffer_ = gpu::Buffer::of<glsl::RayNode>(device_, "ray nodes", parts.nodes, gpu::BufferUse::updated);
  triangleBuffer_ = gpu::Buffer::of<glm::vec4>(device_, "ray triangles", parts.triangles,
                                               updated ? gpu::BufferUse::updated : gpu::BufferUse::fixed);
  bodyBuffer_ =
      gpu::Buffer(device_, "ray bodies", sources_.size() * sizeof(glsl::RayBody), gpu::BufferUse::updated);
  masked_ = maskBytes > 0;
  if (masked_) coverageBuffer_ = gpu::Buffer::of<uint32_t>(device_, "ray coverage", parts.coverage.words());
  cornerBuffer_ = gpu::Buffer::of<glsl::RayCorners>(device_, "ray corners", parts.corners);
  std::vector<uint32_t> refits;
  refitCounts_.clear();
  for (const std::vector<uint32_t>& level : parts.refits) {
    refits.insert(refits.end(), level.begin(), level.end());
    refitCounts_.push_back(static_cast<uint32_t>(level.size()));
  }
  refitBuffer_ = gpu::Buffer::of<uint32_t>(device_, "nodes to refit", refits);
  bodies_.clear();
  topBoxes_.clear();
  matrices_.assign(sources_.size(), glm::mat4(0));
  built_ = true;
}

/// Leaves the hierarchy of the primitive's triangles in builder_.
void RayGeometryService::buildTree(const scene::Primitive& primitive,
                                   const std::vector<glm::vec3>& positions) {
  boxes_.resize(triangleCount(primitive));
  for (size_t t = 0; t < boxes_.size(); ++t) {
    glsl::RayBox box = glsl::ray_box_empty();
    for (size_t k = 0; k < 3; ++k) {
      const glm::vec3& p = positions[primitive.indices[3 * t + k]];
      box = glsl::ray_box_join(box, {p, p});
    }
    boxes_[t] = glsl::ray_box_grown(box);
  }
  builder_.build(boxes_, glsl::ray_leaf_items, Split::surfaceArea);
}

/// Appends the hierarchy in builder_, whose first node and triangle get these numbers.
void RayGeometryService::appendTree(std::vector<glsl::RayNode>& nodes, std::vector<glm::vec4>& triangles,
                                    const scene::Primitive& primitive,
                                    const std::vector<glm::vec3>& positions, uint32_t firstNode,
                                    uint32_t firstTriangle) const {
  for (glsl::RayNode node : builder_.nodes()) {
    for (int i = 0; i < 4; ++i) {
      const uint32_t child = node.child[i];
      if (child == glsl::ray_no_child) continue;
      node.child[i] = glsl::ray_is_leaf(child) ? child + firstTriangle : child + firstNode;
    }
    nodes.push_back(node);
  }
  for (const uint32_t triangle : builder_.order())
    for (size_t k = 0; k < 3; ++k)
      triangles.emplace_back(positions[primitive.indices[3 * size_t{triangle} + k]], 0.f);
}

RayGeometryService::Mesh RayGeometryService::addMesh(Parts& parts, const scene::Pose& pose, uint32_t draw) {
  const scene::DrawInstance& instance = pose.instances[draw];
  const Source& source = sources_[draw];
  const scene::Primitive& primitive = scene::primitiveOf(scene_, pose, instance);
  Mesh mesh;
  mesh.root = static_cast<uint32_t>(parts.nodes.size());
  mesh.firstTriangle = static_cast<uint32_t>(parts.triangles.size() / 3);
  mesh.triangles = triangleCount(primitive);
  mesh.capacity = source.dynamic ? capacityFor(mesh.triangles) : mesh.triangles;
  const scene::Material& material = scene::materialOf(scene_, instance);
  const bool masked = hasOwnMask(primitive, material);
  if (source.dynamic) {
    // Without a texture and colours a mask is open everywhere or nowhere, and takes no look-up.
    mesh.transparent = !masked && material.baseColour.a < material.alphaCutoff;
    mesh.built = pose.dynamic[static_cast<size_t>(instance.mesh)].primitive;
  }
  const bool flat = source.flat != scene::kNone;
  if (flat) mesh.place = instance.objectToWorld;
  if (mesh.triangles > 0) {
    std::vector<glm::vec3> moved, normals;
    std::vector<glm::vec4> tangents;
    const bool moves = source.deformed != scene::kNone;
    if (moves)
      scene::deform(primitive, pose.deformed[static_cast<size_t>(source.deformed)], moved, normals, tangents);
    if (flat) toWorld(primitive, mesh.place, moved);
    const std::vector<glm::vec3>& positions = moves || flat ? moved : primitive.positions;
    buildTree(primitive, positions);
    appendTree(parts.nodes, parts.triangles, primitive, positions, mesh.root, mesh.firstTriangle);
    meshStack_ = std::max(meshStack_, builder_.stack());
    if (!source.dynamic || masked) mesh.coverage = parts.coverage.add(primitive, material, builder_.order());
    if (moves) addMotion(parts, primitive, draw, mesh.root);
  }
  if (source.dynamic || flat) {
    parts.nodes.resize(mesh.root + mesh.capacity);
    parts.triangles.resize(3 * (size_t{mesh.firstTriangle} + mesh.capacity));
  }
  return mesh;
}

/// Records what passes need to follow the vertices of the hierarchy in builder_.
void RayGeometryService::addMotion(Parts& parts, const scene::Primitive& primitive, uint32_t draw,
                                   uint32_t firstNode) const {
  for (const uint32_t triangle : builder_.order()) {
    const uint32_t* vertex = &primitive.indices[3 * size_t{triangle}];
    parts.corners.push_back({.vertex = {vertex[0], vertex[1], vertex[2]}, .draw = draw});
  }
  const std::span<const uint32_t> levels = builder_.levels();
  const size_t count = levels.size() - 1;
  if (parts.refits.size() < count) parts.refits.resize(count);
  for (size_t level = 0; level < count; ++level)
    for (uint32_t node = levels[level]; node < levels[level + 1]; ++node)
      parts.refits[count - 1 - level].push_back(firstNode + node);
}

/// Brings primitives with new topology, and flat instances that moved, to the pose. Returns false where there
/// is no room for one.
bool RayGeometryService::rebuildMeshes(const scene::Pose& pose, bool& changed) {
  for (size_t draw = 0; draw < sources_.size(); ++draw) {
    const Source& source = sources_[draw];
    Mesh& mesh = meshes_[meshOf_[draw]];
    const scene::DrawInstance& instance = pose.instances[draw];
    const scene::Primitive& primitive = scene::primitiveOf(scene_, pose, instance);
    if (source.dynamic) {
      const std::shared_ptr<const scene::Primitive>& now =
          pose.dynamic[static_cast<size_t>(instance.mesh)].primitive;
      if (mesh.built == now) continue;
      // Masks lie in the order of the leaves: they are made with the whole.
      if (mesh.coverage != glsl::ray_opaque || hasOwnMask(primitive, scene::materialOf(scene_, instance)))
        return false;
      if (triangleCount(primitive) > mesh.capacity) return false;
      mesh.built = now;
      mesh.triangles = triangleCount(primitive);
    } else {
      if (source.flat == scene::kNone || mesh.place == instance.objectToWorld) continue;
      if (mesh.coverage != glsl::ray_opaque) return false;  // as above
      mesh.place = instance.objectToWorld;
      toWorld(primitive, mesh.place, inWorld_);
    }
    changed = true;
    if (mesh.triangles == 0) continue;
    const std::vector<glm::vec3>& positions = source.dynamic ? primitive.positions : inWorld_;
    buildTree(primitive, positions);
    if (builder_.stack() > meshStack_) return false;
    dynamicNodes_.clear();
    dynamicTriangles_.clear();
    appendTree(dynamicNodes_, dynamicTriangles_, primitive, positions, mesh.root, mesh.firstTriangle);
    nodeBuffer_.update(mesh.root * sizeof(glsl::RayNode), dynamicNodes_.data(),
                       dynamicNodes_.size() * sizeof(glsl::RayNode));
    triangleBuffer_.update(size_t{mesh.firstTriangle} * kTriangleBytes, dynamicTriangles_.data(),
                           dynamicTriangles_.size() * sizeof(glm::vec4));
  }
  return true;
}

}  // namespace limn::rays
