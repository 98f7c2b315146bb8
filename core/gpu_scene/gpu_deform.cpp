#include "core/gpu_scene/gpu_deform.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace limn::scene {
namespace {

constexpr uint32_t kSkinWords = 6;    // 4 x 16-bit joints, 4 float weights
constexpr uint32_t kMorphFloats = 9;  // deltas of position, normal, tangent
constexpr int kVerticesPerGroup = 64;

/// Rewrites a buffer, growing it to the next power of two when it must. Throws UsageError for more than a
/// storage block.
void store(gpu::Device& device, gpu::Buffer& buffer, const char* label, const void* data, size_t bytes) {
  checkStorageBlock(device, label, bytes);
  if (!buffer || buffer.size() < bytes)
    buffer = gpu::Buffer(device, label, std::bit_ceil(std::max<size_t>(bytes, 64)), gpu::BufferUse::updated);
  buffer.update(0, data, bytes);
}

/// Throws before memory is taken.
void checkSizes(const gpu::Device& device, const Scene& scene) {
  size_t skin = 0, morph = 0;
  for (const Mesh& mesh : scene.meshes) {
    for (const Primitive& primitive : mesh.primitives) {
      skin += primitive.joints.size() * kSkinWords;
      morph += primitive.morphTargets.size() * primitive.positions.size() * kMorphFloats;
    }
  }
  checkStorageBlock(device, "joints and weights of skins", skin * sizeof(uint32_t));
  checkStorageBlock(device, "morph targets", morph * sizeof(float));
}

void append(std::vector<float>& out, const std::vector<glm::vec3>& deltas, size_t i) {
  const glm::vec3 d = i < deltas.size() ? deltas[i] : glm::vec3(0);
  out.insert(out.end(), {d.x, d.y, d.z});
}

}  // namespace

GpuDeform::GpuDeform(gpu::Device& device, const Scene& scene) : device_(device) {
  checkSizes(device, scene);
  std::vector<uint32_t> skin;
  std::vector<float> morph;
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    for (size_t p = 0; p < scene.meshes[m].primitives.size(); ++p) {
      const Primitive& primitive = scene.meshes[m].primitives[p];
      if (primitive.joints.empty() && primitive.morphTargets.empty()) continue;
      addRest(primitive, rest_[{static_cast<int>(m), static_cast<int>(p)}], skin, morph);
    }
  }
  if (rest_.empty()) return;
  skin_ = gpu::Buffer::of<uint32_t>(device, "skin weights", skin);
  morph_ = gpu::Buffer::of<float>(device, "morph targets", morph);
}

void GpuDeform::addRest(const Primitive& primitive, Rest& rest, std::vector<uint32_t>& skin,
                        std::vector<float>& morph) {
  const size_t count = primitive.positions.size();
  if (!primitive.joints.empty()) {
    rest.skin = static_cast<uint32_t>(skin.size());
    for (size_t i = 0; i < count; ++i) {
      const glm::u16vec4 j = primitive.joints[i];
      const glm::vec4 w = primitive.weights[i];
      skin.push_back(uint32_t{j.x} | uint32_t{j.y} << 16);
      skin.push_back(uint32_t{j.z} | uint32_t{j.w} << 16);
      for (int k = 0; k < 4; ++k) skin.push_back(std::bit_cast<uint32_t>(w[k]));
    }
  }
  rest.targets = static_cast<uint32_t>(primitive.morphTargets.size());
  rest.morph = static_cast<uint32_t>(morph.size());
  for (const MorphTarget& target : primitive.morphTargets) {
    for (size_t i = 0; i < count; ++i) {
      append(morph, target.positions, i);
      append(morph, target.normals, i);
      append(morph, target.tangents, i);
    }
  }
}

