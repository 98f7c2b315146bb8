// Global illumination by implicit visibility: radiosity whose links, the shortest in their bin of directions,
// say what a surface element sees.
#include <algorithm>
#include <memory>
#include <optional>
#include <span>

#include "core/base/error.h"
#include "core/scene/environment_light.h"
#include "core/scene/scene.h"
#include "core/technique/technique.h"
#include "techniques/implicit_visibility/display.h"
#include "techniques/implicit_visibility/element_colours.h"
#include "techniques/implicit_visibility/element_passes.h"
#include "techniques/implicit_visibility/light_passes.h"
#include "techniques/implicit_visibility/outlines.h"

namespace {

using namespace limn;
using implicit_visibility::Display;
using implicit_visibility::ElementColours;
using implicit_visibility::ElementPasses;
using implicit_visibility::LightPasses;
using implicit_visibility::OutlineLists;
using implicit_visibility::Outlines;
using implicit_visibility::PassRequest;
using implicit_visibility::Shown;

constexpr const char* kStructures[] = {"hierarchical", "flat"};
constexpr const char* kMakers[] = {"cpu", "gpu"};
constexpr const char* kFills[] = {"centre", "footprint", "triangles"};
constexpr const char* kDisplays[] = {"vertex", "pixel"};
constexpr const char* kOutlines[] = {"vertex", "pixel"};
constexpr Parameter kParameters[] = {
    integer("bins", 16, {4, 32}, "bins", "N of the 6 x N x N bins of directions").quality().logScale(),
    integer("bounces", 1, {1, 16}, "bounces", "Surfaces that reflect light before the one that is seen"),
    choice("structure", 0, kStructures, "Links through the hierarchy, or every pair of surface elements"),
    choice("links", 0, kMakers, "Where links are made: on all cores of the CPU, as published, or on the GPU"),
    choice("fill", 1, kFills,
           "Bins that an element fills: the one of its centre, as published, those whose centres its disc "
           "covers, or, of an element at a vertex, its triangles"),
    real("opening", radiosity::LinkSettings{}.opening, {0.05, 16}, "bins",
         "Solid angle above which elements are opened; 1: as published")
        .logScale(),
    real("sharing", radiosity::LinkSettings{}.sharing, {0.01, 1}, "of opening",
         "Solid angle below which receivers share links; links made on the GPU are not shared")
        .logScale(),
    real(
        "closing", radiosity::LinkSettings{}.closing, {0.01, 1}, "of a bin's distance",
        "Single bins take the links of neighbours that are nearer than this; on the GPU empty bins alone do"),
    real("below_horizon", radiosity::LinkSettings{}.belowHorizon, {0, 1}, "sine",
         "How far below a vertex's horizon a disc wider than four bins fills bins, since normals of pixels "
         "differ from its; narrower discs and triangles fill all that they cover; links=cpu"),
    real("longest_edge", 0.03, {0.005, 10}, "scene radii", "Longer edges of triangles are halved")
        .quality()
        .logScale(),
    real("lift", radiosity::kDefaultLift, {0, 1}, "disc radii",
         "Height over an element from which it is looked for within bodies of other objects"),
    choice("display", 0, kDisplays,
           "Irradiance of vertices, interpolated, or bins gathered with the BRDF per pixel"),
    choice("outlines", 1, kOutlines,
           "Visibility of lights at vertices, interpolated, or of pixels, by lists of the triangles that may "
           "hide a light from the surface around a vertex"),
    integer("glossy_bins", 0, {0, 16}, "bins",
            "N of the 6 x N x N bins that glossy surfaces send light into; 0: they send it evenly")
        .quality(),
    integer("light_samples", 64, {1, 1024}, "points", "Of each light with a size, tested against the bins")
        .logScale(),
    real("reach", 0.98, {0, 1}, "of the way",
         "Links that are shorter than this hide a point of a light: those at the light itself are not to"),
    choice("show", 0, implicit_visibility::kShownNames,
           "In place of light over other surfaces, elements in colours: those of a level of the hierarchy, "
           "those that the element in the middle of the picture is linked to, or its bins"),
    integer("show_level", 2, {0, 32}, "levels", "Above the leaves, of the elements that show=level shows"),
    integer("memory", 1024, {1, 16384}, "MiB", "Scenes whose links take more are refused"),
};
constexpr StressCase kStress[] = {
    {.name = "4 bins", .scene = "cornell_box", .settings = "bins=4", .factor = 4},
    {.name = "32 bins", .scene = "cornell_box", .settings = "bins=32"},
    {.name = "as published", .scene = "cornell_box", .settings = "fill=centre", .factor = 2},
    {.name = "triangles", .scene = "cornell_box", .settings = "fill=triangles bins=8", .factor = 4},
    {.name = "every pair", .scene = "cornell_box", .settings = "structure=flat"},
    {.name = "links shared by many", .scene = "cornell_box", .settings = "sharing=1 bins=8", .factor = 4},
    {.name = "hardly a link shared", .scene = "cornell_box", .settings = "sharing=0.01 bins=8", .factor = 4},
    {.name = "empty bins alone closed",
     .scene = "cornell_box",
     .settings = "closing=0.01 bins=8",
     .factor = 4},
    {.name = "all single bins closed", .scene = "cornell_box", .settings = "closing=1 bins=8", .factor = 4},
    {.name = "wide discs end at the horizon",
     .scene = "cornell_box",
     .settings = "below_horizon=0 bins=8",
     .factor = 4},
    {.name = "wide discs go on below the horizon",
     .scene = "cornell_box",
     .settings = "below_horizon=1 bins=8",
     .factor = 4},
    {.name = "bodies looked for in the surface",
     .scene = "cornell_box",
     .settings = "lift=0 bins=8",
     .factor = 4},
    {.name = "bodies looked for a radius above",
     .scene = "cornell_box",
     .settings = "lift=1 bins=8",
     .factor = 4},
    {.name = "nothing hides a light", .scene = "cornell_box", .settings = "reach=0 bins=8", .factor = 0},
    {.name = "links as long as the way hide",
     .scene = "cornell_box",
     .settings = "reach=1 bins=8",
     .factor = 0},
    {.name = "coarse mesh", .scene = "cornell_box", .settings = "longest_edge=10", .factor = 8},
    {.name = "per pixel", .scene = "cornell_box", .settings = "display=pixel bins=8", .factor = 2},
    {.name = "outlines of vertices",
     .scene = "cornell_box",
     .settings = "outlines=vertex bins=8",
     .factor = 4},
    {.name = "links made on the GPU", .scene = "cornell_box", .settings = "links=gpu bins=8", .factor = 2},
    {.name = "glossy interreflection",
     .scene = "cornell_box",
     .settings = "glossy_bins=4 bins=8",
     .factor = 2},
    {.name = "three bounces", .scene = "cornell_box", .settings = "bounces=3", .factor = 4},
    {.name = "levels in colours", .scene = "cornell_box", .settings = "show=level bins=8", .factor = 0},
    {.name = "links in colours", .scene = "cornell_box", .settings = "show=links bins=8", .factor = 0},
};

class ImplicitVisibility : public Technique {
 public:
  static constexpr TechniqueInfo info{.name = "implicit_visibility",
                                      .title = "Implicit visibility",
                                      .source = "Dong, Kautz, Theobalt, Seidel 2007; thesis, chapter 4",
                                      .terms = Term::visibility | Term::indirect | Term::environment,
                                      .parameters = kParameters,
                                      .stress = kStress};

