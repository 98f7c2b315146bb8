// Global illumination by implicit visibility: radiosity whose links, the shortest in their bin of directions,
// say what a surface element sees.
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "core/reference/environment.h"
#include "core/scene/gpu_scene.h"
#include "core/technique/technique.h"
#include "glsl/gbuffer.glsl"
#include "techniques/implicit_visibility/display.h"
#include "techniques/implicit_visibility/element_passes.h"

namespace {

using namespace limn;
using frame::Access;
using frame::BufferHandle;
using implicit_visibility::Display;
using implicit_visibility::ElementPasses;
using implicit_visibility::Gathered;
using implicit_visibility::LinkChunk;

constexpr const char* structures[] = {"hierarchical", "flat"};
constexpr const char* fills[] = {"centre", "footprint"};
constexpr const char* displays[] = {"vertex", "pixel"};
constexpr Parameter parameters[] = {
    integer("bins", 16, {4, 32}, "bins", "N of the 6 x N x N bins of directions").quality().logScale(),
    integer("bounces", 1, {1, 16}, "bounces", "Surfaces that reflect light before the one that is seen"),
    choice("structure", 0, structures, "Links through the hierarchy, or every pair of surface elements"),
    choice(
        "fill", 1, fills,
        "Bins that an element fills: the one of its centre, as published, or those whose centres it covers"),
    real("opening", 2, {0.05, 16}, "bins", "Solid angle above which elements are opened; 1: as published")
        .logScale(),
    real("longest_edge", 0.05, {0.005, 10}, "scene radii", "Longer edges of triangles are halved").logScale(),
    choice("display", 0, displays,
           "Irradiance of vertices, interpolated, or bins gathered with the BRDF per pixel"),
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
  /// What a request needs throughout.
  using Request = implicit_visibility::DisplayRequest;
  /// Visibility of some lights at all leaves.
  struct Seen {
    std::vector<uint32_t> lights;
    gpu::Buffer indexBuffer;
    BufferHandle indices, seen;
  };

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const Request r{graph, inputs, request.target};
    const bool sky =
        request.term == Term::environment || (inputs.scene.environment && asksForAll(inputs, request));
    if (request.term == Term::indirect && request.lights.empty() && !sky) {
      graph.leaveOut("indirect light", info.name, "the scene has no light");
      return request.target;
    }
    begin(graph, inputs);
    if (request.term == Term::visibility) return display_->visibility(r, seenBy(r, request.lights).seen);
    if (request.term == Term::environment) return display_->light(r, skyLight(r));
    auto [direct, outgoing] = directLight(r, request.lights, sky);
    Gathered gathered;
    for (int bounce = 1; bounce <= inputs.parameters.integer("bounces"); ++bounce) {
      const BufferHandle pulled = pullUp(r, outgoing);
      BufferHandle next;
      gathered = gather(r, pulled, direct, next);
      outgoing = next;
    }
    return display_->light(r, gathered);
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
    elements_ = std::make_unique<ElementPasses>(
        graph, inputs,
        implicit_visibility::ElementSettings{.links = {.resolution = p.integer("bins"),
                                                       .fill = static_cast<radiosity::Fill>(p.choice("fill")),
                                                       .opening = p.real("opening")},
                                             .flat = p.choice("structure") == 1,
                                             .longestEdge = p.real("longest_edge"),
                                             .memory = int64_t{p.integer("memory")} << 20,
                                             .technique = info.name});
    display_ = std::make_unique<Display>(*elements_, info.name);
  }

  BufferHandle perSlot(const Request& r, const char* name) const {
    return r.graph.createBuffer(name, {std::max<size_t>(elements_->slots(), 1) * sizeof(glm::vec4)});
  }

