#include "core/rays/ray_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/error.h"
#include "core/base/same_bytes.h"
#include "core/scene/draw_instance.h"
#include "core/scene/instance_areas.h"

namespace limn::rays {

using frame::Access;

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

/// What a matrix leaves of a body.
enum class Extent : uint8_t {
  thin,  ///< a line or a point
  flat,
  solid
};

Extent extentOf(const glm::mat4& objectToWorld) {
  // Shares of the length. Floats round by 6e-8 of it, which the inverse of a body as high as this turns into
  // 0.6 % of its other sides.
  constexpr double kLeastWidth = 1e-7, kLeastHeight = 1e-5;
  const glm::dmat3 m{glm::dmat4(objectToWorld)};
  const double length2 = glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
  const double area = glm::length(scene::areaFactors(objectToWorld));
  if (!(area > kLeastWidth * length2)) return Extent::thin;
  const double volume = std::abs(glm::determinant(m));
  return volume > kLeastHeight * area * std::sqrt(length2) ? Extent::solid : Extent::flat;
}

/// Sets the rows of the matrix into the instance's space; false where floats hold none.
bool invert(const glm::mat4& objectToWorld, glsl::RayBody& body) {
  if (extentOf(objectToWorld) != Extent::solid) return false;
  const glm::dmat4 inverse = glm::inverse(glm::dmat4(objectToWorld));
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      if (!std::isfinite(static_cast<float>(inverse[column][row]))) return false;
  const glm::dmat3 rows = glm::transpose(glm::dmat3(inverse));
  const glm::vec3 shift(inverse[3]);
  body.row_x = rows[0];
  body.row_y = rows[1];
  body.row_z = rows[2];
  body.shift_x = shift.x;
  body.shift_y = shift.y;
  body.shift_z = shift.z;
  return true;
}

void toWorld(const scene::Primitive& primitive, const glm::mat4& place, std::vector<glm::vec3>& positions) {
  positions.clear();
  for (const glm::vec3& p : primitive.positions) positions.emplace_back(place * glm::vec4(p, 1));
}

}  // namespace

void RayGeometry::declare(frame::PassBuilder& pass) const {
  pass.read(nodes, Access::storageLoad, "RayNodes", "boxes that rays walk through")
      .read(triangles, Access::storageLoad, "RayTriangles", "what rays meet")
      .read(bodies, Access::storageLoad, "RayBodies", "where the instances are");
  if (coverage) pass.read(coverage, Access::storageLoad, "RayCoverage", "alpha masks");
}

void RayGeometry::define(std::map<std::string, std::string>& defines) const {
  defines["RAY_STACK"] = std::to_string(stack);
  defines["RAY_COVERAGE"] = coverage ? "1" : "0";
}

RayGeometryService::RayGeometryService(gpu::Device& device, const scene::Scene& scene)
    : device_(device), scene_(scene) {}
RayGeometryService::~RayGeometryService() = default;

void RayGeometryService::begin() {
  if (!requested_ &&
      built_) {  // the last graph did without: it would count in the memory of other techniques
    built_ = false;
    for (gpu::Buffer* buffer :
         {&nodeBuffer_, &triangleBuffer_, &bodyBuffer_, &coverageBuffer_, &cornerBuffer_, &refitBuffer_})
      *buffer = gpu::Buffer();
  }
  requested_ = false;
}

const RayGeometry& RayGeometryService::request() {
  const FrameContext& building = context();
  if (requested_) return geometry_;
  bool changed = false;
  if (!fits(building.pose) || !rebuildMeshes(building.pose, changed)) build(building.pose);
  placeBodies(building.pose);
  importedNodes_ = building.graph.importBuffer("ray nodes", nodeBuffer_);
  importedTriangles_ = building.graph.importBuffer("ray triangles", triangleBuffer_);
  geometry_ = {.nodes = importedNodes_,
               .triangles = importedTriangles_,
               .bodies = building.graph.importBuffer("ray bodies", bodyBuffer_),
               .coverage = {},
               .stack = 8 * ((medianStack(static_cast<uint32_t>(sources_.size())) + meshStack_ + 8) / 8)};
  if (masked_) geometry_.coverage = building.graph.importBuffer("ray coverage", coverageBuffer_);
  if (moving_ > 0) addRefits(building);
  requested_ = true;
  return geometry_;
}