 private:
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const PassRequest r{graph, inputs, request.target};
    if (request.term == Term::environment && scene::isBlack(inputs.scene.environment)) {
      graph.leaveOut("environment light", info.name, "the environment is black");
      return request.target;
    }
    const bool sky = request.term == Term::environment || includesEnvironment(inputs, request);
    if (request.term == Term::indirect && request.lights.empty() && !sky) {
      graph.leaveOut("indirect light", info.name, "the scene has no light");
      return request.target;
    }
    const auto shown = static_cast<Shown>(inputs.parameters.choice("show"));
    const bool coloured = request.term == Term::indirect && shown != Shown::light;
    if (coloured && inputs.bodyAlbedo) return request.target;  // colours enter no surface
    begin(graph, inputs);
    if (request.term == Term::visibility) return visibility(r, request.lights);
    if (request.term == Term::environment) return display_->light(r, light_->sky(r));
    if (coloured)
      return display_->colours(r, colours_->colours(r, shown, inputs.parameters.integer("show_level")));
    return display_->light(r,
                           light_->reflected(r, request.lights, sky, inputs.parameters.integer("bounces")));
  }

  frame::TextureHandle visibility(const PassRequest& r, std::span<const uint32_t> lights) {
    std::optional<OutlineLists> lists;
    if (r.inputs.parameters.choice("outlines") == 1) lists = outlines_->lists(r, lights);
    return display_->visibility(r, light_->seenBy(r, lights), lists);
  }

  bool update(const scene::Pose& pose) override { return elements_ && !elements_->fits(pose); }

  /// Returns whether the environment is a light of the request: unless it is black, another one was chosen,
  /// or lights stand for it, which would count it twice.
  static bool includesEnvironment(const TechniqueInputs& inputs, const TermRequest& request) {
    const auto standsForIt = [&](uint32_t light) {
      return (inputs.pose.lights[light].flags & glsl::light_flag_environment) != 0;
    };
    return !scene::isBlack(inputs.scene.environment) && !request.chosen &&
           std::ranges::none_of(request.lights, standsForIt);
  }

  void begin(frame::FrameGraph& graph, const TechniqueInputs& inputs) {
    if (elements_) return;
    const ParameterValues& p = inputs.parameters;
    if (p.choice("structure") == 1 && p.choice("links") == 1)
      throw UsageError(
          "implicit_visibility: structure=flat tries pairs on the CPU; links=gpu goes with "
          "structure=hierarchical");
    elements_ = std::make_unique<ElementPasses>(
        graph, inputs,
        implicit_visibility::ElementSettings{.links = {.resolution = p.integer("bins"),
                                                       .fill = static_cast<radiosity::Fill>(p.choice("fill")),
                                                       .opening = p.real("opening"),
                                                       .sharing = p.real("sharing"),
                                                       .closing = p.real("closing"),
                                                       .belowHorizon = p.real("below_horizon")},
                                             .flat = p.choice("structure") == 1,
                                             .onGpu = p.choice("links") == 1,
                                             .longestEdge = p.real("longest_edge"),
                                             .lift = p.real("lift"),
                                             .glossy = p.integer("glossy_bins"),
                                             .memory = int64_t{p.integer("memory")} << 20,
                                             .technique = info.name});
    outlines_ = std::make_unique<Outlines>(*elements_, info.name);
    light_ = std::make_unique<LightPasses>(*elements_, info.name);
    colours_ = std::make_unique<ElementColours>(*elements_, info.name);
    display_ = std::make_unique<Display>(*elements_, info.name);
  }

  std::unique_ptr<ElementPasses> elements_;
  std::unique_ptr<Outlines> outlines_;
  std::unique_ptr<LightPasses> light_;
  std::unique_ptr<ElementColours> colours_;
  std::unique_ptr<Display> display_;
};

}  // namespace

LIMN_TECHNIQUE(ImplicitVisibility::info, ImplicitVisibility)