  /// Visibility of lights at the leaves; shared by those who ask for the same lights.
  const Seen& seenBy(const Request& r, std::span<const uint32_t> lights) {
    for (const Seen& known : seen_)
      if (std::ranges::equal(known.lights, lights)) return known;
    Seen& s = seen_.emplace_back();
    s.lights.assign(lights.begin(), lights.end());
    s.indexBuffer =
        gpu::Buffer::of(r.inputs.gpuScene.device(), "lights asked for", std::span<const uint32_t>(s.lights));
    s.indices = r.graph.importBuffer(fmt::format("lights asked for {}", seen_.size()), s.indexBuffer);
    frame::PassBuilder pass = r.graph.addPass("light visibility", info.name);
    elements_->readLinks(pass);
    pass.read(r.inputs.handles.lights, Access::storageLoad, "lights")
        .read(elements_->groups, Access::storageLoad, "how far elements are")
        .read(s.indices, Access::storageLoad, "which lights")
        .cacheable();
    const size_t bytes = std::max<size_t>(lights.size() * elements_->leafSlots(), 4) * sizeof(float);
    s.seen = pass.write(r.graph.createBuffer("visibility of lights", {bytes}), Access::storageStore,
                        "V of each leaf");
    const auto kernelHandle = elements_->program(pass, "light_visibility.comp.glsl");
    pass.execute([this, kernelHandle, lightBuffer = r.inputs.handles.lights, indices = s.indices,
                  seen = s.seen, count = static_cast<int>(lights.size()),
                  samples = r.inputs.parameters.integer("light_samples")](frame::PassContext& context) {
      gpu::Program& kernel = context.program(kernelHandle);
      kernel.use();
      elements_->setSpace(kernel);
      kernel.set("slots", elements_->leafSlots());
      kernel.set("samples", static_cast<unsigned>(samples));
      kernel.set("unit", elements_->elements().space().radius());
      context.bindStorage(0, lightBuffer);
      context.bindStorage(1, elements_->leaves);
      context.bindStorage(3, elements_->groups);
      context.bindStorage(4, indices);
      context.bindStorage(5, seen);
      for (const LinkChunk& chunk : elements_->chunks) {
        ElementPasses::bind(context, kernel, chunk);
        context.dispatch(static_cast<int>(chunk.count), count, 1, 64, 1);
      }
    });
    return s;
  }

  /// Radiance that leaves reflect of lights and environment, twice: to keep, and to be pulled up.
  std::pair<BufferHandle, BufferHandle> directLight(const Request& r, std::span<const uint32_t> lights,
                                                    bool sky) {
    const Seen* seen = lights.empty() ? nullptr : &seenBy(r, lights);
    const BufferHandle skyIrradiance = sky ? skyLight(r).irradiance : BufferHandle{};
    frame::PassBuilder pass = r.graph.addPass("direct light", info.name);
    pass.read(r.inputs.handles.lights, Access::storageLoad, "lights")
        .read(elements_->leaves, Access::storageLoad, "normals and albedos")
        .cacheable();
    if (seen)
      pass.read(seen->seen, Access::storageLoad, "V of each light")
          .read(seen->indices, Access::storageLoad, "which lights");
    if (sky) pass.read(skyIrradiance, Access::storageLoad, "irradiance of the environment");
    const BufferHandle direct =
        pass.write(perSlot(r, "direct light"), Access::storageStore, "reflected by leaves");
    const BufferHandle outgoing =
        pass.write(perSlot(r, "outgoing"), Access::storageStore, "the same, before it is pulled up");
    const auto kernelHandle = elements_->program(
        pass, "direct.comp.glsl", {{"LIGHTS", seen ? "1" : "0"}, {"ENVIRONMENT", sky ? "1" : "0"}});
    pass.execute([this, kernelHandle, seen, skyIrradiance, direct, outgoing,
                  lightBuffer = r.inputs.handles.lights, count = lights.size()](frame::PassContext& context) {
      gpu::Program& kernel = context.program(kernelHandle);
      kernel.use();
      kernel.set("slots", elements_->leafSlots());
      context.bindStorage(0, lightBuffer);
      context.bindStorage(1, elements_->leaves);
      context.bindStorage(2, direct);
      context.bindStorage(3, outgoing);
      if (seen) {
        kernel.set("light_count", static_cast<unsigned>(count));
        context.bindStorage(4, seen->indices);
        context.bindStorage(5, seen->seen);
      }
      if (skyIrradiance) context.bindStorage(6, skyIrradiance);
      context.dispatch(static_cast<int>(elements_->leafSlots()), 1, 1, 64, 1);
    });
    return {direct, outgoing};
  }

  /// Levels above the leaves take their children's mean (thesis: pull-up).
  BufferHandle pullUp(const Request& r, BufferHandle outgoing) {
    const auto levels = elements_->elements().forest().levels();
    for (size_t level = 1; level < levels.size(); ++level) {
      frame::PassBuilder pass = r.graph.addPass("pull up", info.name);
      pass.read(elements_->groups, Access::storageLoad, "children and areas").cacheable();
      outgoing = pass.write(outgoing, Access::storageLoadStore, "radiance of the next level");
      const auto kernelHandle = elements_->program(pass, "pull_up.comp.glsl");
      pass.execute([this, kernelHandle, outgoing, range = levels[level]](frame::PassContext& context) {
        gpu::Program& kernel = context.program(kernelHandle);
        kernel.use();
        kernel.set("first_group", range.first);
        kernel.set("group_count", range.count);
        context.bindStorage(0, elements_->groups);
        context.bindStorage(1, outgoing);
        context.dispatch(static_cast<int>(4 * range.count), 1, 1, 64, 1);
      });
    }
    return outgoing;
  }

