#include "core/render/renderer.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/render/private/deferred.h"
#include "core/render/private/read_picture.h"
#include "core/render/services.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/bound.h"
#include "core/technique/module.h"

namespace limn::render {
namespace {

TermSet termsOf(const TechniqueUse& use) {
  return use.plugin->info->terms;
}

}  // namespace

struct Renderer::Implementation {
  struct Use {
    const TechniqueUse* settings;
    std::unique_ptr<Technique> technique;
  };

  gpu::Device& device;
  const scene::Scene& scene;
  std::filesystem::path shaderOverride;
  gpu::ShaderLibrary shaders;
  frame::ResourcePool pool;
  scene::GpuScene gpuScene;
  FrameServices services;
  Deferred deferred;
  scene::GBufferPass gbufferPass, mattePass;
  Settings settings;
  scene::CameraPose camera;
  scene::Pose pose;
  double time = 0;
  int animation = scene::kNone;
  bool poseDirty = true;
  uint32_t frameIndex = 0;
  std::vector<bool> emitting;  ///< of each light, when the graph was built
  std::vector<std::string> mounted;
  std::vector<Use> uses;

  // Handles of the current graph.
  std::unique_ptr<frame::FrameGraph> graph;
  SceneHandles handles;
  Use* bumps = nullptr;    ///< answers relief for the current graph
  GBuffer gbuffer, matte;  ///< matte: what is lit, the same or the surfaces behind the specular ones
  frame::TextureHandle output, display;
  InspectionView inspectionView;
  std::unique_ptr<TextureInspector> inspector;
  frame::FrameGraph::CompileProgress compileProgress;

  Implementation(gpu::Device& gpuDevice, const scene::Scene& shown, std::filesystem::path overrideFolder)
      : device(gpuDevice),
        scene(shown),
        shaderOverride(std::move(overrideFolder)),
        shaders(gpuDevice),
        pool(gpuDevice),
        gpuScene(gpuDevice, shown),
        services(makeServices(gpuDevice, gpuScene)),
        deferred(gpuDevice, shown) {
    shaders.mount("", embeddedSources(), shaderOverride);
  }

  ~Implementation() { dropGraph(); }

  void dropGraph() {
    if (!graph) return;
    gpuScene.forget();
    inspector.reset();
    graph.reset();
    bumps = nullptr;
    uses.clear();
  }

  void mountTechnique(const TechniquePlugin& plugin) {
    const std::string prefix = fmt::format("techniques/{}/", plugin.info->name);
    if (std::find(mounted.begin(), mounted.end(), prefix) != mounted.end()) return;
    shaders.mount(prefix, inTechnique(plugin, plugin.sources),
                  shaderOverride.empty() ? shaderOverride : shaderOverride / prefix);
    mounted.push_back(prefix);
  }

  TechniqueInputs inputsOf(const Use& use, const GBuffer& seen) {
    return {scene, pose, gpuScene, services, use.settings->parameters, handles, seen, settings.size};
  }

  frame::TextureHandle ask(Use& use, Term term, std::span<const uint32_t> lights,
                           frame::TextureHandle target) {
    const bool behind = term != Term::specular && term != Term::caustic && term != Term::media;
    TechniqueInputs inputs = inputsOf(use, behind ? matte : gbuffer);
    if (term == Term::specular) {
      inputs.matte = matte;
      inputs.environmentMap = deferred.environmentMap(*graph);
    }
    const TechniquePlugin& plugin = *use.settings->plugin;
    inputs.bound = settings.bound && hasBound(plugin);
    const frame::TextureHandle answer = inTechnique(plugin, [&] {
      return use.technique->addPasses(*graph, inputs, {term, lights, target});
    });
    if (!answer)
      throw Error(fmt::format("{}: it answers {} with nothing", described(plugin), limn::name(term)));
    return answer;
  }

  /// How materials reflect light, for all passes that reflect it.
  void askSurface() {
    Use* use = answering(Term::surface);
    if (!use) return;
    const TechniquePlugin& plugin = *use->settings->plugin;
    if (handles.modelKinds == 0 || isFactor(settings.term) || !gbuffer.depth)
      return graph->leaveOut("surface", plugin.info->name,
                             handles.modelKinds == 0 ? "no material has a model" : "no light is reflected");
    const TechniqueInputs inputs = inputsOf(*use, gbuffer);
    scene::SurfaceAnswer answer =
        inTechnique(plugin, [&] { return use->technique->surface(*graph, inputs); });
    if (answer.file.empty())
      throw Error(
          fmt::format("{}: it answers {} with nothing", described(plugin), limn::name(Term::surface)));
    handles.surface = std::make_shared<const scene::SurfaceAnswer>(std::move(answer));
  }

