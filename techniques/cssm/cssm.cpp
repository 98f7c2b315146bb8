// Convolution soft shadow maps: percentage-closer soft shadows with both averages prefiltered in a Fourier
// basis.
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr const char* kFilters[] = {"mip", "sat"};
constexpr const char* kWindows[] = {"none", "lanczos", "fejer"};
constexpr const char* kFits[] = {"map", "range", "plane"};
constexpr const char* kContacts[] = {"plain", "sharpened", "normalised"};
constexpr Parameter kParameters[] = {
    integer("order", 4, {1, 64}, "terms", "Terms of the Fourier series").quality().logScale(),
    choice("filter", 1, kFilters, "Mip maps (cheap) or summed-area tables (kernels are exact boxes)"),
    choice("window", 0, kWindows, "Damps the series' higher terms: less ringing, wider transition"),
    choice("depth_fit", 2, kFits,
           "Depths that the series spans: near to far, those that are there, or those relative to a plane"),
    choice("contact", 2, kContacts,
           "What is done about blockers close to the receiver, which the series lets leak: nothing, V to a "
           "power "
           "(as published), or V normalised by what a blocker at their mean depth gives"),
    real("sharpening", 30, {0, 1000}, "", "A of the power 1 + A exp(-B (d - z_avg)), contact=sharpened"),
    real("falloff", 20, {0, 1000}, "1 / range", "B of the same"),
    integer("search_rounds", 3, {0, 9}, "rounds",
            "How often the search kernel moves from the near plane to the nearest depth in it"),
    integer("blocker_passes", 2, {1, 4}, "passes",
            "Mean blocker depths in turn, each in the kernel of the one before"),
    integer("splits", 4, {1, 8}, "parts", "Parts of a kernel per axis, each with its own depth threshold")
        .quality(),
    shadow::shadowMapSizeParameter(),
    shadow::shadowMapFitParameter(1),
    shadow::viewsParameter(),
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "one term", .settings = "order=1", .factor = 4},
    {.name = "64 terms", .settings = "order=64 shadow_map_size=256"},
    {.name = "8-bit basis", .settings = "filter=mip"},
    {.name = "published kernel in foliage", .scene = "plant", .settings = "splits=1 contact=sharpened"},
    {.name = "map of 64 texels", .settings = "shadow_map_size=64", .factor = 4},
    {.name = "parts of a light cut by the horizon",
     .change = StressChange::edgeOn,
     .settings = "views=2",
     .factor = 4},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192"},
};

class Cssm : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    const shadow::FourierDesc desc{.order = p.integer("order"),
                                   .filter = static_cast<shadow::FourierFilter>(p.choice("filter")),
                                   .window = static_cast<shadow::FourierWindow>(p.choice("window")),
                                   .fit = static_cast<shadow::FourierFit>(p.choice("depth_fit"))};
    shadow::VisibilityPass pass = shadow::visibilityPass(inputs, request, info.name);
    const shadow::MinMaxPyramid pyramid = inputs.service<shadow::ShadowMapService>().minMaxPyramid(pass.maps);
    const shadow::FourierMaps maps = inputs.service<shadow::ShadowMapService>().fourierMaps(pass.maps, desc);
    pass.program.defines = maps.defines();
    pass.program.defines["CONTACT"] = std::to_string(p.choice("contact"));
    pass.sampled = {{"shadow_min_max", pyramid.texture, "early-outs and nearest depths"}};
    pass.declare = [maps](frame::PassBuilder& builder) { maps.declare(builder); };
    const bool sharpened = p.choice("contact") == 1;
    pass.bind = [sharpened, rounds = p.integer("search_rounds"), passes = p.integer("blocker_passes"),
                 splits = p.integer("splits"), sharpening = p.real("sharpening"),
                 falloff = p.real("falloff")](frame::PassContext&, gpu::Program& program) {
      program.set("search_rounds", rounds);
      program.set("blocker_passes", passes);
      program.set("splits", splits);
      if (!sharpened) return;
      program.set("sharpening", sharpening);
      program.set("falloff", falloff);
    };
    return shadow::addVisibilityPass(graph, inputs, request.target, std::move(pass));
  }

 public:
  static constexpr TechniqueInfo info{.name = "cssm",
                                      .title = "Convolution soft shadow maps",
                                      .source = "Annen et al. 2008; thesis, chapter 5",
                                      .terms = termSet(Term::visibility),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(Cssm::info, Cssm)