  /// Irradiance of the leaves from `outgoing`, and in `next` what they then send on.
  Gathered gather(const Request& r, BufferHandle outgoing, BufferHandle direct, BufferHandle& next) {
    frame::PassBuilder pass = r.graph.addPass("gather", info.name);
    elements_->readLinks(pass);
    pass.read(outgoing, Access::storageLoad, "radiance of elements")
        .read(direct, Access::storageLoad, "direct light, reflected by leaves")
        .cacheable();
    const BufferHandle irradiance = pass.write(perSlot(r, "irradiance"), Access::storageStore, "of leaves");
    const BufferHandle sent = pass.write(perSlot(r, "outgoing"), Access::storageStore, "reflected by leaves");
    const auto kernelHandle = elements_->program(pass, "gather.comp.glsl", {{"SKY", "0"}});
    pass.execute([this, kernelHandle, outgoing, direct, irradiance, sent](frame::PassContext& context) {
      gpu::Program& kernel = context.program(kernelHandle);
      kernel.use();
      context.bindStorage(3, outgoing);
      context.bindStorage(5, direct);
      context.bindStorage(6, sent);
      gatherChunks(context, kernel, irradiance);
    });
    next = sent;
    return {irradiance, outgoing, false};
  }

  void gatherChunks(frame::PassContext& context, gpu::Program& kernel, BufferHandle irradiance) const {
    elements_->setSpace(kernel);
    context.bindStorage(0, elements_->directions);
    context.bindStorage(1, elements_->leaves);
    context.bindStorage(4, irradiance);
    for (const LinkChunk& chunk : elements_->chunks) {
      ElementPasses::bind(context, kernel, chunk);
      constexpr int most = 32768;  // work groups in a row, see gather.comp.glsl
      const int count = static_cast<int>(chunk.count);
      context.dispatch(std::min(count, most), (count + most - 1) / most, 1, 1, 1);
    }
  }

  /// Irradiance of the leaves from the environment in their empty bins.
  const Gathered& skyLight(const Request& r) {
    if (sky_) return *sky_;
    environment_ = gpu::Buffer::of<glm::vec4>(r.inputs.gpuScene.device(), "environment of bins",
                                              skyBins(r.inputs.scene));
    const BufferHandle bins = r.graph.importBuffer("environment of bins", environment_);
    frame::PassBuilder pass = r.graph.addPass("environment light", info.name);
    elements_->readLinks(pass);
    pass.read(bins, Access::storageLoad, "radiance of bins").cacheable();
    const BufferHandle irradiance =
        pass.write(perSlot(r, "environment's irradiance"), Access::storageStore, "of leaves");
    const auto kernelHandle = elements_->program(pass, "gather.comp.glsl", {{"SKY", "1"}});
    pass.execute([this, kernelHandle, bins, irradiance](frame::PassContext& context) {
      gpu::Program& kernel = context.program(kernelHandle);
      kernel.use();
      context.bindStorage(3, bins);
      gatherChunks(context, kernel, irradiance);
    });
    sky_ = Gathered{irradiance, bins, true};
    return *sky_;
  }

  /// The environment's mean radiance over each bin.
  std::vector<glm::vec4> skyBins(const scene::Scene& scene) const {
    const reference::EnvironmentLight environment(scene.environment);
    const auto n = static_cast<uint32_t>(std::sqrt(static_cast<double>(elements_->binCount()) / 6) + 0.5);
    // Four samples for each pixel of the map, so that no small bright one is missed.
    const double pixels = double(scene.environment.width) * scene.environment.height;
    const int side =
        std::clamp(static_cast<int>(std::ceil(2 * std::sqrt(pixels / double(elements_->binCount())))), 2, 64);
    std::vector<glm::vec4> bins;
    for (uint32_t bin = 0; bin < 6 * n * n; ++bin) {
      glm::vec3 sum(0);
      float weights = 0;
      for (int s = 0; s < side * side; ++s) {
        const glm::vec2 in((static_cast<float>(s % side) + 0.5f) / float(side),
                           (static_cast<float>(s / side) + 0.5f) / float(side));
        const glm::vec2 place = (glm::vec2(float(bin % n), float(bin / n % n)) + in) * (2 / float(n)) - 1.f;
        const glm::vec3 ray = glsl::bin_face_direction(bin / (n * n), place);
        const float length2 = glm::dot(ray, ray), weight = 1 / (length2 * std::sqrt(length2));
        sum +=
            weight * environment.radiance(glm::normalize(elements_->elements().space().worldDirection(ray)));
        weights += weight;
      }
      bins.emplace_back(sum / weights, 0);
    }
    return bins;
  }

  std::unique_ptr<ElementPasses> elements_;
  std::deque<Seen> seen_;
  std::optional<Gathered> sky_;
  gpu::Buffer environment_;
  std::unique_ptr<Display> display_;
};

}  // namespace

LIMN_TECHNIQUE(ImplicitVisibility::info, ImplicitVisibility)
