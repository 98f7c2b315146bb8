// Light below surfaces, spread in a texture that the surface of each body is laid out in.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/diffusion_profile.h"
#include "core/shadow/entering_light.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"
#include "techniques/texture_space_subsurface/body_textures.h"

namespace {

using namespace limn;
using frame::Access;
using frame::TextureHandle;
using texture_space::BodyMatter;
using texture_space::BodyTextures;

constexpr Parameter kParameters[] = {
    scene::profileParameter(),
    integer("texels", 256, {16, 4096}, "texels", "Along each side of a body's texture").quality().logScale(),
    integer("gaussians", 6, {1, 12}, "Gaussians", "Whose sum is the profile; each takes two passes")
        .quality(),
    shadow::shadowMapSizeParameter(),
    shadow::biasParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "16 texels", .scene = "translucent_spheres", .settings = "texels=16", .factor = 0},
    {.name = "one Gaussian", .scene = "translucent_edge", .settings = "gaussians=1", .factor = 0},
    {.name = "12 Gaussians", .scene = "translucent_spheres", .settings = "gaussians=12"},
    {.name = "skin of a scene of 1e-4",
     .change = StressChange::sceneScale,
     .amount = 1e-4,
     .scene = "translucent_spheres",
     .factor = 0},
    {.name = "skin of a scene of 1e4",
     .change = StressChange::sceneScale,
     .amount = 1e4,
     .scene = "translucent_spheres",
     .factor = 0},
};
/// Places, frames, light that enters, along rows and columns, and that leaves: RGBA32F each.
constexpr int64_t kTexelBytes = 6 * 16;

class TextureSpaceSubsurface : public Technique {
 public:
  static constexpr TechniqueInfo info{
      .name = "texture_space_subsurface",
      .title = "Subsurface scattering in texture space",
      .source = "d'Eon, Luebke, Enderton 2007, Efficient Rendering of Human Skin",
      .terms = termSet(Term::subsurface),
      .parameters = kParameters,
      .stress = kStress};

 private:
  TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                          const TermRequest& request) override;
  bool update(const scene::Pose& pose) override {
    // Where nobody asked for light below surfaces there is nothing that could fit no more.
    return buffers_ && (pose.instances.size() != drawCount_ || !texture_space::fits(pose, draws_));
  }

  /// Holds what the passes of one graph read for as long as it lives.
  struct Buffers {
    gpu::Buffer corners, bodies, kinds, gaussians, ofMaterials;
  };
  std::optional<Buffers> buffers_;
  gpu::VertexArray vertexArray_;
  std::vector<texture_space::LaidOutDraw> draws_;  ///< the translucent ones
  size_t drawCount_ = 0;                           ///< of all
};

/// Declares the passes of one graph.
class Passes {
 public:
  struct Handles {
    frame::BufferHandle corners, bodies, kinds, gaussians, ofMaterials;
  };

  Passes(frame::FrameGraph& graph, const TechniqueInputs& inputs,
         std::vector<texture_space::CornerRange> ranges, int first, bool textured, const Handles& handles,
         GLuint vertexArray)
      : graph_(graph),
        inputs_(inputs),
        ranges_(std::move(ranges)),
        first_(first),
        textured_(textured),
        handles_(handles),
        vertexArray_(vertexArray) {}

  /// Adds what leaves translucent surfaces to the request's target, and returns it after that.
  TextureHandle add(const TermRequest& request) {
    if (first_ == gaussians()) {
      graph_.leaveOut("lay surfaces out", kName, "no light goes as far as half a texel");
      return addExit({}, request.target);
    }
    addLayout();
    addLight(request);
    leaving_ = texture("light that leaves", GL_RGBA32F);
    TextureHandle lit = entered_;
    for (int i = first_; i < gaussians(); ++i) lit = addSpread(addSpread(lit, i, true), i, false);
    return addExit(addSearch(), request.target);
  }

 private:
  static constexpr const char* kName = TextureSpaceSubsurface::info.name;
  static std::string file(const char* name) {
    return std::string("techniques/texture_space_subsurface/") + name + ".glsl";
  }
  int texels() const { return inputs_.parameters.integer("texels"); }
  int gaussians() const { return inputs_.parameters.integer("gaussians"); }
  int layers() const { return static_cast<int>(ranges_.size()); }

