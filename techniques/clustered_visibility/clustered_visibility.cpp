// Indirect light with clustered visibility: N virtual point lights, each with its own light, share the soft
// shadows of M area lights.
#include <fmt/format.h>

#include <array>
#include <deque>
#include <optional>

#include "core/frame/array_block.h"
#include "core/indirect/gather.h"
#include "core/indirect/paraboloid_maps.h"
#include "core/indirect/point_maps.h"
#include "core/indirect/virtual_areas.h"
#include "core/shadow/derived_maps.h"
#include "core/shadow/fourier_maps.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;
using frame::Access;

constexpr float kFillDepth = 0.05f;  // of far - near: depths farther apart are not averaged in holes

constexpr const char* kMaps[] = {"triangles", "points"};
constexpr const char* kKernels[] = {"exact", "thesis"};
constexpr const char* kSearches[] = {"solid_angle", "nearest"};
constexpr const char* kFits[] = {"map", "range"};
constexpr const char* kShows[] = {"light", "clusters"};
constexpr auto kParameters = indirect::gatherParameters(std::to_array<Parameter>({
    integer("vals", 30, {1, 1024}, "lights", "Virtual area lights, which the virtual point lights share")
        .quality()
        .logScale(),
    real("weight_position", 0.7, {0, 1}, "", "w_x of the clusters' distance: position, in scene extents"),
    real("weight_angle", 0.3, {0, 1}, "", "w_a of the same: angle between normals, in units of pi"),
    integer("iterations", 5, {0, 64}, "rounds", "Of k-means, from the same start in every frame").quality(),
    integer("map_size", 256, {16, 2048}, "texels", "Width and height of each area light's paraboloid map")
        .quality()
        .logScale(),
    choice("maps", 0, kMaps, "What the maps are filled from: triangles, as published, or points on them"),
    integer("points", 16384, {64, 65536}, "points", "Splatted into each map").quality().logScale(),
    real("splat", 8, {0.5, 64}, "texels", "Radius of the largest splat"),
    integer("fill_levels", 0, {0, 6}, "levels",
            "Holes between splats up to 2 to this power texels wide are closed"),
    integer("terms", 4, {1, 16}, "terms", "Of the Fourier series").quality().logScale(),
    choice("depth_fit", 0, kFits,
           "Depths that the series spans: the scene's extent, or those that are in the map"),
    choice("kernel", 0, kKernels, "Size of a penumbra in the map: exact, or as published"),
    choice(
        "search", 0, kSearches,
        "Where blockers are sought: in the light's solid angle, as published, or from the nearest depth on"),
    integer("splits", 1, {1, 4}, "parts", "Parts of a kernel per axis, each with its own depth threshold")
        .quality(),
    real("bias", 0.25, {0, 64}, "texel footprints",
         "How far a blocker must lie above the receiver's tangent plane to count"),
    real("contact_texels", 2, {0, 16}, "texels",
         "Blockers whose penumbrae are narrower than this are found in the map itself; 0: as published"),
    real("near", 0.02, {0, 0.5}, "scene extents",
         "Geometry nearer to the centre of an area light than this is ignored"),
    real("behind", 1, {0, 1}, "",
         "Visibility behind an area light, where its map knows nothing; 1: as published"),
    choice("show", 0, kShows, "The light, or the clusters in colours"),
}));
constexpr StressCase kStress[] = {
    {.name = "one area light", .scene = "cornell_box", .settings = "vals=1", .factor = 2},
    {.name = "as many area lights as point lights",
     .scene = "cornell_box",
     .settings = "vpls=64 vals=64 block=1",
     .factor = 4},
    {.name = "N not divisible", .scene = "cornell_box", .settings = "vpls=1021 vals=29"},
    {.name = "positions alone", .scene = "cornell_box", .settings = "weight_angle=0", .factor = 2},
    {.name = "normals alone", .scene = "cornell_box", .settings = "weight_position=0", .factor = 2},
    {.name = "clusters around the same points",
     .scene = "cornell_box",
     .settings = "vpls=8 vals=8 rsm_size=16",
     .factor = 20},
    {.name = "maps of points", .scene = "cornell_box", .settings = "maps=points", .factor = 2},
    {.name = "few points",
     .scene = "cornell_box",
     .settings = "maps=points points=64 fill_levels=6",
     .factor = 8},
    {.name = "all lights at edges", .scene = "cornell_box", .settings = "edges=1", .factor = 2},
    {.name = "map of 16 texels", .scene = "cornell_box", .settings = "map_size=16", .factor = 2},
    {.name = "thin occluders", .scene = "plant", .settings = "vals=10"},
};

