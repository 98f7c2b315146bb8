// Instant radiosity (Keller 1997) with a shadow map for every virtual light: the brute-force answer.
#include <algorithm>
#include <array>
#include <deque>

#include "core/gpu_scene/gpu_scene.h"
#include "core/indirect/light_maps.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr auto kParameters = indirect::gatherParameters(
    std::to_array<Parameter>({
        integer("map_size", 128, {16, 2048}, "texels", "Width and height of each virtual light's map")
            .quality()
            .logScale(),
        real("bias", 0.25, {0, 64}, "texel footprints",
             "How far a blocker must lie above the receiver's tangent plane to count"),
        integer("memory", 512, {16, 1024}, "MiB",
                "Maps drawn at once take no more than this, or are one map"),
    }),
    1);
constexpr StressCase kStress[] = {
    {.name = "one virtual light", .scene = "cornell_box", .settings = "vpls=1", .factor = 8},
    {.name = "N not divisible", .scene = "cornell_box", .settings = "vpls=1021"},
    {.name = "many batches", .scene = "cornell_box", .settings = "vpls=300 map_size=256 memory=16"},
    {.name = "maps of 16 texels", .scene = "cornell_box", .settings = "map_size=16", .factor = 2},
    {.name = "no bias", .scene = "cornell_box", .settings = "bias=0"},
    {.name = "interleaved", .scene = "cornell_box", .settings = "block=8"},
    {.name = "11.5 million triangles", .scene = "soldiers", .settings = "vpls=8"},
};

class InstantRadiosity : public Technique {
 public:
  static constexpr TechniqueInfo info{.name = "instant_radiosity",
                                      .title = "Instant radiosity, one shadow map per virtual light",
                                      .source = "Keller 1997, Instant Radiosity",
                                      .terms = termSet(Term::indirect),
                                      .parameters = kParameters,
                                      .stress = kStress};

 private:
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const auto lights = indirect::virtualLightsOf(graph, inputs, request, info.name);
    if (!lights) return request.target;
    const ParameterValues& p = inputs.parameters;
    const int size = p.integer("map_size");
    const int64_t fitting = (int64_t{p.integer("memory")} << 20) / indirect::paraboloidBytes(size);
    const int batch = static_cast<int>(std::clamp<int64_t>(
        fitting, 1, std::min(lights->count, indirect::paraboloidBatch(inputs.gpuScene.device(), size))));
    const auto fill = [&](frame::BufferHandle views, const indirect::ParaboloidDesc& desc) {
      return passes_.emplace_back().add(graph, inputs.gpuScene, inputs.handles, views, desc);
    };
    return indirect::addMappedLight(graph, inputs, request, *lights,
                                    {.size = size, .batch = batch, .technique = info.name}, maps_, fill);
  }

  indirect::MadeForLights<indirect::LightMaps> maps_;
  std::deque<indirect::ParaboloidMapPass> passes_;  ///< the graph keeps their addresses
};

}  // namespace

LIMN_TECHNIQUE(InstantRadiosity::info, InstantRadiosity)
