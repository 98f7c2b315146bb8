// Shadow rays through a hierarchy in buffers, n to each pixel: what soft shadows are made of where there is
// the time, or hardware, for rays.
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/gpu_scene/gpu_scene.h"
#include "core/history/frame_history.h"
#include "core/rays/blue_noise.h"
#include "core/rays/ray_geometry.h"
#include "core/technique/light_batch.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;
using frame::Access;

enum Filter { kNone, kSpatial };
constexpr const char* kFilters[] = {"none", "spatial"};
constexpr Parameter kParameters[] = {
    integer("rays", 4, {1, 256}, "rays", "Shadow rays of a pixel to each light that has an extent")
        .quality()
        .logScale(),
    choice("filter", kSpatial, kFilters,
           "What becomes of the noise: none: it stays; spatial: it is averaged over 7 x 7 pixels of the same "
           "surface, as far as the rays' own variance explains the differences"),
    integer("history", 1, {1, history::FrameHistoryService::kMostFrames}, "frames",
            "Frames whose V is averaged where they show the same surface, each with rays of its own; 1: this "
            "frame's alone"),
};
constexpr StressCase kStress[] = {
    {.name = "one ray", .settings = "rays=1", .factor = 4},
    {.name = "one ray, unfiltered", .settings = "rays=1 filter=none", .factor = 4},
    {.name = "four frames", .settings = "history=4"},
    {.name = "most rays", .settings = "rays=256", .factor = 1.5},
};

constexpr int kNoiseSide = 64;

/// Returns a tile of shifts: thresholds of their own along both axes.
const std::vector<glm::vec2>& shifts() {
  static const std::vector<glm::vec2> tile = [] {
    const std::vector<float> u = rays::blueNoise(kNoiseSide, 1), v = rays::blueNoise(kNoiseSide, 2);
    std::vector<glm::vec2> both;
    for (size_t i = 0; i < u.size(); ++i) both.emplace_back(u[i], v[i]);
    return both;
  }();
  return tile;
}