  Use* answering(Term term) {
    for (Use& use : uses)
      if (contains(termsOf(*use.settings), term)) return &use;
    return nullptr;
  }

  bool forced(Saving saving) const {
    return std::ranges::find(settings.forced, saving) != settings.forced.end();
  }

  bool emits(size_t light) const { return pose.lights[light].emission != glm::vec3(0); }

  void noteEmitting() {
    emitting.resize(pose.lights.size());
    for (size_t i = 0; i < emitting.size(); ++i) emitting[i] = emits(i);
  }

  /// A light was turned on or off: the graph leaves out what dark ones would need.
  bool switched() const {
    for (size_t i = 0; i < emitting.size(); ++i)
      if (emitting[i] != emits(i)) return true;
    return false;
  }

  /// The lights that can contribute: the one asked for, or all that emit, without those whose place a
  /// technique takes.
  std::vector<uint32_t> activeLights() {
    std::vector<uint32_t> lights;
    const bool replaced = settings.light < 0 && answering(Term::environment) != nullptr;
    if (replaced && !scene.environment.lights.empty())
      graph->leaveOut("lights of the environment", "core", "a technique answers the environment's light");
    for (uint32_t i = 0; i < pose.lights.size(); ++i) {
      if (settings.light >= 0 && static_cast<uint32_t>(settings.light) != i) continue;
      if (replaced && (pose.lights[i].flags & glsl::light_flag_environment) != 0) continue;
      if (!emits(i) && !isFactor(settings.term) && !forced(Saving::darkLights)) {
        graph->leaveOut(fmt::format("light {}", pose.lightNames[i]), "core", "it emits nothing");
        continue;
      }
      lights.push_back(i);
    }
    return lights;
  }

  frame::TextureHandle factorTarget(Term term, int layers) {
    return graph->createTexture(limn::name(term),
                                {GL_TEXTURE_2D_ARRAY, GL_R16, settings.size.x, settings.size.y, layers, 1});
  }

  frame::TextureHandle addDirect(const Deferred::Frame& frame, frame::TextureHandle radiance,
                                 std::span<const uint32_t> lights) {
    if (Use* direct = answering(Term::direct)) return ask(*direct, Term::direct, lights, radiance);
    const auto factor = [&](Term term, Use* use, std::span<const uint32_t> batch) {
      return use ? ask(*use, term, batch, factorTarget(term, static_cast<int>(batch.size())))
                 : frame::TextureHandle{};
    };
    Use* shadowing = answering(Term::visibility);
    for (size_t first = 0; first < lights.size(); first += kLightBatch) {
      const auto batch = lights.subspan(first, std::min<size_t>(kLightBatch, lights.size() - first));
      const Deferred::Factors factors{.visibility = factor(Term::visibility, shadowing, batch),
                                      .relief = factor(Term::relief, bumps, batch)};
      radiance = deferred.addLights(frame, radiance, batch, factors);
    }
    return radiance;
  }

  frame::TextureHandle addEnvironment(const Deferred::Frame& frame, frame::TextureHandle radiance) {
    const char* why = nullptr;
    if (!scene.environment && !forced(Saving::environment)) why = "no environment";
    if (scene.environment && settings.light >= 0) why = "another light was chosen";
    Use* use = answering(Term::environment);
    if (!why && use) return ask(*use, Term::environment, {}, radiance);
    if (!why && !scene.environment.lights.empty()) why = "lights stand for it";
    if (!why) return deferred.addEnvironment(frame, radiance);
    graph->leaveOut("environment light", "core", why);
    return radiance;
  }

  /// The technique that shows the scene in its specular surfaces, if the picture has them.
  Use* answeringSpecular() {
    Use* use = answering(Term::specular);
    if (!use || (settings.term != Term::final && settings.term != Term::specular)) return nullptr;
    if (gpuScene.hasSpecular()) return use;
    graph->leaveOut("specular surfaces", use->settings->plugin->info->name,
                    "the scene has no specular surface");
    return nullptr;
  }

  /// The technique that says what bumps leave of each light, if the picture has such light on height maps.
  Use* answeringRelief() {
    Use* use = answering(Term::relief);
    if (!use) return nullptr;
    const bool lit = settings.term == Term::final || settings.term == Term::direct ||
                     settings.term == Term::specular || settings.term == Term::relief;
    const char* why = !gpuScene.hasHeights() ? "no material has a height map"
                      : !lit                 ? "no direct light is shown"
                                             : nullptr;
    if (!why) return use;
    graph->leaveOut("relief", use->settings->plugin->info->name, why);
    return nullptr;
  }