  /// Returns a texture with a layer for each body.
  TextureHandle texture(std::string_view name, GLenum format) {
    return graph_.createTexture(name, {.target = GL_TEXTURE_2D_ARRAY,
                                       .format = format,
                                       .width = texels(),
                                       .height = texels(),
                                       .layers = layers()});
  }

  /// Declares what techniques/texture_space_subsurface/body_corner.glsl reads.
  void readCorners(frame::PassBuilder& pass) const {
    pass.read(handles_.corners, Access::storageLoad, "Corners", "triangles and their places")
        .read(handles_.bodies, Access::storageLoad, "Bodies", "which draws they are of")
        .read(inputs_.handles.instances, Access::storageLoad, "Instances", "transforms")
        .read(inputs_.handles.geometry, Access::storageLoad, "Positions", "vertices");
  }

  void addLayout() {
    frame::PassBuilder pass = graph_.addPass("lay surfaces out", kName);
    pass.role(frame::PassRole::map).cacheable();
    readCorners(pass);
    place_ = pass.write(texture("places of texels", GL_RGBA32F), Access::colourAttachment, "places, charts");
    frame_ = pass.write(texture("frames of texels", GL_RGBA32F), Access::colourAttachment,
                        "normals, sizes of texels");
    const auto program = pass.program({.files = {file("lay_out.vert"), file("lay_out.frag")}, .defines = {}});
    pass.execute([program, place = place_, frame = frame_, ranges = ranges_, array = vertexArray_,
                  texels = texels()](frame::PassContext& context) {
      const gl::Functions& gl = context.gl();
      gpu::Program& bound = context.use(program);
      bound.set("texels", static_cast<float>(texels));
      gl.BindVertexArray(array);
      constexpr GLfloat none[4] = {};
      for (size_t i = 0; i < ranges.size(); ++i) {
        const auto layer = static_cast<int>(i);
        context.bindFramebuffer({{place, 0, layer}, {frame, 0, layer}});
        gl.ClearBufferfv(GL_COLOR, 0, none);
        gl.ClearBufferfv(GL_COLOR, 1, none);
        bound.set("layer", static_cast<unsigned>(i));
        // One call draws in order: what is drawn later stays.
        gl.DrawArrays(GL_TRIANGLES, static_cast<GLint>(ranges[i].first),
                      static_cast<GLsizei>(ranges[i].surroundings + ranges[i].own));
        context.countTriangles((ranges[i].surroundings + ranges[i].own) / 3);
      }
    });
  }

  void addLight(const TermRequest& request) {
    const shadow::EnteringLight light(inputs_, request, inputs_.parameters.integer("shadow_map_size"));
    frame::PassBuilder pass = graph_.addPass("light texels", kName);
    gpu::ProgramDesc program{.files = {file("light_texels.comp")}, .defines = {}};
    light.declare(pass, inputs_, program.defines);
    pass.read(handles_.bodies, Access::storageLoad, "Bodies", "which draws layers are of")
        .read(handles_.kinds, Access::storageLoad, "Kinds", "what boundaries let in")
        .read(place_, Access::sampled, "surface_place", "where texels lie")
        .read(frame_, Access::sampled, "surface_frame", "and look");
    entered_ = pass.write(texture("light that enters texels", GL_RGBA32F), Access::imageStore, "lit",
                          "light that enters at texels");
    const auto kernel = pass.program(std::move(program));
    pass.execute([kernel, light, bias = inputs_.parameters.real("bias"), texels = texels(),
                  layers = layers()](frame::PassContext& context) {
      light.set(context.use(kernel), bias);
      context.dispatch(texels, texels, layers, 8, 8);
    });
  }

