// What the camera sees in mirrors and glass: the picture of everything else, found in image space.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <memory>

#include "core/caustics/specular_buffers.h"
#include "core/gpu_scene/gpu_medium.h"
#include "core/scene/camera.h"
#include "core/shading_maps/shading_maps.h"
#include "core/technique/technique.h"
#include "glsl/scene/blocks.glsl"

namespace {

using namespace limn;
using frame::Access;
using frame::TextureHandle;

constexpr Parameter kParameters[] = {
    integer(
        "interfaces", 2, {1, 16}, "interfaces",
        "Most smooth interfaces between the camera and the scene; more follow light totally reflected inside")
        .quality(),
    integer("buffer_size", 1024, {16, 8192}, "texels",
            "Side of the buffers of the specular objects' front and back, as the camera sees them")
        .quality()
        .logScale(),
    caustics::exitStepsParameter(),
    integer("steps", 64, {1, 4096}, "points", "Of the search for the surface that a ray meets on the screen")
        .quality()
        .logScale(),
    scene::mediumStepsParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "mirror", .scene = "ring"},
    {.name = "facets", .scene = "gem", .factor = 3},
    {.name = "object fills the screen",
     .change = StressChange::cameraNear,
     .amount = 1.05,
     .scene = "gem",
     .factor = 0},
    {.name = "index of refraction 1.0001",
     .change = StressChange::refraction,
     .amount = 1.0001,
     .scene = "glass_sphere"},
    {.name = "index of refraction 3",
     .change = StressChange::refraction,
     .amount = 3,
     .scene = "glass_sphere",
     .factor = 3},
    {.name = "16 interfaces", .scene = "gem", .settings = "interfaces=16", .factor = 3},
    {.name = "buffer of 16 texels", .scene = "glass_sphere", .settings = "buffer_size=16", .factor = 0},
    {.name = "one step", .scene = "glass_sphere", .settings = "steps=1", .factor = 0},
    {.name = "one step through glass", .scene = "glass_sphere", .settings = "exit_steps=1", .factor = 0},
    {.name = "1024 steps through glass", .scene = "glass_sphere", .settings = "exit_steps=1024"},
};

/// The camera as a view of the specular objects: a square around the picture. The matrix may be sheared, for
/// samples beside the middle of a pixel: the picture then lies beside the axis.
glsl::ShadowView viewOf(const scene::CameraPose& camera, const scene::Bounds& objects, glm::ivec2 picture,
                        int size) {
  const glm::mat4 viewToWorld(glm::inverse(glm::dmat4(camera.worldToView)));
  const glm::vec3 x = glm::normalize(glm::vec3(viewToWorld[0])),
                  y = glm::normalize(glm::vec3(viewToWorld[1]));
  const glm::vec3 middle = -glm::vec3(viewToWorld[2]);  // of the picture, 1 m deep
  const float aspect = static_cast<float>(picture.x) / static_cast<float>(picture.y);
  const float tangent =
      std::tan(0.5f * camera.yfov) * std::max(aspect, 1.f) * (1 + 4 / static_cast<float>(size));
  const scene::DepthRange range = scene::fitDepthRange(camera, objects);
  glsl::ShadowView view{};
  view.origin = glm::vec3(viewToWorld[3]);
  view.near = range.near;
  view.axis_x = x;
  view.scale = 0.5f / tangent;
  view.axis_y = y;
  view.footprint = 2 * tangent / static_cast<float>(size);
  view.axis_z = glm::cross(y, x);
  view.far = range.far;
  view.middle = 0.5f - view.scale * glm::vec2(glm::dot(x, middle), glm::dot(y, middle));
  view.projection = glsl::shadow_perspective;
  view.size = static_cast<uint32_t>(size);
  view.light = glsl::no_light;
  return view;
}

class ImageSpaceRefraction : public Technique {
  frame::FrameGraph* graph_ = nullptr;
  scene::GpuScene* scene_ = nullptr;
  std::unique_ptr<caustics::SpecularBuffers> buffers_;
  glm::ivec2 picture_{1};
  int size_ = 1;
  glsl::ShadowView view_{};
  float diameter_ = 0;  ///< of the widest specular object, metres
  gpu::Buffer viewBuffer_;
  frame::BufferHandle views_;

