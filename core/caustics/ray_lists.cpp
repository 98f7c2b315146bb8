#include "core/caustics/ray_lists.h"

#include <fmt/format.h>

namespace limn::caustics {
namespace {

using frame::Access;

constexpr int group = 64;                                 // runs; in ray_kinds.glsl and ray_lists.comp.glsl
constexpr int threads = 256;                              // that sum the runs
constexpr unsigned indicesBinding = 4, drawsBinding = 5;  // in listed_ray.glsl

}  // namespace

RayLists addRayLists(frame::FrameGraph& graph, const CausticRays& rays, const RaySorting& sorting) {
  const int rayCount = rays.count();
  const int runCount = (rayCount + int(glsl::rays_per_run) - 1) / int(glsl::rays_per_run);

  frame::PassBuilder sort = graph.addPass("ray kinds", sorting.technique);
  sort.read(rays.rays, Access::storageLoad, "rays to draw");
  if (sorting.declare) sorting.declare(sort);
  const frame::BufferHandle counted =
      sort.write(graph.createBuffer("ray runs", {static_cast<size_t>(runCount) * sizeof(glsl::RayRun)}),
                 Access::storageStore, "kinds of rays and how many there are");
  const auto kinds = sort.program(sorting.program);
  sort.execute([=, bind = sorting.bind](frame::PassContext& context) {
    gpu::Program& kernel = context.program(kinds);
    kernel.use();
    kernel.set("ray_count", rayCount);
    context.bindStorage(0, rays.rays);
    context.bindStorage(1, counted);
    if (bind) bind(context, kernel);
    context.dispatch(runCount, 1, 1, group, 1);
  });

  frame::PassBuilder sum = graph.addPass("ray places", sorting.technique);
  const frame::BufferHandle placed =
      sum.write(counted, Access::storageLoadStore, "where each run's rays begin in the list");
  const frame::BufferHandle draws = sum.write(
      graph.createBuffer("ray draws", {glsl::ray_kinds * (sizeof(glsl::RayDraw) + sizeof(uint32_t))}),
      Access::storageStore, "how many there are to draw");
  const auto& [a, b, c] = sorting.kinds;
  const auto places = sum.program(
      {.files = {"glsl/caustics/ray_places.comp.glsl"},
       .defines = {{"THREADS", fmt::format("{}u", threads)},
                   {"RAY_VERTICES", fmt::format("uvec3({}, {}, {})", a.vertices, b.vertices, c.vertices)},
                   {"INSTANCE_RAYS",
                    fmt::format("uvec3({:d}, {:d}, {:d})", a.instances, b.instances, c.instances)}}});
  sum.execute([=](frame::PassContext& context) {
    gpu::Program& kernel = context.program(places);
    kernel.use();
    kernel.set("run_count", runCount);
    context.bindStorage(0, placed);
    context.bindStorage(1, draws);
    context.dispatch(1, 1, 1, 1, 1);
  });

  frame::PassBuilder list = graph.addPass("ray lists", sorting.technique);
  list.read(placed, Access::storageLoad, "kinds and places of rays");
  const frame::BufferHandle indices =
      list.write(graph.createBuffer("ray indices", {static_cast<size_t>(rayCount) * sizeof(uint32_t)}),
                 Access::storageStore, "rays by kind");
  const auto lists = list.program({.files = {"glsl/caustics/ray_lists.comp.glsl"}, .defines = {}});
  list.execute([=](frame::PassContext& context) {
    gpu::Program& kernel = context.program(lists);
    kernel.use();
    kernel.set("run_count", runCount);
    context.bindStorage(0, placed);
    context.bindStorage(1, indices);
    context.dispatch(runCount, 1, 1, group, 1);
  });
  return {indices, draws};
}

void declareRayLists(frame::PassBuilder& pass, const RayLists& lists) {
  pass.read(lists.indices, Access::storageLoad, "rays of each kind")
      .read(lists.draws, Access::storageLoad, "where each kind begins")
      .read(lists.draws, Access::indirectBuffer, "how many there are");
}

void drawRays(frame::PassContext& context, const RayLists& lists, unsigned kind, GLenum primitive) {
  context.bindStorage(indicesBinding, lists.indices);
  context.bindStorage(drawsBinding, lists.draws);
  const gl::Functions& gl = context.gl();
  gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, context.buffer(lists.draws).id());
  gl.DrawArraysIndirect(primitive, reinterpret_cast<const void*>(kind * sizeof(glsl::RayDraw)));
}

}  // namespace limn::caustics
