// Imperfect shadow maps (Ritschel et al. 2008): a coarse map for every virtual light, filled from points
// instead of triangles.
#include <algorithm>
#include <array>
#include <optional>

#include "core/gpu_scene/gpu_scene.h"
#include "core/indirect/light_maps.h"
#include "core/indirect/point_maps.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr auto kParameters = indirect::gatherParameters(std::to_array<Parameter>({
    integer("map_size", 64, {8, 512}, "texels", "Width and height of each virtual light's map")
        .quality()
        .logScale(),
    integer("points", 2048, {64, 65536}, "points", "Splatted into each map").quality().logScale(),
    real("splat", 4, {0.5, 64}, "texels", "Radius of the largest splat"),
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
    const auto lights = indirect::virtualLightsOf(graph, inputs, request, info.name);
    if (!lights) return request.target;
    const ParameterValues& p = inputs.parameters;
    gpu::Device& device = inputs.gpuScene.device();
    const int size = p.integer("map_size");
    const int batch = std::min(lights->count, indirect::pointMapBatch(device, size));
    const auto fill = [&](frame::BufferHandle views, const indirect::ParaboloidDesc& desc) {
      const int points = p.integer("points");
      return indirect::pointMapPass(points_, graph, inputs, points, info.name)
          .add(graph, device, views,
               {.count = desc.count,
                .first = desc.first,
                .size = desc.size,
                .points = points,
                .splat = p.real("splat"),
                .fillLevels = p.integer("fill_levels"),
                .fillDepth = p.real("fill_depth"),
                .technique = desc.technique,
                .cacheable = desc.cacheable});
    };
    return indirect::addMappedLight(graph, inputs, request, *lights,
                                    {.size = size, .batch = batch, .technique = info.name}, maps_, fill);
  }

  bool update(const scene::Pose& pose) override {
    if (points_) points_->update(pose);
    return false;
  }

  indirect::MadeForLights<indirect::LightMaps> maps_;
  std::optional<indirect::PointMapPass> points_;  ///< empty: nobody has asked yet
};

}  // namespace

LIMN_TECHNIQUE(ImperfectShadowMaps::info, ImperfectShadowMaps)
