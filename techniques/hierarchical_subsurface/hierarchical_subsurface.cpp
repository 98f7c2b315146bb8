// Light below surfaces from points all over each translucent body, far ones in clusters.
#include <map>
#include <optional>
#include <string>

#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/diffusion_profile.h"
#include "core/shadow/entering_light.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"
#include "techniques/hierarchical_subsurface/body_points.h"

namespace {

using namespace limn;
using frame::Access;
using hierarchical_subsurface::BodyPoints;

constexpr Parameter kParameters[] = {
    scene::profileParameter(),
    integer("points", 16384, {16, 65536}, "points",
            "About how many there are on each body; bodies with more vertices have a point at each")
        .quality()
        .logScale(),
    real("tolerance", 0.1, {0.01, 1}, "sr",
         "Clusters of points that look larger from a pixel are opened; small ones count as one point")
        .quality()
        .logScale(),
    shadow::shadowMapSizeParameter(),
    shadow::biasParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "16 points", .scene = "translucent_spheres", .settings = "points=16", .factor = 0},
    {.name = "65536 points", .scene = "translucent_spheres", .settings = "points=65536"},
    {.name = "large clusters", .scene = "translucent_spheres", .settings = "tolerance=1", .factor = 0},
    {.name = "map of 16 texels",
     .scene = "translucent_spheres",
     .settings = "shadow_map_size=16",
     .factor = 0},
};

class HierarchicalSubsurface : public Technique {
 public:
  static constexpr TechniqueInfo info{.name = "hierarchical_subsurface",
                                      .title = "Subsurface scattering from a hierarchy of points",
                                      .source =
                                          "Jensen, Buhler 2002, A Rapid Hierarchical Rendering Technique for "
                                          "Translucent Materials",
                                      .terms = termSet(Term::subsurface),
                                      .parameters = kParameters,
                                      .stress = kStress};

