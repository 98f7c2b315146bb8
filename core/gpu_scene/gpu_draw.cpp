// Culling, draw lists and the draw calls of GpuScene.
#include <algorithm>
#include <bit>

#include "core/gpu_scene/gpu_scene_data.h"

namespace limn::scene {
namespace {

constexpr GLuint kPositionBinding = 0, kAttributeBinding = 1, kColourBinding = 2, kEntryBinding = 3;

void ensure(gpu::Device& device, gpu::Buffer& buffer, const char* label, size_t bytes) {
  if (!buffer || buffer.size() < bytes)
    buffer =
        gpu::Buffer(device, label, std::bit_ceil(std::max<size_t>(bytes, 1024)), gpu::BufferUse::updated);
}

/// The camera's side planes and the plane through the eye, from the rows of the clip matrix.
CullVolume cameraVolume(const glm::mat4& worldToClip) {
  const glm::mat4 rows = glm::transpose(worldToClip);
  CullVolume volume;
  volume.planes = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[3]};
  return volume;
}

/// Restores the clip convention that the rest of the frame expects, even when a draw throws.
class ReversedDepth {
 public:
  explicit ReversedDepth(const gl::Functions& gl) : gl_(gl) {
    gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_GREATER);
  }
  ~ReversedDepth() {
    gl_.ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    gl_.FrontFace(GL_CCW);
  }

 private:
  const gl::Functions& gl_;
};

}  // namespace

bool CullVolume::mayContain(const Bounds& box) const {
  if (box.empty()) return false;
  for (const glm::vec4& plane : planes) {
    const glm::vec3 n(plane);
    const glm::vec3 farthest(n.x >= 0 ? box.high.x : box.low.x, n.y >= 0 ? box.high.y : box.low.y,
                             n.z >= 0 ? box.high.z : box.low.z);
    if (glm::dot(n, farthest) + plane.w < 0) return false;
  }
  return true;
}

DrawList::DrawList() : implementation_(std::make_unique<Implementation>()) {}
DrawList::~DrawList() = default;
DrawList::DrawList(DrawList&&) noexcept = default;
DrawList& DrawList::operator=(DrawList&&) noexcept = default;
uint64_t DrawList::triangles() const {
  return implementation_->triangles;
}

void DrawList::Implementation::clear() {
  entries.clear();
  commands.clear();
  runs.clear();
  viewRuns.clear();
  triangles = 0;
}

void DrawList::Implementation::upload(gpu::Device& device) {
  for (const DrawCommand& c : commands) triangles += uint64_t{c.count / 3} * c.instanceCount;
  // Most frames draw what the one before them drew, and may still be drawing it.
  if (commands.empty() || (entries == uploadedEntries && commands == uploadedCommands)) return;
  uploadedEntries.clear();  // should there be no memory for larger buffers
  uploadedCommands.clear();
  const size_t entryBytes = entries.size() * sizeof(entries[0]),
               commandBytes = commands.size() * sizeof(DrawCommand);
  ensure(device, entryBuffer, "draw entries", entryBytes);
  ensure(device, commandBuffer, "draw commands", commandBytes);
  entryBuffer.update(0, entries.data(), entryBytes);
  commandBuffer.update(0, commands.data(), commandBytes);
  entries.swap(uploadedEntries);
  commands.swap(uploadedCommands);
}

/// Appends what the views see, in `order`: one command per primitive, one run per state.
void GpuScene::Implementation::fill(DrawList::Implementation& list, const std::vector<uint32_t>& order,
                                    std::span<const DepthView> views, bool depthOnly) const {
  list.viewRuns.push_back(static_cast<uint32_t>(list.runs.size()));
  uint32_t primitive = ~0u;
  DrawRun state;
  bool started = false;
  for (const uint32_t id : order) {
    const InstanceState& instance = states[id];
    for (const DepthView& view : views) {
      if (id == view.skipInstance || instance.bounds.empty()) continue;
      const Surfaces kind = materials.specular(instance.material) ? Surfaces::specular : Surfaces::matte;
      if (view.surfaces != Surfaces::all && view.surfaces != kind) continue;
      if (culling && !view.volume.mayContain(instance.bounds)) continue;
      DrawRun wanted;
      wanted.material = instance.material;
      wanted.masked = materials.masked(instance.material);
      if (!depthOnly) {
        wanted.mirrored = instance.mirrored;
        wanted.doubleSided = materials.doubleSided(instance.material);
      }
      const auto key = [&](const DrawRun& run) {
        if (!depthOnly) return static_cast<uint32_t>(run.material);
        return run.masked ? materials.baseColourKey(run.material) : 0u;
      };
      const bool sameRun = started && key(wanted) == key(state) && wanted.masked == state.masked &&
                           wanted.mirrored == state.mirrored && wanted.doubleSided == state.doubleSided;
      if (!sameRun) {
        wanted.firstCommand = static_cast<uint32_t>(list.commands.size());
        list.runs.push_back(wanted);
        state = wanted;
      }
      if (!sameRun || primitive != instance.primitive) {
        list.commands.push_back({instance.range.indexCount, 0, instance.range.firstIndex,
                                 static_cast<int32_t>(instance.range.firstVertex),
                                 static_cast<uint32_t>(list.entries.size())});
        ++list.runs.back().commandCount;
        primitive = instance.primitive;
      }
      started = true;
      list.entries.emplace_back(id, view.view);
      ++list.commands.back().instanceCount;
    }
  }
}

