// What the camera sees in mirrors and glass: the picture of everything else, found in image space.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <memory>

#include "core/caustics/specular_buffers.h"
#include "core/scene/camera.h"
#include "core/scene/gpu_medium.h"
#include "core/technique/technique.h"
#include "glsl/blocks.glsl"
#include "glsl/gbuffer.glsl"

namespace {

using namespace limn;
using frame::Access;
using frame::TextureHandle;

constexpr Parameter parameters[] = {
    integer(
        "interfaces", 2, {1, 16}, "interfaces",
        "Most smooth interfaces between the camera and the scene; more follow light totally reflected inside")
        .quality(),
    integer("buffer_size", 1024, {16, 8192}, "texels",
            "Side of the buffers of the specular objects' front and back, as the camera sees them")
        .quality()
        .logScale(),
    integer("steps", 64, {1, 4096}, "points", "Of the search for the surface that a ray meets on the screen")
        .quality()
        .logScale(),
    scene::mediumStepsParameter(),
};
constexpr StressCase stress[] = {
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
};

/// The camera as a view of the specular objects: a square around the picture.
glsl::ShadowView viewOf(const scene::CameraPose& camera, const scene::Bounds& objects, glm::ivec2 picture,
                        int size) {
  const glm::mat3 rotation = glm::transpose(glm::mat3(camera.worldToView));  // columns: the camera's axes
  const glm::vec3 eye = -rotation * glm::vec3(camera.worldToView[3]);
  const float aspect = static_cast<float>(picture.x) / static_cast<float>(picture.y);
  const float tangent =
      std::tan(0.5f * camera.yfov) * std::max(aspect, 1.f) * (1 + 4 / static_cast<float>(size));
  const scene::DepthRange range = scene::fitDepthRange(camera, objects);
  glsl::ShadowView view{};
  view.origin = glm::vec4(eye, range.near);
  view.axis_x = glm::vec4(glm::normalize(rotation[0]), 0.5f / tangent);
  view.axis_y = glm::vec4(glm::normalize(rotation[1]), 2 * tangent / static_cast<float>(size));
  view.axis_z = glm::vec4(-glm::normalize(rotation[2]), range.far);
  view.middle = glm::vec4(0.5f, 0.5f, 0, 0);
  view.info = {glsl::shadow_perspective, 0, static_cast<uint32_t>(size), glsl::no_light};
  return view;
}

class ImageSpaceRefraction : public Technique {
  frame::FrameGraph* graph_ = nullptr;
  scene::GpuScene* scene_ = nullptr;
  std::unique_ptr<caustics::SpecularBuffers> buffers_;
  glm::ivec2 picture_{1};
  int size_ = 1;
  glsl::ShadowView view_{};
  float diameter_ = 0;  ///< of all specular objects together, metres
  gpu::Buffer viewBuffer_;
  frame::BufferHandle views_;

  /// True: the view is another one.
  bool fit() {
    scene::Bounds objects;
    for (uint32_t i = 0; i < scene_->instanceCount(); ++i)
      if (scene_->specular(i)) objects.add(scene_->bounds(i));
    diameter_ = 2 * objects.radius();
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
    fit();
    buffers_ = std::make_unique<caustics::SpecularBuffers>(inputs.gpuScene);
    buffers_->setViews({&view_, 1});
    viewBuffer_ = gpu::Buffer::of<glsl::ShadowView>(scene_->device(), "camera's view of specular objects",
                                                    {&view_, 1}, gpu::BufferUse::updated);
    views_ = graph.importBuffer("camera's view of specular objects", viewBuffer_);
    buffers_->add(graph, inputs.handles, views_, size_, info.name);
    return addRefraction(inputs, request.target);
  }

  TextureHandle addRefraction(const TechniqueInputs& inputs, TextureHandle background) {
    struct Input {
      unsigned unit;
      TextureHandle texture;
      const char* why;
    };
    const GBuffer& g = inputs.gbuffer;
    const caustics::SpecularBuffer &front = buffers_->front(), &back = buffers_->back();
    std::vector<Input> textures{{glsl::gbuffer_unit_depth, g.depth, "front of specular surfaces"},
                                {glsl::gbuffer_unit_normal, g.normal, "their normals"},
                                {glsl::gbuffer_unit_geometric_normal, g.geometricNormal, "their horizons"},
                                {glsl::gbuffer_unit_albedo, g.albedo, "base colour, metallic"},
                                {glsl::gbuffer_unit_material, g.material, "which surfaces are specular"},
                                {glsl::gbuffer_unit_emission, g.emission, "part of a surface's description"},
                                {glsl::gbuffer_unit_instance, g.instance, "objects"},
                                {7, front.surface, "where light enters objects"},
                                {8, front.depth, "where light enters objects"},
                                {9, back.surface, "where light leaves objects"},
                                {10, back.depth, "where light leaves objects"},
                                {11, inputs.matte.depth, "what rays meet"},
                                {12, inputs.matte.geometricNormal, "what rays meet"},
                                {13, background, "light of what rays meet"}};
    if (inputs.environmentMap) textures.push_back({14, inputs.environmentMap, "rays that meet nothing"});

    frame::PassBuilder pass = graph_->addPass("refraction", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "camera, medium")
        .read(inputs.handles.instances, Access::storageLoad, "materials of instances")
        .read(inputs.handles.materials, Access::storageLoad, "index of refraction, colours")
        .read(views_, Access::storageLoad, "the camera's view of specular objects");
    for (const Input& input : textures) pass.read(input.texture, Access::sampled, input.why);
    const TextureHandle seen = pass.write(
        graph_->createTexture("seen in specular surfaces",
                              {.format = GL_RGBA32F, .width = inputs.size.x, .height = inputs.size.y}),
        Access::imageStore, "radiance");
    gpu::ProgramDesc desc{.files = {"techniques/image_space_refraction/refraction.comp.glsl"},
                          .defines = {{"INTERFACES", std::to_string(inputs.parameters.integer("interfaces"))},
                                      {"ENVIRONMENT", inputs.environmentMap ? "1" : "0"},
                                      {"MEDIUM", inputs.scene.medium.present() ? "1" : "0"}}};
    const scene::MediumInput medium(inputs.handles, inputs.parameters.integer("medium_steps"));
    medium.define(desc.defines);
    medium.declare(pass);
    const auto program = pass.program(std::move(desc));
    pass.execute([=, this, handles = inputs.handles, size = inputs.size,
                  steps = inputs.parameters.integer("steps")](frame::PassContext& context) {
      gpu::Program& kernel = context.program(program);
      kernel.use();
      kernel.set("diameter", diameter_);
      kernel.set("steps", steps);
      context.bindUniform(glsl::FrameBlock::binding, handles.frame);
      context.bindStorage(0, handles.instances);
      context.bindStorage(1, handles.materials);
      context.bindStorage(2, views_);
      for (const Input& input : textures) context.bindSampled(input.unit, input.texture);
      medium.bind(context);
      context.bindImage(0, seen, GL_WRITE_ONLY);
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
                                      .parameters = parameters,
                                      .stress = stress};
};

}  // namespace

LIMN_TECHNIQUE(ImageSpaceRefraction::info, ImageSpaceRefraction)