bool RayGeometryService::update(frame::FrameGraph& graph, const scene::Pose& pose) {
  if (!requested_) return false;
  bool changed = false;
  if (!fits(pose) || !rebuildMeshes(pose, changed)) {
    built_ = false;
    return true;
  }
  if (changed) graph.touch(importedTriangles_);
  if (placeBodies(pose)) {
    graph.touch(geometry_.bodies);
    changed = true;
  }
  if (changed) graph.touch(importedNodes_);
  return false;
}

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
  if (source.dynamic) {
    // It has no texture coordinates: its mask is open everywhere or nowhere.
    const scene::Material& material = scene::materialOf(scene_, instance);
    mesh.transparent = material.baseColour.a < material.alphaCutoff;
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
    if (!source.dynamic)
      mesh.coverage = parts.coverage.add(primitive, scene::materialOf(scene_, instance), builder_.order());
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
      if (triangleCount(primitive) > mesh.capacity) return false;
      mesh.built = now;
      mesh.triangles = triangleCount(primitive);
    } else {
      if (source.flat == scene::kNone || mesh.place == instance.objectToWorld) continue;
      if (mesh.coverage != glsl::ray_opaque) return false;  // masks lie in the order of the leaves
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

/// Brings the instances to the pose. Returns whether any of them moved.
bool RayGeometryService::placeBodies(const scene::Pose& pose) {
  const bool rigid = moving_ == 0 && pose.dynamic.empty();
  if (rigid && !bodies_.empty() &&
      std::ranges::equal(pose.instances, matrices_, {}, &scene::DrawInstance::objectToWorld))
    return false;
  nextBodies_.resize(sources_.size());
  boxes_.clear();
  placed_.clear();
  for (uint32_t draw = 0; draw < sources_.size(); ++draw) {
    const scene::DrawInstance& instance = pose.instances[draw];
    const Mesh& mesh = meshes_[meshOf_[draw]];
    matrices_[draw] = instance.objectToWorld;
    glsl::RayBody& body = nextBodies_[draw];
    body = {};
    body.root = mesh.root;
    body.coverage = mesh.coverage;
    body.first_triangle = mesh.firstTriangle;
    const bool flat = sources_[draw].flat != scene::kNone;
    if (mesh.triangles == 0 || mesh.transparent ||
        !invert(flat ? glm::mat4(1) : instance.objectToWorld, body))
      continue;
    const scene::Bounds bounds = scene::instanceBounds(scene_, pose, instance);
    boxes_.push_back(glsl::ray_box_grown({bounds.low, bounds.high}));
    placed_.push_back(draw);
  }
  if (sameBytes(bodies_, nextBodies_) && sameBytes(topBoxes_, boxes_)) return false;
  bodies_ = nextBodies_;
  topBoxes_ = boxes_;
  top_.clear();
  if (placed_.empty()) {
    top_.push_back(glsl::ray_node_around({glm::vec3(0), glm::vec3(0)}));
  } else {
    builder_.build(boxes_, 1, Split::median);
    for (glsl::RayNode node : builder_.nodes()) {
      for (int i = 0; i < 4; ++i) {
        const uint32_t child = node.child[i];
        if (child != glsl::ray_no_child && glsl::ray_is_leaf(child))
          node.child[i] = glsl::ray_leaf(placed_[builder_.order()[glsl::ray_leaf_first(child)]], 1);
      }
      top_.push_back(node);
    }
  }
  nodeBuffer_.update(0, top_.data(), top_.size() * sizeof(glsl::RayNode));
  bodyBuffer_.update(0, bodies_.data(), bodies_.size() * sizeof(glsl::RayBody));
  return true;
}

/// Declares the passes that follow vertices which the scene deforms on the GPU.
void RayGeometryService::addRefits(const FrameContext& building) {
  frame::PassBuilder fetch = building.graph.addPass("ray triangles");
  fetch.role(frame::PassRole::technique)
      .read(building.handles.geometry, Access::storageLoad, "Positions", "deformed vertices")
      .read(building.handles.instances, Access::storageLoad, "Instances", "where vertices lie")
      .constant("MovingCorners", cornerBuffer_)
      .cacheable();
  geometry_.triangles = fetch.write(geometry_.triangles, Access::storageLoadStore, "RayTriangles",
                                    "deformed triangles, beside those at rest");
  const frame::ProgramHandle fetcher =
      fetch.program({.files = {"glsl/rays/moving_triangles.comp.glsl"}, .defines = {}});
  fetch.execute([fetcher, first = firstMoving_, count = moving_](frame::PassContext& context) {
    gpu::Program& kernel = context.use(fetcher);
    kernel.set("first_triangle", first);
    kernel.set("triangles", count);
    context.dispatchRows((count + 63) / 64);
  });
  uint32_t firstNode = 0;
  for (const uint32_t count : refitCounts_) {
    frame::PassBuilder refit = building.graph.addPass("refit");
    refit.role(frame::PassRole::technique)
        .read(geometry_.triangles, Access::storageLoad, "RayTriangles", "what leaves hold")
        .constant("RefitNodes", refitBuffer_)
        .cacheable();
    geometry_.nodes =
        refit.write(geometry_.nodes, Access::storageLoadStore, "RayNodes", "boxes of the next level");
    const frame::ProgramHandle refitter =
        refit.program({.files = {"glsl/rays/refit.comp.glsl"}, .defines = {}});
    refit.execute([refitter, firstNode, count](frame::PassContext& context) {
      gpu::Program& kernel = context.use(refitter);
      kernel.set("first_node", firstNode);
      kernel.set("node_count", count);
      context.dispatchRows((count + 63) / 64);
    });
    firstNode += count;
  }
}

}  // namespace limn::rays