void GpuScene::Implementation::bindVertices(const gpu::Buffer& entries) const {
  const gl::Functions& gl = device.gl();
  const GLuint array = vertexArray.id();
  gl.VertexArrayVertexBuffer(array, kPositionBinding, geometry.positions().id(), 0, 12);
  gl.VertexArrayVertexBuffer(array, kAttributeBinding, geometry.attributes().id(), 0, 16);
  if (geometry.hasColours()) gl.VertexArrayVertexBuffer(array, kColourBinding, geometry.colours().id(), 0, 8);
  gl.VertexArrayVertexBuffer(array, kEntryBinding, entries.id(), 0, sizeof(glm::uvec2));
  gl.VertexArrayBindingDivisor(array, kEntryBinding, 1);
  gl.VertexArrayElementBuffer(array, geometry.indices().id());
  gl.BindVertexArray(array);
  if (!geometry.hasColours()) gl.VertexAttrib4f(4, 1, 1, 1, 1);
}

/// All views together (`layered`) or one after the other, and to the GPU.
void GpuScene::Implementation::fillViews(DrawList::Implementation& list, const std::vector<uint32_t>& order,
                                         std::span<const DepthView> views, bool layered,
                                         bool depthOnly) const {
  list.clear();
  if (layered) {
    fill(list, order, views, depthOnly);
  } else {
    for (const DepthView& view : views) fill(list, order, {&view, 1}, depthOnly);
  }
  list.viewRuns.push_back(static_cast<uint32_t>(list.runs.size()));
  list.upload(device);
}

/// The vertices and the commands of a list.
void GpuScene::Implementation::bindDraws(const DrawList::Implementation& list) const {
  bindVertices(list.entryBuffer);
  device.gl().BindBuffer(GL_DRAW_INDIRECT_BUFFER, list.commandBuffer.id());
}

gpu::Program& GpuScene::Implementation::beginSurfaceRun(const frame::PassContext& context,
                                                        const SurfacePrograms& programs,
                                                        const DrawRun& run) const {
  gpu::Program& program = context.use(programs.variants.at(materials.variant(run.material)));
  if (programs.materials) materials.bind(context, programs, run.material);
  device.gl().FrontFace(run.mirrored ? GL_CW : GL_CCW);
  return program;
}

void GpuScene::Implementation::drawRun(const DrawRun& run) const {
  const size_t offset = run.firstCommand * sizeof(DrawCommand);
  device.gl().MultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, reinterpret_cast<const void*>(offset),
                                        static_cast<GLsizei>(run.commandCount), sizeof(DrawCommand));
}

void GpuScene::drawGBuffer(const frame::PassContext& context, const SurfacePrograms& programs,
                           Surfaces surfaces, DrawList& list) {
  Implementation& scene = *implementation_;
  const gl::Functions& gl = scene.device.gl();
  DrawList::Implementation& draws = *list.implementation_;
  draws.clear();
  const DepthView view{.volume = cameraVolume(scene.frame.world_to_clip), .surfaces = surfaces};
  scene.fill(draws, scene.cameraOrder, {&view, 1}, false);
  draws.upload(scene.device);
  if (draws.runs.empty()) return;

  context.countTriangles(draws.triangles);
  scene.bindDraws(draws);
  const ReversedDepth reversed(gl);
  gl.CullFace(GL_BACK);
  for (const DrawRun& run : draws.runs) {
    gpu::Program& program = scene.beginSurfaceRun(context, programs, run);
    program.set("near_plane", scene.nearPlane);
    (run.doubleSided ? gl.Disable : gl.Enable)(GL_CULL_FACE);
    scene.drawRun(run);
  }
}

void GpuScene::drawSurfaces(const frame::PassContext& context, const SurfacePrograms& programs,
                            std::span<const DepthView> views, DrawList& list, bool layered,
                            const std::function<void(const DepthView&)>& beginView) {
  Implementation& scene = *implementation_;
  const gl::Functions& gl = scene.device.gl();
  DrawList::Implementation& draws = *list.implementation_;
  scene.fillViews(draws, scene.cameraOrder, views, layered, false);
  if (draws.runs.empty()) return;

  context.countTriangles(draws.triangles);
  scene.bindDraws(draws);
  const ReversedDepth reversed(gl);
  gl.Disable(GL_CULL_FACE);
  draws.forEachRun([&](const DrawRun& run, size_t part, bool first) {
    if (first && !layered) beginView(views[part]);
    scene.beginSurfaceRun(context, programs, run);
    scene.drawRun(run);
  });
}

void GpuScene::drawDepth(const frame::PassContext& context, const DrawPrograms& programs,
                         std::span<const DepthView> views, DrawList& list, bool layered,
                         const std::function<void(const DepthView&)>& beginView) {
  Implementation& scene = *implementation_;
  const gl::Functions& gl = scene.device.gl();
  DrawList::Implementation& draws = *list.implementation_;
  scene.fillViews(draws, scene.depthOrder, views, layered, true);
  if (draws.runs.empty()) return;

  context.countTriangles(draws.triangles);
  scene.bindDraws(draws);
  const ReversedDepth reversed(gl);
  gl.Disable(GL_CULL_FACE);
  draws.forEachRun([&](const DrawRun& run, size_t part, bool first) {
    if (first && !layered) beginView(views[part]);
    context.use(run.masked ? programs.masked : programs.opaque);
    if (run.masked) scene.materials.bindBaseColour(context, programs.baseColour, run.material);
    scene.drawRun(run);
  });
}

}  // namespace limn::scene