  /// True: the view is another one.
  bool fit() {
    const scene::Bounds objects = scene_->specularBounds();
    diameter_ = buffers_->widest();
    const glsl::ShadowView before = view_;
    view_ = viewOf(scene_->camera(), objects, picture_, size_);
    return std::memcmp(&before, &view_, sizeof(view_)) != 0;
  }

  TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                          const TermRequest& request) override {
    graph_ = &graph;
    scene_ = &inputs.gpuScene;
    picture_ = inputs.size;
    size_ = std::min(inputs.parameters.integer("buffer_size"), scene_->device().limits().maxTextureSize);
    buffers_ = std::make_unique<caustics::SpecularBuffers>(inputs.gpuScene);
    fit();
    buffers_->setViews({&view_, 1});
    viewBuffer_ = gpu::Buffer::of<glsl::ShadowView>(scene_->device(), "camera's view of specular objects",
                                                    {&view_, 1}, gpu::BufferUse::updated);
    views_ = graph.importBuffer("camera's view of specular objects", viewBuffer_);
    buffers_->add(graph, inputs.handles, views_, size_, caustics::GeometricNormals::none, info.name);
    return addRefraction(inputs, request.target);
  }

  TextureHandle addRefraction(const TechniqueInputs& inputs, TextureHandle background) {
    const GBuffer& g = inputs.gbuffer;
    const caustics::SpecularBuffer &front = buffers_->front(), &back = buffers_->back();
    frame::PassBuilder pass = graph_->addPass("refraction", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera, medium")
        .read(inputs.handles.instances, Access::storageLoad, "Instances", "materials of instances")
        .read(inputs.handles.materials, Access::storageLoad, "Materials", "index of refraction, colours")
        .read(views_, Access::storageLoad, "Views", "the camera's view of specular objects");
    readSurfaces(pass, g);
    pass.read(g.instance, Access::sampled, kGBufferNames.instance, "objects")
        .read(front.surface, Access::sampled, "front_surface", "where light enters objects")
        .read(front.depth, Access::sampled, "front_depth", "where light enters objects")
        .read(back.surface, Access::sampled, "back_surface", "where light leaves objects")
        .read(back.depth, Access::sampled, "back_depth", "where light leaves objects")
        .read(inputs.matte.depth, Access::sampled, "matte_depth", "what rays meet")
        .read(inputs.matte.geometricNormal, Access::sampled, "matte_normal", "what rays meet")
        .read(background, Access::sampled, "matte_radiance", "light of what rays meet");
    const TextureHandle environment = inputs.service<shading_maps::ShadingMapService>().radiance();
    if (environment) pass.read(environment, Access::sampled, "environment_map", "rays that meet nothing");
    const TextureHandle seen = pass.write(
        graph_->createTexture("seen in specular surfaces",
                              {.format = GL_RGBA32F, .width = inputs.size.x, .height = inputs.size.y}),
        Access::imageStore, "seen", "radiance");
    gpu::ProgramDesc desc{.files = {"techniques/image_space_refraction/refraction.comp.glsl"},
                          .defines = {{"INTERFACES", std::to_string(inputs.parameters.integer("interfaces"))},
                                      {"EXIT_STEPS", std::to_string(inputs.parameters.integer("exit_steps"))},
                                      {"ENVIRONMENT", environment ? "1" : "0"},
                                      {"MEDIUM", inputs.scene.medium.present() ? "1" : "0"}}};
    const scene::MediumInput medium(inputs.handles, inputs.parameters.integer("medium_steps"));
    medium.define(desc.defines);
    medium.declare(pass);
    const auto program = pass.program(std::move(desc));
    pass.execute([this, program, size = inputs.size,
                  steps = inputs.parameters.integer("steps")](frame::PassContext& context) {
      gpu::Program& kernel = context.use(program);
      kernel.set("diameter", diameter_);
      kernel.set("steps", steps);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return seen;
  }

  bool update(const scene::Pose&) override {
    if (!buffers_ || !fit()) return false;
    buffers_->setViews({&view_, 1});
    viewBuffer_.update(0, &view_, sizeof(view_));
    graph_->touch(views_);
    return false;
  }

 public:
  static constexpr TechniqueInfo info{.name = "image_space_refraction",
                                      .title = "Image-space refraction and reflection",
                                      .source = "Wyman 2005; McGuire and Mara 2014; thesis, section 8.3.2",
                                      .terms = termSet(Term::specular),
                                      .parameters = kParameters,
                                      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(ImageSpaceRefraction::info, ImageSpaceRefraction)