  /// Whether the picture has light of a technique that reads where pixels lie in their height maps.
  bool readsPlaces() const {
    const bool indirect =
        settings.term == Term::final || settings.term == Term::indirect || settings.term == Term::specular;
    return gpuScene.hasHeights() && std::ranges::any_of(uses, [&](const Use& use) {
             const bool answers =
                 &use == bumps || (indirect && contains(termsOf(*use.settings), Term::indirect));
             return answers && use.settings->plugin->info->places;
           });
  }

  frame::TextureHandle addRadiance() {
    Use* specular = answeringSpecular();
    matte = specular ? mattePass.add(*graph, gpuScene, handles, settings.size, scene::Surfaces::matte,
                                     readsPlaces())
                     : gbuffer;
    const Deferred::Frame lit{*graph, handles, matte, settings.size};
    const Deferred::Frame frame{*graph, handles, gbuffer, settings.size};
    const bool all = settings.term == Term::final, whole = all || specular;
    frame::TextureHandle radiance = deferred.start(lit, specular ? Deferred::Start::emission
                                                        : all    ? Deferred::Start::emissionAndSpecular
                                                                 : Deferred::Start::black);
    if (!gbuffer.depth) {
      graph->leaveOut("lighting", "core", "the scene has no geometry");
      return radiance;
    }
    const std::vector<uint32_t> lights = activeLights();
    if (whole || settings.term == Term::direct) {
      if (!lights.empty())
        radiance = addDirect(lit, radiance, lights);
      else
        graph->leaveOut("lights", "core", "the scene has no light");
      radiance = addEnvironment(lit, radiance);
    }
    const auto add = [&](Term term, bool wanted) {
      for (Use& use : uses)
        if (wanted && contains(termsOf(*use.settings), term)) radiance = ask(use, term, lights, radiance);
    };
    add(Term::indirect, whole || settings.term == Term::indirect);
    if (specular) {
      const frame::TextureHandle seen = ask(*specular, Term::specular, lights, radiance);
      radiance = all ? deferred.addSpecular(frame, radiance, seen) : seen;
    }
    add(Term::caustic, all || settings.term == Term::caustic);
    const char* clear = !scene.medium.present()        ? "the scene has no medium"
                        : settings.term == Term::media ? "no surface is shown"
                                                       : nullptr;
    if (clear)
      graph->leaveOut("transmittance", "core", clear);
    else
      radiance = deferred.addTransmittance(frame, radiance);
    add(Term::media, all || settings.term == Term::media);
    return radiance;
  }

  /// V or W of one light.
  frame::TextureHandle addFactor() {
    const Term term = settings.term;
    const std::vector<uint32_t> lights = activeLights();
    if (lights.size() != 1)
      throw UsageError(
          fmt::format("--output-term {} shows one light; choose it with --light", limn::name(term)));
    if (!gbuffer.depth)
      throw Error(fmt::format("{} has no surface to show: the scene has no geometry", limn::name(term)));
    matte = gbuffer;
    const frame::TextureHandle target = factorTarget(term, 1);
    if (term == Term::relief && !bumps) return Deferred::clearFactor(*graph, target);
    return ask(*answering(term), term, lights, target);
  }

  /// Behind everything else: the pass looked at may be any.
  void addInspector() {
    if (!settings.inspect) return;
    const Inspection& wanted = *settings.inspect;
    const frame::TextureHandle texture = graph->find(wanted.technique, wanted.pass, wanted.access);
    if (texture) inspector = std::make_unique<TextureInspector>(*graph, texture, inspectionView);
  }

  void build() {
    dropGraph();
    noteEmitting();
    graph = std::make_unique<frame::FrameGraph>();
    for (const TechniqueUse& use : settings.techniques) {
      mountTechnique(*use.plugin);
      uses.push_back({&use, createTechnique(*use.plugin)});
    }
    gpuScene.setCulling(!forced(Saving::culling));
    handles = gpuScene.import(*graph);
    gbuffer = matte = {};
    bumps = answeringRelief();
    if (gpuScene.instanceCount() > 0)
      gbuffer =
          gbufferPass.add(*graph, gpuScene, handles, settings.size, scene::Surfaces::all, readsPlaces());
    else
      graph->leaveOut("gbuffer", "core", "the scene has no geometry");
    askSurface();
    const auto building = services.begin(*graph, handles, pose);
    output = isFactor(settings.term) ? addFactor() : addRadiance();
    graph->output(output);
    display = {};
    if (settings.displayEv) {
      display = deferred.addToneMapping({*graph, handles, gbuffer, settings.size}, output,
                                        isFactor(settings.term), *settings.displayEv);
      graph->output(display);
    }
    if (settings.channels && gbuffer.depth)
      for (frame::TextureHandle kept : {gbuffer.depth, gbuffer.instance, gbuffer.albedo, gbuffer.normal})
        graph->output(kept);
    addInspector();
    graph->prepare(device, shaders, pool, compileProgress);
    pool.trim();
  }

