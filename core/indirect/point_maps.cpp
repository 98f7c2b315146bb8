#include "core/indirect/point_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace limn::indirect {
namespace {

using frame::Access;
using frame::BufferHandle;

constexpr int kFillTile = 64;  // texels per side of what a work group fills
constexpr int kCopied = 16;    // the same where nothing is filled
constexpr int kWindows = 16;   // the pool of points holds as many times what one map takes

size_t depthBytes(const PointMapDesc& desc) {
  return sizeof(float) * static_cast<size_t>(desc.size) * static_cast<size_t>(desc.size) *
         static_cast<size_t>(desc.count);
}

frame::PassBuilder passOf(frame::FrameGraph& graph, std::string_view name, const PointMapDesc& desc) {
  frame::PassBuilder pass = graph.addPass(name, desc.technique);
  if (desc.cacheable) pass.cacheable();
  return pass;
}

BufferHandle clear(frame::FrameGraph& graph, const PointMapDesc& desc) {
  frame::PassBuilder pass = passOf(graph, "clear maps", desc);
  const size_t bytes = depthBytes(desc);
  const BufferHandle depths =
      pass.write(graph.createBuffer("splatted depths", {bytes}), Access::copyTarget, "nothing is there");
  pass.execute([=](frame::PassContext& context) {
    constexpr GLfloat nothing = 1;
    context.gl().ClearNamedBufferSubData(context.buffer(depths).id(), GL_R32F, 0,
                                         static_cast<GLsizeiptr>(bytes), GL_RED, GL_FLOAT, &nothing);
  });
  return depths;
}

frame::TextureHandle fillHoles(frame::FrameGraph& graph, const PointMapDesc& desc, BufferHandle depths) {
  const int tile = std::min(desc.size, kFillTile);
  int room = tile * tile;
  for (int level = 1, side = tile; level <= desc.fillLevels; ++level) {
    side = (side + 1) / 2;
    room += side * side;
  }
  frame::PassBuilder pass = passOf(graph, "fill holes", desc);
  pass.read(depths, Access::storageLoad, "Depths", "splatted depths");
  const frame::TextureHandle filled =
      pass.write(graph.createTexture("maps of points", {.target = GL_TEXTURE_2D_ARRAY,
                                                        .format = GL_R32F,
                                                        .width = desc.size,
                                                        .height = desc.size,
                                                        .layers = desc.count}),
                 Access::imageStore, "maps", "radial depth");
  const auto program = pass.program({.files = {"glsl/indirect/fill_holes.comp.glsl"},
                                     .defines = {{"TEXELS", std::to_string(desc.size)},
                                                 {"TILE", std::to_string(tile)},
                                                 {"LEVELS", std::to_string(desc.fillLevels)},
                                                 {"ROOM", std::to_string(room)}}});
  const bool filling = desc.fillLevels > 0;
  const int group = filling ? tile : kCopied;
  pass.execute(
      [=, count = desc.count, size = desc.size, apart = desc.fillDepth](frame::PassContext& context) {
        gpu::Program& kernel = context.use(program);
        if (filling) kernel.set("apart", apart);
        context.dispatch(size, size, count, group, group);
      });
  return filled;
}

}  // namespace

int pointMapBatch(const gpu::Device& device, int size) {
  const int64_t fitting = device.limits().maxStorageBlockBytes / (int64_t{sizeof(float)} * size * size);
  return static_cast<int>(std::clamp<int64_t>(fitting, 1, paraboloidBatch(device, size)));
}

PointMapPass::PointMapPass(gpu::Device& device, const scene::Scene& scene, const scene::Pose& pose,
                           int points, int windows)
    : points_(device, scene, pose, points * windows) {}

void PointMapPass::update(const scene::Pose& pose) {
  points_.update(pose);
}

void PointMapPass::place(frame::FrameGraph& graph, const SceneHandles& handles, std::string_view technique) {
  const BufferHandle chosen = points_.import(graph);
  const int count = points_.count();
  frame::PassBuilder pass = graph.addPass("points of the scene", technique);
  pass.read(chosen, Access::storageLoad, "Points", "points on triangles")
      .read(handles.geometry, Access::storageLoad, "Positions", "where the triangles are")
      .read(handles.instances, Access::storageLoad, "Instances", "transforms")
      .cacheable();
  placed_ = pass.write(
      graph.createBuffer("placed points", {static_cast<size_t>(count) * sizeof(glsl::PlacedPoint)}),
      Access::storageStore, "Placed", "points in the world");
  const auto program = pass.program({.files = {"glsl/indirect/place_points.comp.glsl"}, .defines = {}});
  pass.execute([this, program, count](frame::PassContext& context) {
    if (!(points_.area() > 0)) return;
    context.use(program).set("count", static_cast<unsigned>(count));
    context.dispatch(count, 1, 1, 64, 1);
  });
}

ParaboloidMaps PointMapPass::add(frame::FrameGraph& graph, const gpu::Device& device, BufferHandle views,
                                 const PointMapDesc& desc) {
  const int most = pointMapBatch(device, desc.size);
  if (desc.count < 1 || desc.count > most)
    throw UsageError(fmt::format("{} maps of {} x {} texels filled from points at once: accepted are 1 to {}",
                                 desc.count, desc.size, desc.size, most));
  const BufferHandle cleared = clear(graph, desc);
  frame::PassBuilder pass = passOf(graph, "splat points", desc);
  pass.read(placed_, Access::storageLoad, "Placed", "points in the world")
      .read(views, Access::storageLoad, "Views", "where the hemispheres are");
  const BufferHandle depths = pass.write(cleared, Access::storageLoadStore, "Depths", "nearest depths");
  const auto program = pass.program({.files = {"glsl/indirect/splat_points.comp.glsl"}, .defines = {}});
  pass.execute([this, program, desc](frame::PassContext& context) {
    if (!(points_.area() > 0)) return;
    gpu::Program& kernel = context.use(program);
    kernel.set("first", static_cast<unsigned>(desc.first));
    kernel.set("points", static_cast<unsigned>(desc.points));
    kernel.set("pool", static_cast<unsigned>(points_.count()));
    kernel.set("radius", std::sqrt(points_.area() / (glsl::pi * static_cast<float>(desc.points))));
    kernel.set("reach", desc.splat);
    context.dispatch(desc.points, desc.count, 1, 64, 1);
  });
  return {.depth = fillHoles(graph, desc, depths),
          .views = views,
          .count = desc.count,
          .first = desc.first,
          .size = desc.size};
}

PointMapPass& pointMapPass(std::optional<PointMapPass>& pass, frame::FrameGraph& graph,
                           const TechniqueInputs& inputs, int points, std::string_view technique) {
  if (!pass) {
    pass.emplace(inputs.gpuScene.device(), inputs.scene, inputs.pose, points, kWindows);
    pass->place(graph, inputs.handles, technique);
  }
  return *pass;
}

}  // namespace limn::indirect
