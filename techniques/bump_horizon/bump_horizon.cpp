// Shadows of bumps on their own surface, from what the texels of height maps see of the sky.
#include <array>
#include <string>
#include <vector>

#include "core/relief_maps/relief_maps.h"
#include "core/technique/light_batch.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;
using frame::Access;

enum Shape { moments, published, horizonMap, march, nearest, scan, ambient };
constexpr const char* kShapes[] = {"moments", "published", "horizon_map", "march",
                                   "nearest", "scan",      "ambient"};

constexpr Parameter kParameters[] = {
    choice("shape", moments, kShapes, "What says which directions a texel sees"),
    integer("azimuths", 32, {8, 128}, "azimuths",
            "Of the horizons, for moments, nearest, ambient and horizon_map")
        .quality()
        .logScale(),
    integer("directions", 256, {64, 4096}, "directions", "That the published fit is made of")
        .quality()
        .logScale(),
    integer("steps", 16, {1, 256}, "steps", "Of a march to the highest level, or of a scan over half a tile")
        .quality()
        .logScale(),
    boolean("soft", false, "Lights have their size, for ellipses; else they are their centres"),
};
constexpr StressCase kStress[] = {
    {.name = "moments of 8 azimuths", .scene = "egg_crate", .settings = "azimuths=8", .factor = 2},
    {.name = "horizon maps of 8 azimuths", .scene = "egg_crate", .settings = "shape=horizon_map azimuths=8"},
    {.name = "fit to 64 directions",
     .scene = "egg_crate",
     .settings = "shape=published directions=64",
     .factor = 2},
    {.name = "scan of one step", .scene = "egg_crate", .settings = "shape=scan steps=1", .factor = 8},
    {.name = "march of one step", .scene = "bump_wall", .settings = "shape=march steps=1", .factor = 8},
    {.name = "soft lights", .scene = "bump_wall", .settings = "soft=true"},
    {.name = "grooves", .scene = "groove", .settings = "shape=horizon_map azimuths=128"},
    {.name = "horizon maps of a ball", .scene = "bump_sphere", .settings = "shape=horizon_map azimuths=8"},
    {.name = "camera near a bump",
     .change = StressChange::cameraNear,
     .amount = 1.1,
     .scene = "bump_sphere",
     .factor = 4},
    {.name = "camera far from a bump",
     .change = StressChange::cameraNear,
     .amount = 6,
     .scene = "bump_sphere"},
    {.name = "bumps of a scene of 1e-4",
     .change = StressChange::sceneScale,
     .amount = 1e-4,
     .scene = "bump_wall"},
    {.name = "bumps of a scene of 1e4",
     .change = StressChange::sceneScale,
     .amount = 1e4,
     .scene = "bump_wall"},
};

relief_maps::ReliefMapDesc tableFor(const ParameterValues& parameters) {
  using relief_maps::Table;
  constexpr std::array tables{Table::moments, Table::published, Table::horizons, Table::heights,
                              Table::nearest, Table::heights,   Table::ambient};
  return {.table = tables[static_cast<size_t>(parameters.choice("shape"))],
          .azimuths = parameters.integer("azimuths"),
          .directions = parameters.integer("directions")};
}

class BumpHorizon : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& parameters = inputs.parameters;
    const int shape = parameters.choice("shape");
    const relief_maps::ReliefMapDesc table = tableFor(parameters);
    const relief_maps::ReliefMaps maps = inputs.service<relief_maps::ReliefMapService>().request(table);
    frame::PassBuilder pass = graph.addPass("relief", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(inputs.handles.lights, Access::storageLoad, "Lights", "lights")
        .read(inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "positions")
        .read(inputs.gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal,
              "bases of bumps")
        .read(inputs.gbuffer.tangent, Access::sampled, kGBufferNames.tangent, "places in height maps")
        .read(inputs.gbuffer.instance, Access::sampled, kGBufferNames.instance, "materials of surfaces")
        .read(inputs.handles.instances, Access::storageLoad, "Instances", "materials of surfaces")
        .read(inputs.handles.materials, Access::storageLoad, "Materials", "which height map they have")
        .read(maps.fields, Access::storageLoad, "ReliefFields", "sizes of height maps")
        .read(maps.values, Access::storageLoad, "ReliefValues", "what their texels see");
    const frame::TextureHandle result =
        pass.write(request.target, Access::imageStore, "relief", "W, one layer per light");
    gpu::ProgramDesc program{.files = {"techniques/bump_horizon/relief.comp.glsl"},
                             // The nearest ellipses are looked up as those of the moments are.
                             .defines = {{"SHAPE", std::to_string(shape == nearest ? moments : shape)},
                                         {"SOFT", parameters.boolean("soft") ? "1" : "0"},
                                         {"LIGHT_COUNT", std::to_string(request.lights.size())}}};
    if (shape == horizonMap) program.defines["RELIEF_AZIMUTHS"] = std::to_string(table.azimuths);
    const auto kernel = pass.program(std::move(program));
    pass.execute([=, size = inputs.size, steps = parameters.integer("steps"),
                  indices = std::vector<uint32_t>(request.lights.begin(), request.lights.end())](
                     frame::PassContext& context) {
      gpu::Program& bound = context.use(kernel);
      setLightIndices(bound, indices);
      if (shape == march || shape == scan) bound.set("steps", steps);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return result;
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "bump_horizon",
      .title = "Shadows of bump maps from horizons",
      .source =
          "Heidrich, Daubert, Kautz, Seidel 2000, Illuminating Micro Geometry Based on Precomputed "
          "Visibility; Max 1988, Horizon Mapping",
      .terms = termSet(Term::relief),
      .parameters = kParameters,
      .stress = kStress,
      .places = true};
};

}  // namespace

LIMN_TECHNIQUE(BumpHorizon::info, BumpHorizon)
