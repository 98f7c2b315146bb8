// Global illumination by implicit visibility: radiosity whose links, the shortest in their bin of directions,
// say what a surface element sees.
#include <algorithm>
#include <memory>

#include "core/base/error.h"
#include "core/scene/scene.h"
#include "core/technique/technique.h"
#include "techniques/implicit_visibility/display.h"
#include "techniques/implicit_visibility/element_passes.h"
#include "techniques/implicit_visibility/light_passes.h"

namespace {

using namespace limn;
using implicit_visibility::Display;
using implicit_visibility::ElementPasses;
using implicit_visibility::LightPasses;
using implicit_visibility::PassRequest;

constexpr const char* structures[] = {"hierarchical", "flat"};
constexpr const char* makers[] = {"cpu", "gpu"};
constexpr const char* fills[] = {"centre", "footprint"};
constexpr const char* displays[] = {"vertex", "pixel"};
constexpr Parameter parameters[] = {
    integer("bins", 16, {4, 32}, "bins", "N of the 6 x N x N bins of directions").quality().logScale(),
    integer("bounces", 1, {1, 16}, "bounces", "Surfaces that reflect light before the one that is seen"),
    choice("structure", 0, structures, "Links through the hierarchy, or every pair of surface elements"),
    choice("links", 0, makers, "Where links are made: on all cores of the CPU, as published, or on the GPU"),
    choice(
        "fill", 1, fills,
        "Bins that an element fills: the one of its centre, as published, or those whose centres it covers"),
    real("opening", radiosity::LinkSettings{}.opening, {0.05, 16}, "bins",
         "Solid angle above which elements are opened; 1: as published")
        .logScale(),
    real("longest_edge", 0.03, {0.005, 10}, "scene radii", "Longer edges of triangles are halved")
        .quality()
        .logScale(),
    choice("display", 0, displays,
           "Irradiance of vertices, interpolated, or bins gathered with the BRDF per pixel"),
    integer("glossy_bins", 0, {0, 16}, "bins",
            "N of the 6 x N x N bins that glossy surfaces send light into; 0: they send it evenly")
        .quality(),
    integer("light_samples", 64, {1, 1024}, "points", "Of each area light, tested against the bins")
        .logScale(),
    integer("memory", 1024, {1, 16384}, "MiB", "Scenes whose links take more are refused"),
};
constexpr StressCase stress[] = {
    {.name = "4 bins", .scene = "cornell_box", .settings = "bins=4", .factor = 4},
    {.name = "32 bins", .scene = "cornell_box", .settings = "bins=32"},
    {.name = "as published", .scene = "cornell_box", .settings = "fill=centre", .factor = 2},
    {.name = "every pair", .scene = "cornell_box", .settings = "structure=flat"},
    {.name = "coarse mesh", .scene = "cornell_box", .settings = "longest_edge=10", .factor = 8},
    {.name = "per pixel", .scene = "cornell_box", .settings = "display=pixel bins=8", .factor = 2},
    {.name = "links made on the GPU", .scene = "cornell_box", .settings = "links=gpu bins=8", .factor = 2},
    {.name = "glossy interreflection",
     .scene = "cornell_box",
     .settings = "glossy_bins=4 bins=8",
     .factor = 2},
    {.name = "three bounces", .scene = "cornell_box", .settings = "bounces=3", .factor = 4},
};

class ImplicitVisibility : public Technique {
 public:
  static constexpr TechniqueInfo info{.name = "implicit_visibility",
                                      .title = "Implicit visibility",
                                      .source = "Dong, Kautz, Theobalt, Seidel 2007; thesis, chapter 4",
                                      .terms = Term::visibility | Term::indirect | Term::environment,
                                      .parameters = parameters,
                                      .stress = stress};

 private:
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const PassRequest r{graph, inputs, request.target};
    const bool sky =
        request.term == Term::environment || (inputs.scene.environment && asksForAll(inputs, request));
    if (request.term == Term::indirect && request.lights.empty() && !sky) {
      graph.leaveOut("indirect light", info.name, "the scene has no light");
      return request.target;
    }
    begin(graph, inputs);
    if (request.term == Term::visibility) return display_->visibility(r, light_->seenBy(r, request.lights));
    if (request.term == Term::environment) return display_->light(r, light_->sky(r));
    return display_->light(r,
                           light_->reflected(r, request.lights, sky, inputs.parameters.integer("bounces")));
  }

  bool update(const scene::Pose& pose) override { return elements_ && !elements_->fits(pose); }

  /// Whether no light of the scene's own is left out: then the environment is asked for, too.
  static bool asksForAll(const TechniqueInputs& inputs, const TermRequest& request) {
    const auto own = [](const glsl::Light& light) {
      return (light.info.y & glsl::light_flag_environment) == 0 && glm::vec3(light.emission) != glm::vec3(0);
    };
    return static_cast<std::ptrdiff_t>(request.lights.size()) >=
           std::ranges::count_if(inputs.pose.lights, own);
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
                                                       .opening = p.real("opening")},
                                             .flat = p.choice("structure") == 1,
                                             .onGpu = p.choice("links") == 1,
                                             .longestEdge = p.real("longest_edge"),
                                             .glossy = p.integer("glossy_bins"),
                                             .memory = int64_t{p.integer("memory")} << 20,
                                             .technique = info.name});
    light_ = std::make_unique<LightPasses>(*elements_, info.name);
    display_ = std::make_unique<Display>(*elements_, info.name);
  }

  std::unique_ptr<ElementPasses> elements_;
  std::unique_ptr<LightPasses> light_;
  std::unique_ptr<Display> display_;
};

}  // namespace

LIMN_TECHNIQUE(ImplicitVisibility::info, ImplicitVisibility)