  /// Returns the light of a Gaussian along rows, or along both; empty where no other follows.
  TextureHandle addSpread(TextureHandle lit, int index, bool rows) {
    const bool last = !rows && index + 1 == gaussians();
    frame::PassBuilder pass = graph_.addPass(rows ? "rows" : "columns", kName);
    gpu::ProgramDesc program{.files = {file("spread.comp")},
                             .defines = {{"ROWS", rows ? "1" : "0"},
                                         {"FIRST", index == first_ ? "1" : "0"},
                                         {"LAST", last ? "1" : "0"},
                                         {"GAUSSIANS", std::to_string(gaussians())}}};
    pass.read(handles_.bodies, Access::storageLoad, "Bodies", "which matter layers are of")
        .read(handles_.gaussians, Access::storageLoad, "Gaussians", "how far light goes")
        .read(frame_, Access::sampled, "surface_frame", "sizes of texels")
        .read(lit, Access::sampled, "lit", "light to spread");
    if (!rows && index == first_)
      pass.read(entered_, Access::sampled, "entered", "light of narrow Gaussians");
    TextureHandle result;
    if (!last)
      result = pass.write(texture(rows ? "light along rows" : "light along columns", GL_RGBA32F),
                          Access::imageStore, "spread", "light of this Gaussian");
    if (!rows)
      leaving_ = pass.write(leaving_, index == first_ ? Access::imageStore : Access::imageLoadStore,
                            "leaving", "light of all Gaussians");
    const auto kernel = pass.program(std::move(program));
    pass.execute([kernel, index, texels = texels(), layers = layers()](frame::PassContext& context) {
      context.use(kernel).set("gaussian", static_cast<unsigned>(index));
      context.dispatch(texels, texels, layers, 8, 8);
    });
    return result;
  }

  /// Returns where in the textures pixels lie.
  TextureHandle addSearch() {
    frame::PassBuilder pass = graph_.addPass("find texels", kName);
    pass.role(frame::PassRole::map);
    readCorners(pass);
    pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(inputs_.gbuffer.depth, Access::sampled, kGBufferNames.depth, "which surface is seen")
        .read(inputs_.gbuffer.instance, Access::sampled, kGBufferNames.instance, "and of which draw");
    const auto screen = [&](const char* name, GLenum format) {
      return graph_.createTexture(name,
                                  {.format = format, .width = inputs_.size.x, .height = inputs_.size.y});
    };
    const TextureHandle found =
        pass.write(screen("texels of pixels", GL_RGBA32F), Access::colourAttachment, "texels of pixels");
    const TextureHandle depth = pass.write(screen("texels of pixels z", GL_DEPTH_COMPONENT32F),
                                           Access::depthAttachment, "hidden-surface removal");
    const auto program =
        pass.program({.files = {file("find_texels.vert"), file("find_texels.frag")}, .defines = {}});
    pass.execute([program, found, depth, ranges = ranges_, array = vertexArray_,
                  &scene = inputs_.gpuScene](frame::PassContext& context) {
      const gl::Functions& gl = context.gl();
      context.bindFramebuffer({{found}}, {depth});
      constexpr GLfloat none[4] = {}, far = 0;
      gl.ClearBufferfv(GL_COLOR, 0, none);
      gl.ClearBufferfv(GL_DEPTH, 0, &far);
      gpu::Program& bound = context.use(program);
      bound.set("near_plane", scene.camera().near);
      gl.BindVertexArray(array);
      gl.Enable(GL_DEPTH_TEST);
      gl.DepthFunc(GL_GREATER);
      for (size_t i = 0; i < ranges.size(); ++i) {
        bound.set("layer", static_cast<unsigned>(i));
        gl.DrawArrays(GL_TRIANGLES, static_cast<GLint>(ranges[i].first + ranges[i].surroundings),
                      static_cast<GLsizei>(ranges[i].own));
        context.countTriangles(ranges[i].own / 3);
      }
    });
    return found;
  }