 private:
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    points_.emplace(inputs.scene, inputs.pose, inputs.parameters.integer("points"),
                    inputs.gpuScene.device().limits().maxStorageBlockBytes);
    createBuffers(inputs.gpuScene.device());
    addUpdate(graph, inputs);
    return addGather(graph, inputs, request.target, addSums(graph, addLight(graph, inputs, request)));
  }

  bool update(const scene::Pose& pose) override { return points_ && !points_->fits(pose); }

  void createBuffers(gpu::Device& device) {
    const auto nodes = points_->tree().nodes();
    bodyBuffer_ = gpu::Buffer::of(device, "translucent bodies", points_->bodies(), gpu::BufferUse::updated);
    pointBuffer_ = gpu::Buffer::of(device, "points of bodies", points_->points(), gpu::BufferUse::updated);
    nodeBuffer_ = gpu::Buffer::of(device, "clusters of points", nodes, gpu::BufferUse::updated);
  }

  void addUpdate(frame::FrameGraph& graph, const TechniqueInputs& inputs) {
    frame::PassBuilder pass = graph.addPass("update points", info.name);
    pass.read(inputs.handles.geometry, Access::storageLoad, "vertices, which the CPU moves as well")
        .read(inputs.handles.instances, Access::storageLoad, "where instances are")
        .cacheable();
    bodies_ = pass.write(graph.importBuffer("translucent bodies", bodyBuffer_), Access::copyTarget,
                         "matter and extent of each draw");
    lit_ = pass.write(graph.importBuffer("points of bodies", pointBuffer_), Access::copyTarget,
                      "places and normals");
    nodes_ = pass.write(graph.importBuffer("clusters of points", nodeBuffer_), Access::copyTarget,
                        "places and areas of all levels");
    pass.execute([this, &pose = inputs.pose](frame::PassContext&) {
      points_->update(pose);
      const auto upload = [](gpu::Buffer& buffer, const auto& values) {
        buffer.update(0, values.data(), values.size_bytes());
      };
      upload(bodyBuffer_, points_->bodies());
      upload(pointBuffer_, points_->points());
      upload(nodeBuffer_, points_->tree().nodes());
    });
  }

  frame::BufferHandle addLight(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                               const TermRequest& request) {
    const shadow::EnteringLight light(inputs, request, inputs.parameters.integer("shadow_map_size"));
    frame::PassBuilder pass = graph.addPass("light points", info.name);
    std::map<std::string, std::string> defines;
    light.declare(pass, inputs, defines);
    pass.read(lit_, Access::storageLoad, "Points", "places and normals");
    if (!request.lights.empty()) pass.read(bodies_, Access::storageLoad, "Bodies", "what boundaries let in");
    const size_t bytes = points_->tree().nodes().size() * sizeof(glm::vec4);
    const frame::BufferHandle entering =
        pass.write(graph.createBuffer("light that enters at points", {std::max<size_t>(bytes, 16)}),
                   Access::storageStore, "Entering", "E / pi of each point");
    const auto program = pass.program(
        {.files = {"techniques/hierarchical_subsurface/light_points.comp.glsl"}, .defines = defines});
    pass.execute([program, light, count = points_->tree().leafCount(),
                  bias = inputs.parameters.real("bias")](frame::PassContext& context) {
      gpu::Program& kernel = context.use(program);
      kernel.set("point_count", count);
      light.set(kernel, bias);
      context.dispatchRows((int64_t{count} + 63) / 64);
    });
    return entering;
  }

  frame::BufferHandle addSums(frame::FrameGraph& graph, frame::BufferHandle entering) {
    const auto levels = points_->tree().levels();
    for (size_t level = 1; level < levels.size(); ++level) {
      frame::PassBuilder pass = graph.addPass("sum clusters", info.name);
      pass.read(nodes_, Access::storageLoad, "Nodes", "children and areas");
      entering = pass.write(entering, Access::storageLoadStore, "Entering", "E / pi of the next level");
      const auto program = pass.program(
          {.files = {"techniques/hierarchical_subsurface/sum_clusters.comp.glsl"}, .defines = {}});
      pass.execute([program, range = levels[level]](frame::PassContext& context) {
        gpu::Program& kernel = context.use(program);
        kernel.set("first_node", range.first);
        kernel.set("node_count", range.count);
        context.dispatchRows((int64_t{range.count} + 63) / 64);
      });
    }
    return entering;
  }

  frame::TextureHandle addGather(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 frame::TextureHandle target, frame::BufferHandle entering) const {
    frame::PassBuilder pass = graph.addPass("gather", info.name);
    readSurfaces(pass, inputs.gbuffer);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(inputs.gbuffer.instance, Access::sampled, kGBufferNames.instance, "bodies of pixels")
        .read(inputs.entering, Access::sampled, "entering", "light that leaves near where it enters")
        .read(bodies_, Access::storageLoad, "Bodies", "matter and extent")
        .read(nodes_, Access::storageLoad, "Nodes", "where points and clusters are")
        .read(entering, Access::storageLoad, "Entering", "light that enters there");
    const frame::TextureHandle result =
        pass.write(target, Access::imageLoadStore, "radiance", "light from below surfaces");
    const auto program =
        pass.program({.files = {"techniques/hierarchical_subsurface/gather.comp.glsl"},
                      .defines = {{"NORMALISED", scene::normalisedProfile(inputs.parameters) ? "1" : "0"}}});
    pass.execute([program, size = inputs.size,
                  tolerance = inputs.parameters.real("tolerance")](frame::PassContext& context) {
      context.use(program).set("tolerance", tolerance);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return result;
  }

  std::optional<BodyPoints> points_;
  gpu::Buffer bodyBuffer_, pointBuffer_, nodeBuffer_;
  frame::BufferHandle bodies_, lit_, nodes_;
};

}  // namespace

LIMN_TECHNIQUE(HierarchicalSubsurface::info, HierarchicalSubsurface)