  void refreshPose() {
    if (!poseDirty) return;
    scene::evaluate(scene, time, animation, pose);
    poseDirty = false;
  }

  bool render(frame::Timing timing, const frame::FrameGraph::Cancelled& cancelled) {
    refreshPose();
    bool rebuild = gpuScene.update(pose, camera, settings.size, frameIndex++) || !graph || switched();
    if (!rebuild) {
      rebuild = services.update(*graph, pose);
      for (Use& use : uses)
        rebuild = inTechnique(*use.settings->plugin, [&] { return use.technique->update(pose); }) || rebuild;
    }
    if (rebuild) build();
    if (settings.dynamic) graph->invalidate();
    return graph->execute(timing, cancelled);
  }
};
Renderer::Renderer(gpu::Device& device, const scene::Scene& scene, std::filesystem::path shaderOverride)
    : implementation_(std::make_unique<Implementation>(device, scene, std::move(shaderOverride))) {}
Renderer::~Renderer() = default;

void Renderer::configure(Settings settings) {
  checkTechniques(settings.techniques, settings.term);
  Implementation& self = *implementation_;
  self.dropGraph();
  self.settings = std::move(settings);
}

void Renderer::setCamera(const scene::CameraPose& camera) {
  implementation_->camera = camera;
}

void Renderer::setTime(double seconds, int animation) {
  implementation_->time = seconds;
  implementation_->animation = animation;
  implementation_->poseDirty = true;
}

bool Renderer::render(frame::Timing timing, const frame::FrameGraph::Cancelled& cancelled) {
  return implementation_->render(timing, cancelled);
}

const gpu::Texture& Renderer::display() const {
  const Implementation& self = *implementation_;
  if (!self.display || !self.graph) throw Error("nothing to display: Settings::displayEv was not set");
  return self.graph->texture(self.display);
}

const TextureInspector* Renderer::inspector() const {
  return implementation_->inspector.get();
}

void Renderer::setInspectionView(const InspectionView& view) {
  implementation_->inspectionView = view;
}

void Renderer::setCompileProgress(frame::FrameGraph::CompileProgress progress) {
  implementation_->compileProgress = std::move(progress);
}

void Renderer::finish() {
  implementation_->device.gl().Finish();
}

const scene::Pose& Renderer::pose() {
  implementation_->refreshPose();
  return implementation_->pose;
}

Image Renderer::read() const {
  const Implementation& self = *implementation_;
  const bool channels = self.settings.channels && self.gbuffer.depth;
  return readPicture(*self.graph, self.settings, self.output, channels ? &self.gbuffer : nullptr);
}

frame::FrameGraph& Renderer::graph() {
  return *implementation_->graph;
}
std::vector<frame::PassReport> Renderer::explain() const {
  return implementation_->graph->explain();
}

int64_t Renderer::memoryBytes() const {
  const gpu::Counters& counters = implementation_->device.counters();
  return counters.bufferBytes + counters.textureBytes;
}

FrameStats Renderer::describe() const {
  const Implementation& self = *implementation_;
  const ContextInfo& info = self.device.context().info();
  FrameStats stats;
  stats.renderer = info.renderer;
  stats.backend = limn::name(info.backend);
  stats.software = info.software;
  stats.timer = frame::preferredTiming(self.device);
  stats.dynamic = self.settings.dynamic;
  stats.width = self.settings.size.x;
  stats.height = self.settings.size.y;
  stats.scene = self.scene.file.string();
  for (const TechniqueUse& use : self.settings.techniques) {
    stats.technique += (stats.technique.empty() ? "" : ",") + std::string(use.plugin->info->name);
    for (const auto& [parameter, value] : use.parameters.printed())
      stats.parameters.emplace_back(fmt::format("{}.{}", use.plugin->info->name, parameter), value);
  }
  return stats;
}

void Renderer::describeShadowMaps(FrameStats& stats) const {
  const auto& maps = implementation_->services.get<shadow::ShadowMapService>();
  for (const shadow::ShadowMapStats& fit : maps.stats())
    stats.shadowMaps.push_back({fit.light, fit.projection, fit.layers, fit.near, fit.far, fit.halfAngle});
  if (!stats.shadowMaps.empty()) stats.uncoveredPixels = maps.uncoveredPixels();
}

Renderer::Reload Renderer::reloadShaders() {
  gpu::ShaderLibrary::ReloadResult result = implementation_->shaders.reload();
  return {result.changed, result.reloaded, std::move(result.errors)};
}

}  // namespace limn::render
