// Imperfect shadow maps (Ritschel et al. 2008): a coarse map for every virtual light, filled from points
// instead of triangles.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "core/gpu_scene/gpu_scene.h"
#include "core/indirect/light_maps.h"
#include "core/technique/technique.h"
#include "techniques/imperfect_shadow_maps/scene_points.h"

namespace {

using namespace limn;
using frame::Access;

constexpr int kWindows = 16;  // the pool of points holds as many times what one map takes

constexpr auto kParameters = indirect::gatherParameters(std::to_array<Parameter>({
    integer("map_size", 64, {8, 64}, "texels", "Width and height of each virtual light's map"),
    integer("points", 2048, {64, 65536}, "points", "Splatted into each map").quality().logScale(),
    real("splat", 4, {0.5, 16}, "texels", "Radius of the largest splat"),
    integer("fill_levels", 0, {0, 6}, "levels", "Holes up to 2 to this power texels wide are closed"),
    real("fill_depth", 0.05, {0, 1}, "scene extents",
         "Depths farther apart than this are not averaged when holes are closed"),
    real("bias", 1, {0, 64}, "texel footprints",
         "How far a blocker must lie above the receiver's tangent plane to count"),
}));
constexpr StressCase kStress[] = {
    {.name = "one virtual light", .scene = "cornell_box", .settings = "vpls=1 block=1", .factor = 8},
    {.name = "N not divisible", .scene = "cornell_box", .settings = "vpls=1021"},
    {.name = "more maps than layers",
     .scene = "cornell_box",
     .settings = "vpls=4096 map_size=16",
     .factor = 2},
    {.name = "64 points", .scene = "cornell_box", .settings = "points=64", .factor = 4},
    {.name = "maps of 8 texels", .scene = "cornell_box", .settings = "map_size=8", .factor = 4},
    {.name = "maps of odd size", .scene = "cornell_box", .settings = "map_size=37", .factor = 2},
    {.name = "holes filled", .scene = "cornell_box", .settings = "fill_levels=2", .factor = 2},
    {.name = "bound by patches", .scene = "cornell_box", .settings = "bound=patch", .factor = 2},
    {.name = "no bias", .scene = "cornell_box", .settings = "bias=0", .factor = 2},
    {.name = "11.5 million triangles", .scene = "soldiers"},
};

class ImperfectShadowMaps : public Technique {
 public:
  static constexpr TechniqueInfo info{.name = "imperfect_shadow_maps",
                                      .title = "Imperfect shadow maps, one for each virtual light",
                                      .source = "Ritschel et al. 2008, Imperfect Shadow Maps",
                                      .terms = termSet(Term::indirect),
                                      .parameters = kParameters,
                                      .stress = kStress};

 private:
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    if (request.lights.empty()) {
      graph.leaveOut("indirect light", info.name, "the scene has no light");
      return request.target;
    }
    const ParameterValues& p = inputs.parameters;
    const indirect::VirtualLights lights = inputs.service<indirect::VirtualLightService>().request(
        request.lights, indirect::virtualLightDesc(p));
    const int size = p.integer("map_size");
    const int batch = std::min(lights.count, indirect::paraboloidBatch(inputs.gpuScene.device(), size));
    kept_ = batch == lights.count;
    const frame::BufferHandle views = indirect::addLightViews(
        graph, inputs, lights, {.size = size, .batch = batch, .technique = info.name});
    points_.emplace(inputs.gpuScene.device(), inputs.scene, inputs.pose, kWindows * p.integer("points"));
    const frame::BufferHandle placed = placePoints(graph, inputs);
    indirect::Gather gather(graph, inputs, info.name, lights, indirect::gatherSettings(p));
    for (int first = 0; first < lights.count; first += batch) {
      indirect::ParaboloidMaps maps{.depth = {},
                                    .views = views,
                                    .count = std::min(batch, lights.count - first),
                                    .first = first,
                                    .size = size};
      maps.depth = fillHoles(graph, inputs, maps, splat(graph, inputs, maps, placed));
      gather.shade(indirect::lightMapShadePass(inputs, maps, p.real("bias")));
    }
    return gather.finish(request.target);
  }

  bool update(const scene::Pose& pose) override {
    if (points_) points_->update(pose);
    return false;
  }

