#include "core/history/frame_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "glsl/history/history_frame.glsl"

namespace limn::history {
namespace {

using frame::Access;

constexpr int kGroup = 8;

glsl::HistoryFrame viewOf(const glsl::FrameBlock& frame) {
  return {.world_to_clip = frame.world_to_clip,
          .camera_position = frame.camera_position,
          .view_ray_origin = frame.view_ray_origin,
          .view_ray_dx = frame.view_ray_dx,
          .view_ray_dy = frame.view_ray_dy,
          .slot = 0,
          .still = 0,
          .age = 0,
          .moved = 0};
}

/// Whether each pixel looks the same way in both. What a scene's bounds change, the depths that clip space
/// holds, is no part of it.
bool seenAlike(const glsl::HistoryFrame& a, const glsl::HistoryFrame& b) {
  return a.camera_position == b.camera_position && a.view_ray_origin == b.view_ray_origin &&
         a.view_ray_dx == b.view_ray_dx && a.view_ray_dy == b.view_ray_dy;
}

std::vector<glm::mat4> placesOf(const scene::Pose& pose) {
  std::vector<glm::mat4> places;
  places.reserve(pose.instances.size());
  for (const scene::DrawInstance& drawn : pose.instances) places.push_back(drawn.objectToWorld);
  return places;
}

}  // namespace

/// Holds the last frames of one term.
struct FrameHistoryService::Kept {
  /// What a slot holds.
  struct Slot {
    uint32_t frame = 0;   ///< its index
    uint32_t placed = 0;  ///< that of the first frame with the instances where they were
    glsl::HistoryFrame view{};
  };
  int frames = 0, parts = 0;
  /// Animations, geometry or joints, of which instances say nothing, may: what a still camera sees may be
  /// another surface.
  bool moves = false;
  std::array<std::optional<Slot>, kMostFrames> slots;
  std::array<glsl::HistoryFrame, kMostFrames> found{};  ///< those before this frame, the oldest first
  int count = 0;
  gpu::Texture light, surfaces;
  gpu::Buffer views, instances;

