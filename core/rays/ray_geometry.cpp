#include "core/rays/ray_geometry.h"

#include <algorithm>

#include "core/base/same_bytes.h"
#include "core/rays/private/body_space.h"

namespace limn::rays {

using frame::Access;

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