  frame::BufferHandle placePoints(frame::FrameGraph& graph, const TechniqueInputs& inputs) {
    const frame::BufferHandle chosen = points_->import(graph);
    const int count = points_->count();
    frame::PassBuilder pass = graph.addPass("points of the scene", info.name);
    pass.read(chosen, Access::storageLoad, "Points", "points on triangles")
        .read(inputs.handles.geometry, Access::storageLoad, "Positions", "where the triangles are")
        .read(inputs.handles.instances, Access::storageLoad, "Instances", "transforms")
        .cacheable();
    const frame::BufferHandle placed = pass.write(
        graph.createBuffer("placed points", {static_cast<size_t>(count) * sizeof(glsl::PlacedPoint)}),
        Access::storageStore, "Placed", "points in the world");
    const auto program =
        pass.program({.files = {"techniques/imperfect_shadow_maps/place_points.comp.glsl"}, .defines = {}});
    pass.execute([this, program, count](frame::PassContext& context) {
      if (!(points_->area() > 0)) return;
      context.use(program).set("count", static_cast<unsigned>(count));
      context.dispatch(count, 1, 1, 64, 1);
    });
    return placed;
  }

  frame::BufferHandle clear(frame::FrameGraph& graph, const indirect::ParaboloidMaps& maps) const {
    frame::PassBuilder pass = graph.addPass("clear maps", info.name);
    if (kept_) pass.cacheable();
    const size_t bytes = sizeof(uint32_t) * static_cast<size_t>(maps.size) * maps.size * maps.count;
    const frame::BufferHandle depths =
        pass.write(graph.createBuffer("splatted depths", {bytes}), Access::copyTarget, "nothing is there");
    pass.execute([=](frame::PassContext& context) {
      constexpr GLfloat nothing = 1;
      context.gl().ClearNamedBufferSubData(context.buffer(depths).id(), GL_R32F, 0,
                                           static_cast<GLsizeiptr>(bytes), GL_RED, GL_FLOAT, &nothing);
    });
    return depths;
  }

  frame::BufferHandle splat(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                            const indirect::ParaboloidMaps& maps, frame::BufferHandle placed) {
    const frame::BufferHandle cleared = clear(graph, maps);
    frame::PassBuilder pass = graph.addPass("splat points", info.name);
    pass.read(placed, Access::storageLoad, "Placed", "points in the world")
        .read(maps.views, Access::storageLoad, "Views", "where the hemispheres are");
    if (kept_) pass.cacheable();
    const frame::BufferHandle depths =
        pass.write(cleared, Access::storageLoadStore, "Depths", "nearest depths");
    const auto program =
        pass.program({.files = {"techniques/imperfect_shadow_maps/splat.comp.glsl"}, .defines = {}});
    pass.execute([this, program, maps, points = inputs.parameters.integer("points"),
                  reach = inputs.parameters.real("splat")](frame::PassContext& context) {
      if (!(points_->area() > 0)) return;
      gpu::Program& kernel = context.use(program);
      kernel.set("first", static_cast<unsigned>(maps.first));
      kernel.set("points", static_cast<unsigned>(points));
      kernel.set("pool", static_cast<unsigned>(points_->count()));
      kernel.set("radius", std::sqrt(points_->area() / (glsl::pi * static_cast<float>(points))));
      kernel.set("reach", reach);
      context.dispatch(points, maps.count, 1, 64, 1);
    });
    return depths;
  }

  frame::TextureHandle fillHoles(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const indirect::ParaboloidMaps& maps, frame::BufferHandle depths) const {
    const int levels = inputs.parameters.integer("fill_levels");
    int room = maps.size * maps.size;
    for (int level = 1, side = maps.size; level <= levels; ++level) {
      side = (side + 1) / 2;
      room += side * side;
    }
    frame::PassBuilder pass = graph.addPass("fill holes", info.name);
    pass.read(depths, Access::storageLoad, "Depths", "splatted depths");
    if (kept_) pass.cacheable();
    const frame::TextureHandle filled =
        pass.write(graph.createTexture("imperfect maps", {.target = GL_TEXTURE_2D_ARRAY,
                                                          .format = GL_R32F,
                                                          .width = maps.size,
                                                          .height = maps.size,
                                                          .layers = maps.count}),
                   Access::imageStore, "maps", "radial depth");
    const auto program = pass.program({.files = {"techniques/imperfect_shadow_maps/fill_holes.comp.glsl"},
                                       .defines = {{"TEXELS", std::to_string(maps.size)},
                                                   {"LEVELS", std::to_string(levels)},
                                                   {"ROOM", std::to_string(room)}}});
    pass.execute([program, count = maps.count,
                  apart = inputs.parameters.real("fill_depth")](frame::PassContext& context) {
      context.use(program).set("apart", apart);
      context.dispatch(count, 1, 1, 1, 1);
    });
    return filled;
  }

  std::optional<imperfect::ScenePoints> points_;
  bool kept_ = false;  ///< while nothing moves: batches of maps share their memory
};

}  // namespace

LIMN_TECHNIQUE(ImperfectShadowMaps::info, ImperfectShadowMaps)