class ClusteredVisibility : public Technique {
  /// Holds what some lights have, whatever surfaces are lit.
  struct Made {
    indirect::VirtualAreas areas;
    std::optional<indirect::ShadePass> pass = {};  ///< empty where clusters are shown
  };
  indirect::MadeForLights<Made> made_;
  std::optional<shadow::DerivedMaps> derived_;
  gpu::Sampler trilinear_;
  std::deque<indirect::ParaboloidMapPass> trianglePasses_;  ///< the graph keeps their addresses
  std::optional<indirect::PointMapPass> points_;            ///< empty: maps of triangles

  indirect::ParaboloidMaps addMaps(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                   const indirect::VirtualAreas& areas) {
    const ParameterValues& p = inputs.parameters;
    const int size = p.integer("map_size");
    if (p.choice("maps") == 0)
      return trianglePasses_.emplace_back().add(graph, inputs.gpuScene, inputs.handles, areas.views,
                                                {.count = areas.count, .size = size, .technique = info.name});
    const int points = p.integer("points");
    return indirect::pointMapPass(points_, graph, inputs, points, info.name)
        .add(graph, inputs.gpuScene.device(), areas.views,
             {.count = areas.count,
              .size = size,
              .points = points,
              .splat = p.real("splat"),
              .fillLevels = p.integer("fill_levels"),
              .fillDepth = kFillDepth,
              .technique = info.name});
  }