bool GpuDeform::update(const Pose& pose, const GpuGeometry& geometry,
                       const std::vector<GeometryRange>& targets) {
  nextJobs_.clear();
  nextJoints_.clear();
  nextWeights_.clear();
  for (size_t i = 0; i < pose.deformed.size(); ++i) {
    const Deformation& d = pose.deformed[i];
    const Rest& rest = rest_.at({d.mesh, d.primitive});
    const GeometryRange& source = geometry.primitive(d.mesh, d.primitive);
    Job& job = nextJobs_.emplace_back();
    job.first_rest = source.firstVertex;
    job.first_deformed = targets[i].firstVertex;
    job.vertices = source.vertexCount;
    job.skin = d.joints.empty() ? ~0u : rest.skin;
    job.first_joint = static_cast<uint32_t>(nextJoints_.size());
    job.first_weight = static_cast<uint32_t>(nextWeights_.size());
    job.targets = std::min(rest.targets, static_cast<uint32_t>(d.morphWeights.size()));
    job.deltas = rest.morph;
    nextJoints_.insert(nextJoints_.end(), d.joints.begin(), d.joints.end());
    nextWeights_.insert(nextWeights_.end(), d.morphWeights.begin(), d.morphWeights.end());
  }
  if (nextJobs_ == jobs_ && nextWeights_ == weights_ && nextJoints_ == joints_) return false;
  static_assert(sizeof(Job) == 32);
  store(device_, jobBuffer_, "deform jobs", nextJobs_.data(), nextJobs_.size() * sizeof(Job));
  store(device_, jointBuffer_, "joint matrices", nextJoints_.data(), nextJoints_.size() * sizeof(glm::mat4));
  store(device_, weightBuffer_, "morph weights", nextWeights_.data(), nextWeights_.size() * sizeof(float));
  jobs_.swap(nextJobs_);  // last: where there is no memory, the next frame stores them
  joints_.swap(nextJoints_);
  weights_.swap(nextWeights_);
  return true;
}

frame::BufferHandle GpuDeform::addPass(frame::FrameGraph& graph, const GpuGeometry& streams,
                                       frame::BufferHandle geometry) {
  if (jobs_.empty()) {
    forget();
    graph.leaveOut("deform", "core", "nothing is skinned or morphed");
    return geometry;
  }
  jobHandle_ = graph.importBuffer("deform jobs", jobBuffer_);
  jointHandle_ = graph.importBuffer("joint matrices", jointBuffer_);
  weightHandle_ = graph.importBuffer("morph weights", weightBuffer_);
  frame::PassBuilder builder = graph.addPass("deform");
  builder.read(jobHandle_, frame::Access::storageLoad, "Jobs", "which vertices to deform")
      .read(jointHandle_, frame::Access::storageLoad, "Joints", "skin")
      .read(weightHandle_, frame::Access::storageLoad, "Weights", "morph weights")
      .constant("Attributes", streams.attributes())
      .constant("Skin", skin_)
      .constant("Morph", morph_)
      .read(geometry, frame::Access::storageLoad, "vertices at rest");
  const frame::ProgramHandle program =
      builder.program({.files = {"glsl/geometry/deform.comp.glsl"}, .defines = {}});
  const frame::BufferHandle deformed = builder.write(geometry, frame::Access::storageStore, "Positions",
                                                     "deformed vertices, beside those at rest");
  builder.cacheable().execute([this, program](frame::PassContext& context) {
    gpu::Program& deform = context.use(program);
    for (size_t job = 0; job < jobs_.size(); ++job) {
      deform.set("job_index", static_cast<unsigned>(job));
      context.dispatchRows((int64_t{jobs_[job].vertices} + kVerticesPerGroup - 1) / kVerticesPerGroup);
    }
  });
  return deformed;
}

void GpuDeform::touch(frame::FrameGraph& graph) const {
  for (const frame::BufferHandle handle : {jobHandle_, jointHandle_, weightHandle_}) {
    if (handle) graph.touch(handle);
  }
}

void GpuDeform::forget() {
  jobHandle_ = jointHandle_ = weightHandle_ = {};
}

}  // namespace limn::scene