class RayTracedAreaLight : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const int frames = inputs.parameters.integer("history");
    const bool spatial = inputs.parameters.choice("filter") == kSpatial;
    if (frames == 1) graph.leaveOut("average frames", info.name, "history is 1");
    if (frames == 1 && !spatial) return trace(graph, inputs, request, request.target);
    gpu::TextureDesc desc = graph.desc(request.target);
    if (frames > 1) desc.format = GL_RGBA32F;
    const frame::TextureHandle now = trace(graph, inputs, request, graph.createTexture("traced", desc));
    if (frames == 1) return filter(graph, inputs, request, now, {});
    const frame::TextureHandle sums =
        inputs.service<history::FrameHistoryService>().average(inputs.gbuffer, now, frames, info.name);
    return spatial ? filter(graph, inputs, request, sums, now) : mean(graph, inputs, request, sums, now);
  }

  /// Declares what tells lights of which one ray is exact from others, and where their V is when `traced` is
  /// a sum over frames; `now`: empty when it is not.
  static void readTraced(frame::PassBuilder& pass, const TechniqueInputs& inputs, frame::TextureHandle traced,
                         frame::TextureHandle now) {
    pass.read(inputs.handles.lights, Access::storageLoad, "Lights", "which of them leave noise")
        .read(traced, Access::sampled, "traced", "V with noise");
    if (now) pass.read(now, Access::sampled, "this_frame", "V of lights without extent, which is exact");
  }

  /// V without the noise of few rays.
  static frame::TextureHandle filter(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                     const TermRequest& request, frame::TextureHandle traced,
                                     frame::TextureHandle now) {
    frame::PassBuilder pass = graph.addPass("filter", info.name);
    pass.role(frame::PassRole::filter)
        .read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "neighbours on the same surface")
        .read(inputs.gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal, "its plane");
    readTraced(pass, inputs, traced, now);
    const frame::TextureHandle target =
        pass.write(request.target, Access::imageStore, "visibility", "visibility, one layer per light");
    const frame::ProgramHandle program =
        pass.program({.files = {"techniques/ray_traced_area_light/filter.comp.glsl"},
                      .defines = {{"LIGHT_COUNT", std::to_string(request.lights.size())},
                                  {"FRAMES", std::to_string(inputs.parameters.integer("history"))}}});
    pass.execute(dispatch(program, inputs, request));
    return target;
  }

  /// V of several frames with all its noise.
  static frame::TextureHandle mean(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                   const TermRequest& request, frame::TextureHandle traced,
                                   frame::TextureHandle now) {
    frame::PassBuilder pass = graph.addPass("mean of frames", info.name);
    pass.role(frame::PassRole::filter);
    readTraced(pass, inputs, traced, now);
    const frame::TextureHandle target =
        pass.write(request.target, Access::imageStore, "visibility", "visibility, one layer per light");
    const frame::ProgramHandle program =
        pass.program({.files = {"techniques/ray_traced_area_light/mean.comp.glsl"},
                      .defines = {{"LIGHT_COUNT", std::to_string(request.lights.size())}}});
    pass.execute([program, size = inputs.size,
                  lights = std::vector<uint32_t>(request.lights.begin(), request.lights.end())](
                     frame::PassContext& context) {
      setLightIndices(context.use(program), lights);
      context.dispatch(size.x, size.y, static_cast<int>(lights.size()), 8, 8);
    });
    return target;
  }

  frame::TextureHandle trace(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                             const TermRequest& request, frame::TextureHandle into) {
    const rays::RayGeometry& geometry = inputs.service<rays::RayGeometryService>().request();
    frame::PassBuilder pass = graph.addPass("visibility", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(inputs.handles.lights, Access::storageLoad, "Lights", "where rays go")
        .read(inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "receivers")
        .read(inputs.gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal,
              "which part of a light counts")
        .read(inputs.gbuffer.instance, Access::sampled, kGBufferNames.instance, "a light does not see itself")
        .constant("blue_noise", noise(inputs));
    geometry.declare(pass);
    const int frames = inputs.parameters.integer("history");
    gpu::ProgramDesc program{.files = {"techniques/ray_traced_area_light/visibility.comp.glsl"},
                             .defines = {{"LIGHT_COUNT", std::to_string(request.lights.size())},
                                         {"FRAMES", std::to_string(frames)},
                                         {"TRACED", frames > 1 ? "rgba32f" : "r16"}}};
    geometry.define(program.defines);
    const frame::TextureHandle target =
        pass.write(into, Access::imageStore, "visibility", "visibility, one layer per light");
    const frame::ProgramHandle handle = pass.program(std::move(program));
    pass.execute(dispatch(handle, inputs, request));
    return target;
  }

  /// Returns what runs a program for every pixel and light.
  static std::function<void(frame::PassContext&)> dispatch(frame::ProgramHandle program,
                                                           const TechniqueInputs& inputs,
                                                           const TermRequest& request) {
    return [program, size = inputs.size, rays = inputs.parameters.integer("rays"),
            lights = std::vector<uint32_t>(request.lights.begin(), request.lights.end())](
               frame::PassContext& context) {
      gpu::Program& kernel = context.use(program);
      setLightIndices(kernel, lights);
      kernel.set("rays", rays);
      context.dispatch(size.x, size.y, static_cast<int>(lights.size()), 8, 8);
    };
  }

  const gpu::Texture& noise(const TechniqueInputs& inputs) {
    if (!noise_) {
      noise_ = gpu::Texture(inputs.gpuScene.device(), "shifts of rays",
                            {.format = GL_RG32F, .width = kNoiseSide, .height = kNoiseSide});
      noise_.upload(0, 0, GL_RG, GL_FLOAT, shifts().data());
    }
    return noise_;
  }

  gpu::Texture noise_;

 public:
  static constexpr TechniqueInfo info{.name = "ray_traced_area_light",
                                      .title = "Ray-traced area lights",
                                      .source = "Ylitie et al. 2017, Efficient Incoherent Ray Traversal",
                                      .terms = termSet(Term::visibility),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(RayTracedAreaLight::info, RayTracedAreaLight)