  /// The picture of the clusters, instead of light.
  static frame::TextureHandle showClusters(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                           const indirect::VirtualAreas& areas, frame::TextureHandle target) {
    frame::PassBuilder pass = graph.addPass("show clusters", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera, scene extent")
        .read(inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "positions")
        .read(inputs.gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal, "normals")
        .read(areas.lights, Access::storageLoad, "VirtualLights", "virtual point lights")
        .read(areas.areas, Access::storageLoad, "Clusters", "clusters");
    const frame::TextureHandle shown =
        pass.write(target, Access::imageLoadStore, "radiance", "colours of the clusters");
    const auto program =
        pass.program({.files = {"techniques/clustered_visibility/show_clusters.comp.glsl"}, .defines = {}});
    pass.execute([program, size = inputs.size, x = inputs.parameters.real("weight_position"),
                  a = inputs.parameters.real("weight_angle")](frame::PassContext& context) {
      gpu::Program& kernel = context.use(program);
      kernel.set("weight_position", x);
      kernel.set("weight_angle", a);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return shown;
  }

  shadow::FourierMaps fourierMaps(frame::FrameGraph& graph, gpu::Device& device, frame::TextureHandle depth,
                                  const shadow::MinMaxPyramid& pyramid, const ParameterValues& p) {
    const auto fit = p.choice("depth_fit") == 0 ? shadow::FourierFit::map : shadow::FourierFit::range;
    shadow::FourierMaps maps = shadow::addFourierMaps(
        graph, device, depth, pyramid, true,
        {.order = p.integer("terms"), .filter = shadow::FourierFilter::mip, .fit = fit});
    if (!trilinear_) trilinear_ = gpu::Sampler(device, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
    maps.trilinear = &trilinear_;
    return maps;
  }

  indirect::ShadePass shadePass(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                const indirect::VirtualAreas& areas) {
    const ParameterValues& p = inputs.parameters;
    gpu::Device& device = inputs.gpuScene.device();
    const indirect::ParaboloidMaps maps = addMaps(graph, inputs, areas);
    if (!derived_) derived_.emplace(device);
    const shadow::MinMaxPyramid pyramid = derived_->minMaxPyramid(graph, maps.depth, true);
    const shadow::FourierMaps fourier = fourierMaps(graph, device, maps.depth, pyramid, p);
    indirect::ShadePass pass{.program = {.files = {"techniques/clustered_visibility/shade.comp.glsl"},
                                         .defines = fourier.defines()},
                             .areas = areas.count,
                             .areaSteps = 1 + 2 * p.integer("splits") * p.integer("splits")};
    pass.program.defines["KERNEL_THESIS"] = std::to_string(p.choice("kernel"));
    pass.program.defines["SEARCH_NEAREST"] = std::to_string(p.choice("search"));
    pass.program.defines["SPLITS"] = std::to_string(p.integer("splits"));
    pass.program.defines["AREA_DIP"] = fmt::format("{:.9e}", fourier.constants.dip);
    const float contact = p.real("contact_texels");
    pass.program.defines["CONTACT"] = contact > 0 ? "1" : "0";
    if (contact > 0) pass.sampled.push_back({"area_depths", maps.depth, "blockers just before the receiver"});
    if (p.choice("search") == 1)
      pass.sampled.push_back({"area_depth_bounds", pyramid.texture, "nearest depths"});
    std::map<std::string, std::string>& defines = pass.program.defines;
    const Access views =
        frame::arrayBlock<glsl::ShadowView>(device.limits(), areas.count, "AREA_VIEW_COUNT", defines);
    const Access sizes =
        frame::arrayBlock<glsl::VirtualAreaLight>(device.limits(), areas.count, "AREA_COUNT", defines);
    pass.declare = [fourier, areas, views, sizes](frame::PassBuilder& builder) {
      fourier.declare(builder);
      builder.read(areas.views, views, "AreaViews", "hemispheres of the maps")
          .read(areas.areas, sizes, "AreaLights", "sizes of the area lights");
    };
    pass.bind = [bias = p.real("bias"), behind = p.real("behind"), contact](gpu::Program& program) {
      program.set("bias", bias);
      program.set("behind", behind);
      if (contact > 0) program.set("contact_texels", contact);
    };
    return pass;
  }

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    std::optional<indirect::VirtualLights> lights =
        indirect::virtualLightsOf(graph, inputs, request, info.name);
    if (!lights) return request.target;
    const ParameterValues& p = inputs.parameters;
    const indirect::GatherSettings settings = indirect::gatherSettings(p);
    Made& made = made_.get(request.lights, [&] {
      return Made{
          .areas = indirect::addVirtualAreas(graph, inputs.gpuScene, lights->lights, lights->count,
                                             {.count = p.integer("vals"),
                                              .iterations = p.integer("iterations"),
                                              .weightPosition = p.real("weight_position"),
                                              .weightAngle = p.real("weight_angle"),
                                              .near = p.real("near"),
                                              .mapSize = p.integer("map_size"),
                                              .block = indirect::usableBlock(settings.block, lights->count),
                                              .technique = info.name})};
    });
    if (p.choice("show") == 1)  // colours are no light that enters translucent surfaces
      return inputs.bodyAlbedo ? request.target : showClusters(graph, inputs, made.areas, request.target);
    lights->lights = made.areas.lights;
    indirect::Gather gather(graph, inputs, info.name, *lights, settings);
    if (!made.pass) made.pass = shadePass(graph, inputs, made.areas);
    gather.shade(*made.pass);
    return gather.finish(request.target);
  }

  bool update(const scene::Pose& pose) override {
    if (points_) points_->update(pose);
    return false;
  }

 public:
  static constexpr TechniqueInfo info{.name = "clustered_visibility",
                                      .title = "Clustered visibility",
                                      .source = "Dong et al. 2009; thesis, chapter 6",
                                      .terms = termSet(Term::indirect),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(ClusteredVisibility::info, ClusteredVisibility)
