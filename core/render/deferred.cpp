#include "core/render/private/deferred.h"

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <vector>

#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/light_textures.h"
#include "core/gpu_scene/surface_input.h"
#include "core/technique/light_batch.h"
#include "glsl/scene/blocks.glsl"
#include "glsl/surface/gbuffer.glsl"

namespace limn::render {
namespace {

using frame::Access;
using frame::TextureHandle;

constexpr int kGroupSize = 8;

TextureHandle createRadiance(frame::FrameGraph& graph, const char* name, glm::ivec2 size) {
  return graph.createTexture(name, {.format = GL_RGBA32F, .width = size.x, .height = size.y});
}

bool hasSpecularSurface(const scene::Scene& scene) {
  return std::ranges::any_of(scene.materials, &scene::Material::specularSurface);
}

}  // namespace

TextureHandle Deferred::start(const Frame& frame, Start with) {
  frame::FrameGraph& graph = frame.graph;
  const bool geometry = static_cast<bool>(frame.gbuffer.depth);
  const bool environment = static_cast<bool>(scene_.environment);
  if (with == Start::black || (!geometry && !environment)) return black(graph, "radiance", frame.size);

  frame::PassBuilder builder = graph.addPass("emission and background");
  builder.read(frame.handles.frame, Access::uniformBuffer, "FrameBlock", "camera");
  if (environment) builder.read(maps_.radiance(), Access::sampled, "environment_map", "background");
  const bool specular =
      with == Start::emissionAndSpecular && geometry && environment && hasSpecularSurface(scene_);
  if (specular) {
    readSurfaces(builder, frame.gbuffer);
    builder.read(frame.gbuffer.instance, Access::sampled, kGBufferNames.instance,
                 "material of specular surfaces");
    builder.read(frame.handles.instances, Access::storageLoad, "Instances", "material of specular surfaces");
    builder.read(frame.handles.materials, Access::storageLoad, "Materials", "transmission");
  } else if (geometry) {
    builder.read(frame.gbuffer.depth, Access::sampled, kGBufferNames.depth, "coverage");
    builder.read(frame.gbuffer.emission, Access::sampled, kGBufferNames.emission, "emitted radiance");
  }
  const TextureHandle radiance =
      builder.write(createRadiance(graph, "radiance", frame.size), Access::imageStore, "radiance",
                    "light the camera sees without reflection");
  const auto program = builder.program({.files = {"glsl/deferred/background.comp.glsl"},
                                        .defines = {{"GEOMETRY", geometry ? "1" : "0"},
                                                    {"ENVIRONMENT", environment ? "1" : "0"},
                                                    {"SPECULAR", specular ? "1" : "0"}}});
  builder.execute([=, size = frame.size](frame::PassContext& context) {
    context.use(program);
    context.dispatch(size.x, size.y, 1, kGroupSize, kGroupSize);
  });
  return radiance;
}

TextureHandle Deferred::black(frame::FrameGraph& graph, const char* name, glm::ivec2 size) {
  frame::PassBuilder clear = graph.addPass(std::string("clear ") + name);
  const TextureHandle cleared =
      clear.write(createRadiance(graph, name, size), Access::copyTarget, "no light yet");
  clear.execute([cleared](frame::PassContext& context) {
    constexpr float nothing[4] = {0, 0, 0, 1};
    context.gl().ClearTexImage(context.texture(cleared).id(), 0, GL_RGBA, GL_FLOAT, nothing);
  });
  return cleared;
}

GBuffer Deferred::addTranslucentView(const Frame& frame, Boundary boundary) {
  const bool entering = boundary == Boundary::entering;
  frame::PassBuilder builder = frame.graph.addPass(entering ? "entry gbuffer" : "boundary gbuffer");
  builder.read(frame.handles.frame, Access::uniformBuffer, "FrameBlock", "size of the screen")
      .read(frame.gbuffer.albedo, Access::sampled, kGBufferNames.albedo, "what other surfaces reflect")
      .read(frame.gbuffer.material, Access::sampled, kGBufferNames.material,
            "which surfaces are translucent");
  GBuffer view = frame.gbuffer;
  const auto write = [&](TextureHandle& texture, const char* title, const char* name, const char* why) {
    texture = builder.write(frame.graph.createTexture(title, frame.graph.desc(texture)), Access::imageStore,
                            name, why);
  };
  if (entering) {
    write(view.albedo, "entry albedo", "albedo", "mean share of light that enters");
    write(view.material, "entry material", "material", "which surfaces it enters");
  } else {
    write(view.albedo, "boundary albedo", "albedo", "without what lies below boundaries");
  }
  const auto program = builder.program({.files = {"glsl/deferred/translucent_view.comp.glsl"},
                                        .defines = {{"ENTERING", entering ? "1" : "0"}}});
  builder.execute([program, size = frame.size](frame::PassContext& context) {
    context.use(program);
    context.dispatch(size.x, size.y, 1, kGroupSize, kGroupSize);
  });
  return view;
}

TextureHandle Deferred::addLocalSubsurface(const Frame& frame, TextureHandle before, TextureHandle entering) {
  frame::PassBuilder builder = frame.graph.addPass("local subsurface light");
  builder.read(frame.handles.frame, Access::uniformBuffer, "FrameBlock", "camera");
  readSurfaces(builder, frame.gbuffer);
  builder.read(entering, Access::sampled, "entering", "light that enters bodies");
  const TextureHandle radiance =
      builder.write(before, Access::imageLoadStore, "radiance", "what leaves them, where it entered");
  const auto program =
      builder.program({.files = {"glsl/deferred/local_subsurface.comp.glsl"}, .defines = {}});
  builder.execute([program, size = frame.size](frame::PassContext& context) {
    context.use(program);
    context.dispatch(size.x, size.y, 1, kGroupSize, kGroupSize);
  });
  return radiance;
}

gpu::ProgramDesc Deferred::readLights(frame::PassBuilder& builder, const Frame& frame, const char* file,
                                      const Batch& batch) {
  builder.read(frame.handles.frame, Access::uniformBuffer, "FrameBlock", "camera");
  builder.read(frame.handles.lights, Access::storageLoad, "Lights", "lights");
  const scene::SurfaceInput surfaces(frame.handles, frame.gbuffer);
  surfaces.declare(builder);
  if (batch.visibility) builder.read(batch.visibility, Access::sampled, "visibility", "V of each light");
  if (batch.relief) builder.read(batch.relief, Access::sampled, "relief", "W of each light");
  gpu::ProgramDesc desc{.files = {file},
                        .defines = {{"VISIBILITY", batch.visibility ? "1" : "0"},
                                    {"RELIEF", batch.relief ? "1" : "0"},
                                    {"MEDIUM", scene_.medium.present() ? "1" : "0"},
                                    {"LIGHT_COUNT", std::to_string(batch.lights.size())}}};
  surfaces.define(desc.defines);
  const scene::MediumInput medium(frame.handles);
  medium.define(desc.defines);
  medium.declare(builder);
  return desc;
}

void Deferred::shadeLights(frame::PassBuilder& builder, gpu::ProgramDesc desc, const Batch& batch,
                           glm::ivec2 size) {
  const auto program = builder.program(std::move(desc));
  builder.execute([=, indices = std::vector<uint32_t>(batch.lights.begin(), batch.lights.end())](
                      frame::PassContext& context) {
    setLightIndices(context.use(program), indices);
    context.dispatch(size.x, size.y, 1, kGroupSize, kGroupSize);
  });
}

TextureHandle Deferred::addLights(const Frame& frame, TextureHandle before, const Batch& batch) {
  frame::PassBuilder builder = frame.graph.addPass("accumulate lights");
  gpu::ProgramDesc desc = readLights(builder, frame, "glsl/deferred/light_accumulate.comp.glsl", batch);
  builder.read(maps_.ltcTable(), Access::sampled, "ltc_table", "glossy light of rectangles");
  if (!frame.handles.models)
    builder.read(frame.gbuffer.instance, Access::sampled, kGBufferNames.instance,
                 "a light does not see itself");
  const TextureHandle radiance = builder.write(before, Access::imageLoadStore, "radiance",
                                               batch.relief ? "sum of L_u V W" : "sum of L_u V");
  const scene::LightTextureInput textures(frame.handles);
  textures.define(desc.defines);
  textures.declare(builder);
  shadeLights(builder, std::move(desc), batch, frame.size);
  return radiance;
}

TextureHandle Deferred::addEnvironmentShare(const Frame& frame, TextureHandle before, const Batch& batch,
                                            EnvironmentSums& sums, bool last) {
  frame::PassBuilder builder =
      frame.graph.addPass(last ? "environment light by ratio" : "accumulate lights of the environment");
  // Maps are filtered for metallic-roughness surfaces, whoever answers how models reflect light.
  SceneHandles handles = frame.handles;
  handles.surface = nullptr;
  gpu::ProgramDesc desc = readLights(builder, {frame.graph, handles, frame.gbuffer, frame.size},
                                     "glsl/deferred/environment_share.comp.glsl", batch);
  const bool first = !sums.front();
  desc.defines["LIGHTS_FIRST"] = first ? "1" : "0";
  desc.defines["LIGHTS_LAST"] = last ? "1" : "0";
  constexpr std::array<const char*, std::tuple_size_v<EnvironmentSums>> names{"seen_sums", "seen_lobe_sums",
                                                                              "all_sums", "all_lobe_sums"};
  for (size_t i = 0; i < names.size() && !(first && last); ++i) {
    constexpr const char* why = "what arrives, and what would";
    if (last) {
      builder.read(sums[i], Access::imageLoad, names[i], why);
      continue;
    }
    if (first) sums[i] = createRadiance(frame.graph, names[i], frame.size);
    sums[i] = builder.write(sums[i], first ? Access::imageStore : Access::imageLoadStore, names[i], why);
  }
  TextureHandle radiance = before;
  if (last) {
    maps_.readReflected(builder, frame.handles.modelKinds);
    radiance = builder.write(before, Access::imageLoadStore, "radiance",
                             "light of the environment, as far as its lights are seen");
  } else {
    builder.read(maps_.ltcTable(), Access::sampled, "ltc_table", "glossy light of rectangles");
  }
  shadeLights(builder, std::move(desc), batch, frame.size);
  return radiance;
}

TextureHandle Deferred::clearFactor(frame::FrameGraph& graph, TextureHandle factor) {
  frame::PassBuilder builder = graph.addPass("clear factor");
  const TextureHandle cleared = builder.write(factor, Access::copyTarget, "nothing keeps light away");
  builder.execute([cleared](frame::PassContext& context) {
    constexpr float one = 1;
    context.gl().ClearTexImage(context.texture(cleared).id(), 0, GL_RED, GL_FLOAT, &one);
  });
  return cleared;
}

TextureHandle Deferred::addEnvironment(const Frame& frame, TextureHandle before) {
  if (!frame.gbuffer.depth) {
    frame.graph.leaveOut("environment light", "core", "no geometry");
    return before;
  }
  frame::PassBuilder builder = frame.graph.addPass("environment light");
  builder.read(frame.handles.frame, Access::uniformBuffer, "FrameBlock", "camera, rotation, scale");
  const scene::SurfaceInput surfaces(frame.handles, frame.gbuffer);
  surfaces.declare(builder);
  maps_.readReflected(builder, frame.handles.modelKinds);
  const TextureHandle radiance =
      builder.write(before, Access::imageLoadStore, "radiance", "light of the environment, V = 1");
  gpu::ProgramDesc desc{.files = {"glsl/deferred/environment.comp.glsl"},
                        .defines = {{"MEDIUM", scene_.medium.present() ? "1" : "0"}}};
  surfaces.define(desc.defines);
  const scene::MediumInput medium(frame.handles);
  medium.define(desc.defines);
  medium.declare(builder);
  const auto program = builder.program(std::move(desc));
  builder.execute([=, size = frame.size](frame::PassContext& context) {
    context.use(program);
    context.dispatch(size.x, size.y, 1, kGroupSize, kGroupSize);
  });
  return radiance;
}

TextureHandle Deferred::addTransmittance(const Frame& frame, TextureHandle before) {
  frame::PassBuilder builder = frame.graph.addPass("transmittance");
  builder.read(frame.handles.frame, Access::uniformBuffer, "FrameBlock", "camera, medium")
      .read(frame.gbuffer.depth, Access::sampled, kGBufferNames.depth,
            "length of the path through the medium");
  const TextureHandle radiance = builder.write(before, Access::imageLoadStore, "radiance",
                                               "what the medium leaves of it on the way to the camera");
  gpu::ProgramDesc desc{.files = {"glsl/deferred/transmittance.comp.glsl"}, .defines = {}};
  const scene::MediumInput medium(frame.handles);
  medium.define(desc.defines);
  medium.declare(builder);
  const auto program = builder.program(std::move(desc));
  builder.execute([=, size = frame.size](frame::PassContext& context) {
    context.use(program);
    context.dispatch(size.x, size.y, 1, kGroupSize, kGroupSize);
  });
  return radiance;
}

TextureHandle Deferred::addSpecular(const Frame& frame, TextureHandle before, TextureHandle seen) {
  frame::PassBuilder builder = frame.graph.addPass("specular surfaces");
  builder.read(frame.gbuffer.material, Access::sampled, kGBufferNames.material, "which surfaces are specular")
      .read(frame.gbuffer.emission, Access::sampled, kGBufferNames.emission, "their emission")
      .read(before, Access::sampled, "beside", "what is seen beside them")
      .read(seen, Access::sampled, "seen", "what is seen in them");
  const TextureHandle radiance =
      builder.write(createRadiance(frame.graph, "radiance with specular surfaces", frame.size),
                    Access::imageStore, "radiance", "both");
  const auto program = builder.program({.files = {"glsl/deferred/specular.comp.glsl"}, .defines = {}});
  builder.execute([=, size = frame.size](frame::PassContext& context) {
    context.use(program);
    context.dispatch(size.x, size.y, 1, kGroupSize, kGroupSize);
  });
  return radiance;
}

TextureHandle Deferred::addToneMapping(const Frame& frame, TextureHandle picture, bool layered,
                                       const ToneMapping& tone) {
  frame::PassBuilder builder = frame.graph.addPass("tone mapping");
  builder.read(picture, Access::sampled, layered ? "visibility" : "radiance", "linear picture");
  const TextureHandle display =
      builder.write(frame.graph.createTexture(
                        "display", {.format = GL_RGBA8, .width = frame.size.x, .height = frame.size.y}),
                    Access::imageStore, "display", "what the window shows");
  const auto program = builder.program(
      {.files = {"glsl/deferred/tone_map.comp.glsl"}, .defines = {{"VISIBILITY", layered ? "1" : "0"}}});
  builder.execute([=, size = frame.size](frame::PassContext& context) {
    gpu::Program& used = context.use(program);
    used.set("exposure_ev", tone.exposureEv);
    used.set("tone_curve", static_cast<uint32_t>(tone.curve));
    context.dispatch(size.x, size.y, 1, kGroupSize, kGroupSize);
  });
  return display;
}

}  // namespace limn::render