  int slotOf(uint32_t frame) const { return static_cast<int>(frame % static_cast<uint32_t>(frames)); }
  void find(const glsl::FrameBlock& now, uint32_t placed);
};

/// Frames that were cancelled have left nothing, so that slots may hold older ones. placed: index of the
/// first frame with the instances where they are now.
void FrameHistoryService::Kept::find(const glsl::FrameBlock& now, uint32_t placed) {
  count = 0;
  const glsl::HistoryFrame view = viewOf(now);
  for (uint32_t age = std::min(static_cast<uint32_t>(frames), now.frame_index); age > 0; --age) {
    const int slot = slotOf(now.frame_index - age);
    const std::optional<Slot>& held = slots.at(static_cast<size_t>(slot));
    if (!held || held->frame != now.frame_index - age) continue;
    const bool still = seenAlike(held->view, view);
    glsl::HistoryFrame& before = found.at(static_cast<size_t>(count++));
    before = held->view;
    before.slot = static_cast<uint32_t>(slot);
    before.still = still ? 1 : 0;
    before.age = age;
    before.moved = (moves || held->frame < placed) ? 1 : 0;
  }
  if (count > 0) views.update(0, found.data(), static_cast<size_t>(count) * sizeof(found[0]));
}

FrameHistoryService::FrameHistoryService(scene::GpuScene& scene) : scene_(scene) {}
FrameHistoryService::~FrameHistoryService() = default;

void FrameHistoryService::begin() {
  kept_.clear();
  places_ = placesOf(context().pose);
  placed_ = 0;
}

bool FrameHistoryService::update(frame::FrameGraph&, const scene::Pose& pose) {
  if (kept_.empty()) return false;
  if (!std::ranges::equal(pose.instances, places_, {}, &scene::DrawInstance::objectToWorld)) {
    places_ = placesOf(pose);
    placed_ = scene_.frame().frame_index;
  }
  for (const std::unique_ptr<Kept>& kept : kept_) kept->find(scene_.frame(), placed_);
  return false;
}

frame::TextureHandle FrameHistoryService::average(const GBuffer& gbuffer, frame::TextureHandle light,
                                                  int frames, std::string_view technique) {
  frame::FrameGraph& graph = context().graph;
  const SceneHandles& handles = context().handles;
  gpu::Device& device = scene_.device();
  if (frames < 2 || frames > kMostFrames)
    throw Error(fmt::format("history of {} frames: accepted are 2 to {}", frames, kMostFrames));
  const auto instanceCount = static_cast<int>(scene_.instanceCount());
  const size_t instanceBytes = static_cast<size_t>(instanceCount) * sizeof(glsl::Instance);
  const auto bytes = static_cast<int64_t>(static_cast<size_t>(frames) * instanceBytes);
  if (bytes > device.limits().maxStorageBlockBytes)
    throw UsageError(fmt::format(
        "history of {} frames: the places of {} instances take {} MiB, more than the {} MiB of a storage "
        "buffer; ask for fewer frames",
        frames, instanceCount, bytes >> 20, device.limits().maxStorageBlockBytes >> 20));
  Kept& kept = *kept_.emplace_back(std::make_unique<Kept>());
  gpu::TextureDesc desc = graph.desc(light);
  const glm::ivec2 size(desc.width, desc.height);
  kept.frames = frames;
  kept.parts = desc.layers;
  kept.moves = !scene_.scene().animations.empty() || !scene_.scene().dynamic.empty() ||
               !context().pose.deformed.empty();
  desc.layers *= frames;
  kept.light = gpu::Texture(device, "light of frames", desc);
  desc.layers = frames;
  desc.format = GL_RG32UI;
  kept.surfaces = gpu::Texture(device, "surfaces of frames", desc);
  kept.views = gpu::Buffer(device, "views of frames", sizeof(kept.found), gpu::BufferUse::updated);
  const frame::TextureHandle keptLight = graph.importTexture("light of frames", kept.light);
  const frame::TextureHandle keptSurfaces = graph.importTexture("surfaces of frames", kept.surfaces);
  kept.instances = gpu::Buffer(device, "instances of frames", static_cast<size_t>(bytes));
  const frame::BufferHandle keptInstances = graph.importBuffer("instances of frames", kept.instances);
  const std::string parts = std::to_string(kept.parts);

  frame::PassBuilder average = graph.addPass("average frames", technique);
  average.read(handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(light, Access::sampled, "light", "of this frame")
      .read(keptLight, Access::sampled, "history_light", "of frames before")
      .read(keptSurfaces, Access::sampled, "history_surfaces", "whether they show the same surface")
      .read(gbuffer.depth, Access::sampled, kGBufferNames.depth, "what is seen now")
      .read(gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal, "its plane")
      .read(gbuffer.instance, Access::sampled, kGBufferNames.instance, "whose it is")
      .read(handles.instances, Access::storageLoad, "Instances", "where it is")
      .read(keptInstances, Access::storageLoad, "InstancesBefore", "where it was")
      .constant("HistoryFrames", kept.views);
  const frame::TextureHandle result = average.write(graph.createTexture("averaged", graph.desc(light)),
                                                    Access::imageStore, "averaged", "sums over frames");
  const auto averaging =
      average.program({.files = {"glsl/history/average.comp.glsl"}, .defines = {{"PARTS", parts}}});
  average.execute([averaging, size, instanceCount, &kept](frame::PassContext& context) {
    gpu::Program& kernel = context.use(averaging);
    kernel.set("frame_count", kept.count);
    kernel.set("frames_kept", kept.frames);
    kernel.set("instance_count", instanceCount);
    context.dispatch(size.x, size.y, 1, kGroup, kGroup);
    kept.count = 0;  // a graph that runs again without update() knows none
  });

  frame::PassBuilder keep = graph.addPass("keep frame", technique);
  keep.read(handles.frame, Access::uniformBuffer, "FrameBlock", "size of the screen")
      .read(light, Access::sampled, "light", "of this frame")
      .read(gbuffer.depth, Access::sampled, kGBufferNames.depth, "what it fell on")
      .read(gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal, "its plane")
      .read(gbuffer.instance, Access::sampled, kGBufferNames.instance, "whose it is")
      .read(handles.instances, Access::copySource, "where instances are")
      .sideEffect();
  (void)keep.write(keptLight, Access::imageLoadStore, "history_light", "for frames after this one");
  (void)keep.write(keptSurfaces, Access::imageLoadStore, "history_surfaces", "the same");
  const frame::BufferHandle copied = keep.write(keptInstances, Access::copyTarget, "the same");
  const auto keeping =
      keep.program({.files = {"glsl/history/keep.comp.glsl"}, .defines = {{"PARTS", parts}}});
  keep.execute([=, this, &kept, from = handles.instances](frame::PassContext& context) {
    const glsl::FrameBlock& now = scene_.frame();
    const int slot = kept.slotOf(now.frame_index);
    context.use(keeping).set("slot", slot);
    context.dispatch(size.x, size.y, 1, kGroup, kGroup);
    std::optional<Kept::Slot>& held = kept.slots.at(static_cast<size_t>(slot));
    if (!held || held->placed != placed_)  // else the slot has them where they are
      context.gl().CopyNamedBufferSubData(context.buffer(from).id(), context.buffer(copied).id(), 0,
                                          static_cast<GLintptr>(static_cast<size_t>(slot) * instanceBytes),
                                          static_cast<GLsizeiptr>(instanceBytes));
    held = {now.frame_index, placed_, viewOf(now)};
  });
  return result;
}

}  // namespace limn::history