  TextureHandle addExit(TextureHandle found, TextureHandle target) {
    const GBuffer& gbuffer = inputs_.gbuffer;
    const bool charts = static_cast<bool>(found);
    frame::PassBuilder pass = graph_.addPass("exit", kName);
    gpu::ProgramDesc program{
        .files = {file("exit.comp")},
        .defines = {{"TEXTURED", textured_ ? "1" : "0"},
                    {"CHARTS", charts ? "1" : "0"},
                    {"NORMALISED", scene::normalisedProfile(inputs_.parameters) ? "1" : "0"},
                    {"GAUSSIANS", std::to_string(gaussians())}}};
    pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(gbuffer.instance, Access::sampled, kGBufferNames.instance, "draws of pixels")
        .read(gbuffer.normal, Access::sampled, kGBufferNames.normal, "what boundaries let out")
        .read(inputs_.handles.instances, Access::storageLoad, "Instances", "their materials")
        .read(handles_.ofMaterials, Access::storageLoad, "KindsOfMaterials", "which are translucent")
        .read(handles_.kinds, Access::storageLoad, "Kinds", "what they reflect")
        .read(inputs_.entering, Access::sampled, "entering", "light of narrow Gaussians");
    if (charts)
      pass.read(handles_.gaussians, Access::storageLoad, "Gaussians", "which are narrower than texels")
          .read(found, Access::sampled, "found", "texels of pixels")
          .read(frame_, Access::sampled, "surface_frame", "sizes of texels")
          .read(entered_, Access::sampled, "entered", "charts, light of narrow Gaussians")
          .read(leaving_, Access::sampled, "leaving", "light of the others");
    if (textured_) pass.read(gbuffer.albedo, Access::sampled, kGBufferNames.albedo, "albedo of pixels");
    const TextureHandle result =
        pass.write(target, Access::imageLoadStore, "radiance", "light that leaves translucent surfaces");
    const auto kernel = pass.program(std::move(program));
    pass.execute([kernel, size = inputs_.size](frame::PassContext& context) {
      context.use(kernel);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return result;
  }

  frame::FrameGraph& graph_;
  const TechniqueInputs& inputs_;
  std::vector<texture_space::CornerRange> ranges_;
  int first_;  ///< Gaussian that is spread
  bool textured_;
  Handles handles_;
  GLuint vertexArray_;
  TextureHandle place_, frame_, entered_, leaving_;
};

TextureHandle TextureSpaceSubsurface::addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                                const TermRequest& request) {
  const ParameterValues& p = inputs.parameters;
  drawCount_ = inputs.pose.instances.size();
  const int texels = p.integer("texels"), gaussians = p.integer("gaussians");
  const BodyMatter matter =
      texture_space::bodyMatter(inputs.scene, inputs.pose, scene::normalisedProfile(p), gaussians);
  draws_ = texture_space::translucentDraws(inputs.scene, inputs.pose, matter);
  gpu::Device& device = inputs.gpuScene.device();
  const gpu::Limits& limits = device.limits();
  const BodyTextures textures =
      texture_space::bodyTextures(inputs.pose, draws_, matter, texels, limits.maxStorageBlockBytes);
  const int first = texture_space::firstSpread(textures, matter, gaussians);
  if (first < gaussians)
    texture_space::checkLayers(
        textures, texels, {.layers = limits.maxArrayLayers, .layerBytes = kTexelBytes * texels * texels});
  if (textures.tooMany > 0)
    graph.leaveOut(
        "lay finely cut surfaces out", info.name,
        fmt::format("{} bodies have more charts or triangles than {} x {} texels and a buffer hold: "
                    "light leaves them where it enters",
                    textures.tooMany, texels, texels));
  buffers_ = {gpu::Buffer::of<glsl::ChartCorner>(device, "corners of charts", textures.corners),
              gpu::Buffer::of<glsl::TexturedBody>(device, "bodies of textures", textures.bodies),
              gpu::Buffer::of<glsl::TexturedKind>(device, "kinds of matter", matter.kinds),
              gpu::Buffer::of<glsl::SurfaceGaussian>(device, "Gaussians of matter", matter.gaussians),
              gpu::Buffer::of<uint32_t>(device, "matter of materials", matter.ofMaterials)};
  vertexArray_ = gpu::VertexArray(device, {});
  return Passes(graph, inputs, textures.ranges, first, matter.textured,
                {.corners = graph.importBuffer("corners of charts", buffers_->corners),
                 .bodies = graph.importBuffer("bodies of textures", buffers_->bodies),
                 .kinds = graph.importBuffer("kinds of matter", buffers_->kinds),
                 .gaussians = graph.importBuffer("Gaussians of matter", buffers_->gaussians),
                 .ofMaterials = graph.importBuffer("matter of materials", buffers_->ofMaterials)},
                vertexArray_.id())
      .add(request);
}

}  // namespace

LIMN_TECHNIQUE(TextureSpaceSubsurface::info, TextureSpaceSubsurface)
