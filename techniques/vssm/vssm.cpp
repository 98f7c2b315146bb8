// Variance soft shadow maps: percentage-closer soft shadows from a summed-area table of z and z^2.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "core/scene/scene.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;

constexpr const char* kSubdivisions[] = {"uniform", "adaptive", "mixed"};
constexpr const char* kPoolings[] = {"each", "pooled"};
constexpr const char* kBoundings[] = {"mip", "windows", "nbuffer"};
constexpr const char* kBoundsLookups[] = {"min_max_depth", "min_max_windows_depth", "n_buffer_depth"};
constexpr const char* kContacts[] = {"off", "jittered"};

constexpr Parameter kParameters[] = {
    choice(
        "subdivision", 0, kSubdivisions,
        "Of kernels: equal parts, a quad-tree, or equal parts for blockers and a quad-tree for visibility"),
    integer("blocker_cells", 3, {1, 30}, "per side", "Equal parts of the blocker search").quality(),
    integer("passes", 1, {1, 8}, "passes", "Of the blocker search").quality(),
    real("pass_gap", 0.8, {0, 1}, "kernel distances",
         "Another pass is taken where blockers are nearer to the receiver than this"),
    real("least_gap", 0.05, {0.001, 1}, "kernel distances",
         "Blockers nearer to the receiver than this hide as much as at this distance; chebyshev=each")
        .logScale(),
    integer("visibility_cells", 3, {1, 30}, "per side", "Equal parts of the penumbra kernel, besides its rim")
        .quality(),
    integer("tree_height", 3, {1, 5}, "levels", "Of the quad-tree").quality(),
    choice("chebyshev", 0, kPoolings, "Evaluate Chebyshev's inequality for each sub-kernel or once for all"),
    integer("search_rounds", 6, {0, 9}, "rounds",
            "How often the minimum depth in the search kernel narrows it; 0: as published"),
    choice("bounds", 1, kBoundings,
           "Of the depths in the search kernel: from a min-max pyramid, from one of overlapping windows, "
           "tighter, or an N-buffer, tighter still and dearer"),
    boolean("early_out", true, "Answer at once where bounds of the depths in the search kernel decide")
        .savesWork("false"),
    choice("contact", 0, kContacts, "Narrow penumbrae: from the table, or 3 x 3 jittered bilinear texels"),
    real("contact_texels", 3, {1, 64}, "texels", "Width of the kernels that count as narrow"),
    integer("sat_bits", 16, {8, 24}, "bits", "Of a depth in the summed-area table"),
    integer("sat_words", 2, {1, 2}, "32-bit words", "Per moment; 1: squares rounded, as published"),
    shadow::shadowMapSizeParameter(),
    shadow::shadowMapFitParameter(1),
    shadow::viewsParameter(0),
    shadow::biasParameter(),
    shadow::lightSizeParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "map of 64 texels", .settings = "shadow_map_size=64", .factor = 6},
    {.name = "map of 8192 texels", .settings = "shadow_map_size=8192", .factor = 2.5},
    {.name = "adaptive subdivision in foliage", .scene = "plant", .settings = "subdivision=adaptive"},
    {.name = "published subdivision in foliage",
     .scene = "plant",
     .settings = "subdivision=mixed chebyshev=pooled"},
    {.name = "a pass for any nearer blocker", .settings = "passes=8 pass_gap=1"},
    {.name = "no second pass", .settings = "passes=8 pass_gap=0"},
    {.name = "blockers in contact", .settings = "least_gap=0.001"},
    {.name = "blockers all at the kernel", .settings = "least_gap=1"},
    {.name = "parts of a light cut by the horizon",
     .change = StressChange::edgeOn,
     .settings = "views=2",
     .factor = 16},
    {.name = "parts of a light of 3 scene radii",
     .change = StressChange::lightSize,
     .amount = 3,
     .settings = "views=3",
     .factor = 8},
};

/// Texels along the sides of the largest sub-kernel, which is a part of the whole map.
int largestSubKernel(const ParameterValues& p) {
  const bool uniform = p.choice("subdivision") == 0;
  const int parts = uniform ? std::min(p.integer("blocker_cells"), p.integer("visibility_cells")) : 1;
  return (p.integer("shadow_map_size") + parts - 1) / parts;
}

/// Whether the sum of depths over it may exceed one word.
bool needsWideSums(const ParameterValues& p) {
  const int64_t side = largestSubKernel(p);
  return side * side * ((int64_t{1} << p.integer("sat_bits")) - 1) > 0xffffffffLL;
}

frame::TextureHandle depthBounds(shadow::ShadowMapService& service, const shadow::ShadowMaps& maps,
                                 int kind) {
  if (kind == 0) return service.minMaxPyramid(maps).texture;
  return kind == 1 ? service.minMaxWindows(maps) : service.nBuffer(maps);
}

class Vssm : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const ParameterValues& p = inputs.parameters;
    const int subdivision = p.choice("subdivision");
    shadow::VisibilityPass pass =
        shadow::visibilityPass(inputs, request, info.name,
                               {{"POOLED", std::to_string(p.choice("chebyshev"))},
                                {"BLOCKERS_ADAPTIVE", subdivision == 1 ? "1" : "0"},
                                {"VISIBILITY_ADAPTIVE", subdivision == 0 ? "0" : "1"},
                                {"WIDE_Z", needsWideSums(p) ? "1" : "0"},
                                {"BOUNDS_DEPTH", kBoundsLookups[p.choice("bounds")]},
                                {"EARLY_OUT", p.boolean("early_out") ? "1" : "0"},
                                {"CONTACT", std::to_string(p.choice("contact"))}});
    const shadow::SummedAreaTable table = shadow::summedAreaTable(inputs, pass.maps, largestSubKernel(p));
    pass.program.defines["TABLE_FORMAT"] = fmt::format("{}u", table.format);
    pass.sampled = {{"shadow_min_max",
                     depthBounds(inputs.service<shadow::ShadowMapService>(), pass.maps, p.choice("bounds")),
                     "what is lit or dark at once"},
                    {"shadow_table", table.texture, "moments of kernels"}};
    pass.bind = [subdivision, passes = p.integer("passes"), rounds = p.integer("search_rounds"),
                 blockers = p.integer("blocker_cells"), cells = p.integer("visibility_cells"),
                 height = p.integer("tree_height"), contact = p.real("contact_texels"),
                 jittered = p.choice("contact") != 0, pooled = p.choice("chebyshev") != 0,
                 passGap = p.real("pass_gap"),
                 leastGap = p.real("least_gap")](frame::PassContext&, gpu::Program& program) {
      program.set("search_rounds", rounds);
      if (jittered) program.set("contact_texels", contact);
      program.set("passes", passes);
      program.set("pass_gap", passGap);
      if (!pooled) program.set("least_gap", leastGap);
      if (subdivision != 1) program.set("blocker_cells", blockers);
      if (subdivision == 0) program.set("visibility_cells", cells);
      if (subdivision != 0) program.set("tree_height", height);
    };
    return shadow::addVisibilityPass(graph, inputs, request.target, std::move(pass));
  }

 public:
  static constexpr TechniqueInfo info{.name = "vssm",
                                      .title = "Variance soft shadow maps",
                                      .source = "Yang et al. 2010, Variance Soft Shadow Mapping",
                                      .terms = termSet(Term::visibility),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(Vssm::info, Vssm)
