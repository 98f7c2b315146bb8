// Glossy global illumination: links between surface elements leave illumination samples, which leaves reflect
// once.
#include <algorithm>
#include <deque>
#include <memory>

#include "core/base/error.h"
#include "core/scene/scene.h"
#include "core/technique/technique.h"
#include "techniques/illumination_samples/display.h"
#include "techniques/illumination_samples/solution.h"

namespace {

using namespace limn;
using illumination_samples::Display;
using illumination_samples::Elements;
using illumination_samples::Shown;
using illumination_samples::Solution;
using illumination_samples::SolutionSettings;

constexpr const char* kSwitch[] = {"off", "on"};
constexpr const char* kCriteria[] = {"error", "relative"};
constexpr const char* kBases[] = {"haar", "uniform"};
constexpr const char* kReflections[] = {"delayed", "immediate"};
constexpr const char* kDisplays[] = {"pixel", "vertex", "gather"};
constexpr const char* kShows[] = {"light", "tree"};
constexpr Parameter kParameters[] = {
    integer("bounces", 1, {1, 16}, "bounces", "Surfaces that reflect light before the one that is seen"),
    real("link_error", radiosity::SampleSettings::kLinkError, {1e-4, 1}, "of the lights' mean irradiance",
         "How much the light of a link may vary")
        .quality()
        .logScale(),
    real("widen", radiosity::SampleSettings::kWiden, {0, 1}, "of a sample's extent",
         "By how much a sample's extent widens the lobe that reflects it; 0: as published"),
    choice("receiver", 1, kSwitch, "Whether links are refined for narrow lobes at their receivers"),
    real("direction_error", 0.1, {1e-3, 4}, "", "Relative error of light by directions; 0.5 as published")
        .quality()
        .logScale(),
    integer("min_level", 2, {0, 6}, "", "Level that cells of directions have at least; 1 as published"),
    integer("max_level", 8, {0, 10}, "", "Level that they have at most; 3 to 5 as published"),
    choice("criterion", 0, kCriteria,
           "Cells are split while their error counts, or while their light varies, as published"),
    choice("basis", 0, kBases, "Cells of many levels, or linear between the corners of max_level, at most 8"),
    choice("reflection", 0, kReflections,
           "All samples of an element together, or each pushed into it by itself (Sillion et al. 1995)"),
    choice("display", 0, kDisplays,
           "Light of elements towards the pixel, towards the eye from each element (as published), or their "
           "samples reflected at the pixel"),
    choice("show", 0, kShows,
           "Indirect light, with the tree of the element in the middle of the picture in a corner or not"),
    integer("light_rays", 16, {1, 1024}, "rays", "To each extended light, from each element").logScale(),
    real("longest_edge", 0.03, {0.005, 10}, "scene radii", "Longer edges of triangles are halved")
        .quality()
        .logScale(),
    integer("memory", 1024, {1, 16384}, "MiB",
            "Scenes whose samples, trees or light of lights take more are refused"),
    integer(
        "pairs", radiosity::SampleSettings::kMillionPairs, {1, 1000000}, "million",
        "Scenes whose links look at more pairs of elements, over all bounces, are refused; a million takes "
        "about a second of one core")
        .logScale(),
};
constexpr StressCase kStress[] = {
    {.name = "coarse links", .scene = "cornell_box", .settings = "link_error=0.5", .factor = 8},
    {.name = "one point for each light", .scene = "cornell_box", .settings = "light_rays=1", .factor = 2},
    // Larger elements, of which a solution takes less time.
    {.name = "points for samples",
     .scene = "glossy_room",
     .settings = "widen=0 longest_edge=0.1",
     .factor = 4},
    {.name = "no receiver's refinement",
     .scene = "glossy_room",
     .settings = "receiver=off longest_edge=0.1",
     .factor = 2},
    {.name = "gathered samples", .scene = "glossy_room", .settings = "display=gather longest_edge=0.1"},
    {.name = "sixteen cells a face",
     .scene = "glossy_room",
     .settings = "max_level=2 longest_edge=0.1",
     .factor = 4},
    {.name = "coarse directions",
     .scene = "glossy_room",
     .settings = "direction_error=0.5 longest_edge=0.1",
     .factor = 4},
    {.name = "cells of one level",
     .scene = "glossy_room",
     .settings = "basis=uniform max_level=4 longest_edge=0.1",
     .factor = 2},
    {.name = "samples reflected each by itself",
     .scene = "glossy_room",
     .settings = "reflection=immediate max_level=3 link_error=0.03 longest_edge=0.1",
     .factor = 4},
    {.name = "coarse mesh", .scene = "cornell_box", .settings = "longest_edge=10", .factor = 8},
    {.name = "a tree in the corner", .scene = "glossy_room", .settings = "show=tree", .factor = 0},
    {.name = "three bounces", .scene = "cornell_box", .settings = "bounces=3", .factor = 4},
};

class IlluminationSamples : public Technique {
 public:
  static constexpr TechniqueInfo info{
      .name = "illumination_samples",
      .title = "Illumination samples",
      .source = "Stamminger, Scheel, Granier, Perez-Cazorla, Drettakis, Sillion 1999",
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
    using Criterion = radiosity::TreeSettings::Criterion;
    const bool relative = p.choice("criterion") == 1, immediate = p.choice("reflection") == 1;
    radiosity::TreeSettings tree{.criterion = relative ? Criterion::relative : Criterion::transport,
                                 .error = p.real("direction_error"),
                                 .minLevel = std::min(p.integer("min_level"), p.integer("max_level")),
                                 .maxLevel = p.integer("max_level"),
                                 .frozen = !immediate,
                                 .memory = uint64_t(p.integer("memory")) << 20};
    if (p.choice("basis") == 1) {
      tree.basis = radiosity::TreeSettings::Basis::uniform;
      tree.maxLevel = std::min(tree.maxLevel, radiosity::DirectionalTree::kMaxUniformLevel);
    }
    radiosity::TreeSettings shownTree = tree;
    if (!relative) shownTree.criterion = Criterion::display;
    const auto shown = static_cast<Shown>(p.choice("display"));
    const bool drawTree = p.choice("show") == 1;
    if (drawTree && shown == Shown::gathered)
      throw UsageError("illumination_samples: show=tree goes with display=pixel and display=vertex");
    const SolutionSettings settings{.samples = {.linkError = p.real("link_error"),
                                                .widen = p.real("widen"),
                                                .receiver = p.choice("receiver") == 1,
                                                .tree = tree,
                                                .immediate = immediate,
                                                .memory = tree.memory,
                                                .pairs = uint64_t(p.integer("pairs")) * 1'000'000},
                                    .shownTree = shownTree,
                                    .shown = shown,
                                    .drawTree = drawTree,
                                    .bounces = p.integer("bounces"),
                                    .lightRays = p.integer("light_rays"),
                                    .longestEdge = p.real("longest_edge"),
                                    .technique = info.name};
    if (!elements_) {
      elements_ = std::make_unique<Elements>(graph, inputs, settings);
      display_ = std::make_unique<Display>(*elements_, settings);
    }
    auto known = std::ranges::find_if(
        solutions_, [&](const Solution& s) { return std::ranges::equal(s.lights(), request.lights); });
    if (known == solutions_.end()) {
      solutions_.emplace_back(graph, inputs, *elements_, request.lights, settings);
      known = std::prev(solutions_.end());
    }
    return display_->show(graph, inputs, *known, request.target);
  }

  bool update(const scene::Pose& pose) override { return elements_ && !elements_->fits(pose); }

  std::unique_ptr<Elements> elements_;
  std::deque<Solution> solutions_;
  std::unique_ptr<Display> display_;
};

}  // namespace

LIMN_TECHNIQUE(IlluminationSamples::info, IlluminationSamples)
