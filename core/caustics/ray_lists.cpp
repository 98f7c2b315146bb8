#include "core/caustics/ray_lists.h"

#include <fmt/format.h>

namespace limn::caustics {
namespace {

using frame::Access;

constexpr int kThreads = 256;  // that sum the groups

int quotient(int count, uint32_t divisor) {
  return (count + static_cast<int>(divisor) - 1) / static_cast<int>(divisor);
}

}  // namespace

RayLists addRayLists(frame::FrameGraph& graph, const CausticRays& rays, const RaySorting& sorting) {
  const int rayCount = rays.count();
  const int runCount = quotient(rayCount, glsl::rays_per_run);
  const int groupCount = quotient(runCount, glsl::runs_per_group);

  frame::PassBuilder sort = graph.addPass("ray kinds", sorting.technique);
  sort.read(rays.rays, Access::storageLoad, "Rays", "rays to draw");
  if (sorting.declare) sorting.declare(sort);
  if (sorting.kept) sort.cacheable();
  const frame::BufferHandle runs =
      sort.write(graph.createBuffer("ray runs", {static_cast<size_t>(runCount) * sizeof(glsl::RayRun)}),
                 Access::storageStore, "RayRuns", "kinds of rays");
  const frame::BufferHandle counted =
      sort.write(graph.createBuffer("ray groups", {static_cast<size_t>(groupCount) * sizeof(glsl::RayGroup)}),
                 Access::storageStore, "RayGroups", "how many rays of each kind there are");
  const auto kinds = sort.program(sorting.program);
  sort.execute([=, bind = sorting.bind](frame::PassContext& context) {
    gpu::Program& kernel = context.use(kinds);
    kernel.set("ray_count", rayCount);
    if (bind) bind(kernel);
    context.dispatch(groupCount, 1, 1, 1, 1);
  });

  frame::PassBuilder sum = graph.addPass("ray places", sorting.technique);
  if (sorting.kept) sum.cacheable();
  const frame::BufferHandle placed =
      sum.write(counted, Access::storageLoadStore, "RayGroups", "where each group's rays begin");
  const frame::BufferHandle draws = sum.write(
      graph.createBuffer("ray draws", {glsl::ray_kinds * (sizeof(glsl::RayDraw) + sizeof(uint32_t))}),
      Access::storageStore, "RayDraws", "how many there are to draw");
  const auto& [a, b, c] = sorting.kinds;
  const auto places = sum.program(
      {.files = {"glsl/caustics/ray_places.comp.glsl"},
       .defines = {{"LENGTH", std::to_string(kThreads)},
                   {"RAY_VERTICES", fmt::format("uvec3({}, {}, {})", a.vertices, b.vertices, c.vertices)},
                   {"INSTANCE_RAYS",
                    fmt::format("uvec3({:d}, {:d}, {:d})", a.instances, b.instances, c.instances)}}});
  sum.execute([=](frame::PassContext& context) {
    context.use(places).set("group_count", groupCount);
    context.dispatch(1, 1, 1, 1, 1);
  });

  frame::PassBuilder list = graph.addPass("ray lists", sorting.technique);
  if (sorting.kept) list.cacheable();
  list.read(runs, Access::storageLoad, "RayRuns", "kinds of rays")
      .read(placed, Access::storageLoad, "RayGroups", "where each group's rays begin")
      .read(draws, Access::storageLoad, "RayDraws", "where each kind begins");
  const frame::BufferHandle indices =
      list.write(graph.createBuffer("ray indices", {static_cast<size_t>(rayCount) * sizeof(uint32_t)}),
                 Access::storageStore, "RayIndices", "rays by kind");
  const auto lists = list.program({.files = {"glsl/caustics/ray_lists.comp.glsl"}, .defines = {}});
  list.execute([=](frame::PassContext& context) {
    context.use(lists).set("run_count", runCount);
    context.dispatch(groupCount, 1, 1, 1, 1);
  });
  return {indices, draws};
}

void declareRayLists(frame::PassBuilder& pass, const RayLists& lists) {
  pass.read(lists.indices, Access::storageLoad, "RayIndices", "rays of each kind")
      .read(lists.draws, Access::storageLoad, "RayDraws", "where each kind begins")
      .read(lists.draws, Access::indirectBuffer, "how many there are");
}

void drawRays(frame::PassContext& context, const RayLists& lists, unsigned kind, GLenum primitive) {
  const gl::Functions& gl = context.gl();
  gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, context.buffer(lists.draws).id());
  gl.DrawArraysIndirect(primitive, reinterpret_cast<const void*>(kind * sizeof(glsl::RayDraw)));
}

}  // namespace limn::caustics
