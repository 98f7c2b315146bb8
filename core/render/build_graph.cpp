// The frame graph of one picture: who answers which of its terms, and in which order their passes run.
#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/render/private/implementation.h"
#include "core/scene/environment_light.h"
#include "core/technique/bound.h"
#include "core/technique/light_batch.h"
#include "core/technique/module.h"
#include "glsl/materials/material_model.glsl"

namespace limn::render {

void Renderer::Implementation::build() {
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
    gbuffer = gbufferPass.add(*graph, gpuScene, handles, settings.size, scene::Surfaces::all, readsPlaces());
  else
    graph->leaveOut("gbuffer", "core", "the scene has no geometry");
  askSurface();
  const auto building = services.begin(*graph, handles, pose);
  output = isFactor(settings.term) ? addFactor() : addRadiance();
  graph->output(output);
  display = {};
  if (settings.display) {
    display = deferred.addToneMapping({*graph, handles, gbuffer, settings.size}, output,
                                      isFactor(settings.term), *settings.display);
    graph->output(display);
  }
  if (settings.channels && gbuffer.depth)
    for (frame::TextureHandle kept : {gbuffer.depth, gbuffer.instance, gbuffer.albedo, gbuffer.normal})
      graph->output(kept);
  addInspector();
  graph->prepare(device, shaders, pool, compileProgress);
}

void Renderer::Implementation::mountTechnique(const TechniquePlugin& plugin) {
  const std::string prefix = fmt::format("techniques/{}/", plugin.info->name);
  if (std::find(mounted.begin(), mounted.end(), prefix) != mounted.end()) return;
  shaders.mount(prefix, inTechnique(plugin, plugin.sources),
                shaderOverride.empty() ? shaderOverride : shaderOverride / prefix);
  mounted.push_back(prefix);
}

TechniqueInputs Renderer::Implementation::inputsOf(const Use& use, const SceneHandles& resources,
                                                   const GBuffer& seen) {
  return {scene, pose, gpuScene, services, use.settings->parameters, resources, seen, settings.size};
}

frame::TextureHandle Renderer::Implementation::ask(Use& use, Term term, std::span<const uint32_t> lights,
                                                   const Lighting& lit, frame::TextureHandle entering) {
  TechniqueInputs inputs = inputsOf(use, lit.handles, lit.gbuffer);
  inputs.entering = entering;
  inputs.bodyAlbedo = lit.bodyAlbedo;
  if (term == Term::specular) inputs.matte = matte;
  const TechniquePlugin& plugin = *use.settings->plugin;
  inputs.bound = settings.bound && hasBound(plugin);
  const frame::TextureHandle answer = inTechnique(plugin, [&] {
    return use.technique->addPasses(*graph, inputs, {term, lights, lit.radiance, settings.light >= 0});
  });
  if (!answer)
    throw Error(fmt::format("{}: it answers {} with nothing", described(plugin), limn::name(term)));
  return answer;
}

void Renderer::Implementation::askSurface() {
  Use* use = answering(Term::surface);
  if (!use) return;
  const TechniquePlugin& plugin = *use->settings->plugin;
  if (handles.modelKinds == 0 || isFactor(settings.term) || !gbuffer.depth)
    return graph->leaveOut("surface", plugin.info->name,
                           handles.modelKinds == 0 ? "no material has a model" : "no light is reflected");
  const TechniqueInputs inputs = inputsOf(*use, handles, gbuffer);
  scene::SurfaceAnswer answer = inTechnique(plugin, [&] { return use->technique->surface(*graph, inputs); });
  if (answer.file.empty())
    throw Error(fmt::format("{}: it answers {} with nothing", described(plugin), limn::name(Term::surface)));
  handles.surface = std::make_shared<const scene::SurfaceAnswer>(std::move(answer));
}

Renderer::Implementation::Use* Renderer::Implementation::answering(Term term) {
  for (Use& use : uses)
    if (contains(termsOf(*use.settings), term)) return &use;
  return nullptr;
}

void Renderer::Implementation::noteEmitting() {
  emitting.resize(pose.lights.size());
  for (size_t i = 0; i < emitting.size(); ++i) emitting[i] = emits(i);
}

std::vector<uint32_t> Renderer::Implementation::activeLights() {
  std::vector<uint32_t> lights;
  for (uint32_t i = 0; i < pose.lights.size(); ++i) {
    if (settings.light >= 0 && static_cast<uint32_t>(settings.light) != i) continue;
    if (!emits(i) && !isFactor(settings.term) && !forced(Saving::darkLights)) {
      graph->leaveOut(fmt::format("light {}", pose.lightNames[i]), "core", "it emits nothing");
      continue;
    }
    lights.push_back(i);
  }
  return lights;
}

std::vector<uint32_t> Renderer::Implementation::directLights(std::span<const uint32_t> lights) {
  std::vector<uint32_t> direct(lights.begin(), lights.end());
  if (settings.light >= 0 || !answering(Term::environment)) return direct;
  const size_t replaced = std::erase_if(direct, [&](uint32_t light) { return standsForEnvironment(light); });
  if (replaced > 0)
    graph->leaveOut("direct light of the environment's lights", "core",
                    "a technique answers the environment's light");
  return direct;
}

frame::TextureHandle Renderer::Implementation::factorTarget(Term term, int layers) {
  return graph->createTexture(limn::name(term),
                              {GL_TEXTURE_2D_ARRAY, GL_R16, settings.size.x, settings.size.y, layers, 1});
}

size_t Renderer::Implementation::lightsByRatio(std::span<const uint32_t> lights) {
  if (!scene.environment.shadowedByRatio || settings.light >= 0) return 0;
  return static_cast<size_t>(
      std::ranges::count_if(lights, [&](uint32_t light) { return standsForEnvironment(light); }));
}

void Renderer::Implementation::addDirect(std::span<Lighting> lightings, std::span<const uint32_t> lights) {
  const size_t byRatio = lightsByRatio(lights);
  if (Use* direct = answering(Term::direct)) {
    if (byRatio > 0)
      graph->leaveOut("environment light by ratio", "core", "a technique answers direct light");
    for (Lighting& lit : lightings) lit.radiance = ask(*direct, Term::direct, lights, lit);
    return;
  }
  Use* shadowing = answering(Term::visibility);
  const auto factor = [&](Term term, Use* use, std::span<const uint32_t> batch) {
    if (!use) return frame::TextureHandle{};
    const Lighting& first = lightings.front();
    return ask(*use, term, batch,
               {first.handles, first.gbuffer, factorTarget(term, static_cast<int>(batch.size()))});
  };
  const auto inBatches = [&](std::span<const uint32_t> some, auto add) {
    for (size_t first = 0; first < some.size(); first += kLightBatch) {
      const auto batch = some.subspan(first, std::min(kLightBatch, some.size() - first));
      add(Deferred::Batch{.lights = batch,
                          .visibility = factor(Term::visibility, shadowing, batch),
                          .relief = factor(Term::relief, bumps, batch)},
          first + batch.size() == some.size());
    }
  };
  // The environment's lights come after all others.
  inBatches(lights.first(lights.size() - byRatio), [&](const Deferred::Batch& batch, bool /*last*/) {
    for (Lighting& lit : lightings) lit.radiance = deferred.addLights(frameOf(lit), lit.radiance, batch);
  });
  std::vector<Deferred::EnvironmentSums> sums(lightings.size());
  inBatches(lights.last(byRatio), [&](const Deferred::Batch& batch, bool last) {
    for (size_t i = 0; i < lightings.size(); ++i)
      lightings[i].radiance =
          deferred.addEnvironmentShare(frameOf(lightings[i]), lightings[i].radiance, batch, sums[i], last);
  });
}

void Renderer::Implementation::addEnvironment(std::span<Lighting> lightings) {
  const char* why = nullptr;
  Use* use = answering(Term::environment);
  if (!forced(Saving::environment)) {
    if (!scene.environment) why = "no environment";
    if (scene.environment && !use && scene::isBlack(scene.environment)) why = "the environment is black";
  }
  if (scene.environment && settings.light >= 0) why = "another light was chosen";
  if (!why && !use && !scene.environment.lights.empty()) why = "lights stand for it";
  if (why) return graph->leaveOut("environment light", "core", why);
  for (Lighting& lit : lightings)
    lit.radiance =
        use ? ask(*use, Term::environment, {}, lit) : deferred.addEnvironment(frameOf(lit), lit.radiance);
}

Renderer::Implementation::Use* Renderer::Implementation::answeringSpecular() {
  Use* use = answering(Term::specular);
  if (!use || (settings.term != Term::final && settings.term != Term::specular)) return nullptr;
  if (gpuScene.hasSpecular()) return use;
  graph->leaveOut("specular surfaces", use->settings->plugin->info->name,
                  "the scene has no specular surface");
  return nullptr;
}

Renderer::Implementation::Use* Renderer::Implementation::answeringRelief() {
  Use* use = answering(Term::relief);
  if (!use) return nullptr;
  const bool lit = settings.term == Term::final || settings.term == Term::direct ||
                   settings.term == Term::subsurface || settings.term == Term::specular ||
                   settings.term == Term::relief;
  const char* why = !gpuScene.hasHeights() ? "no material has a height map"
                    : !lit                 ? "no direct light is shown"
                                           : nullptr;
  if (!why) return use;
  graph->leaveOut("relief", use->settings->plugin->info->name, why);
  return nullptr;
}

bool Renderer::Implementation::readsPlaces() const {
  const bool indirect = settings.term == Term::final || settings.term == Term::indirect ||
                        settings.term == Term::subsurface || settings.term == Term::specular;
  return gpuScene.hasHeights() && std::ranges::any_of(uses, [&](const Use& use) {
           const bool answers =
               &use == bumps || (indirect && contains(termsOf(*use.settings), Term::indirect));
           return answers && use.settings->plugin->info->places;
         });
}

std::vector<Renderer::Implementation::Lighting> Renderer::Implementation::lightings(
    frame::TextureHandle radiance) {
  const Lighting seen{handles, matte, radiance};
  const bool reflected = settings.term != Term::subsurface && (summed & (Term::direct | Term::indirect)) != 0;
  std::vector<Lighting> result;
  if (reflected) result.push_back(seen);
  if (!gpuScene.hasTranslucent()) {
    if (const Use* use = answering(Term::subsurface))
      graph->leaveOut("subsurface", use->settings->plugin->info->name, "no surface is translucent");
    return result;
  }
  if (reflected)
    result.back().gbuffer = Deferred::addTranslucentView(frameOf(seen), Deferred::Boundary::reflecting);
  if (!contains(summed, Term::subsurface)) return result;
  Lighting entering{handles, Deferred::addTranslucentView(frameOf(seen), Deferred::Boundary::entering),
                    Deferred::black(*graph, "entering light", settings.size), matte.albedo};
  entering.handles.modelKinds = 1u << glsl::model_entry;
  entering.handles.models = entering.handles.measured = {};
  entering.handles.surface = nullptr;
  result.push_back(std::move(entering));
  return result;
}

void Renderer::Implementation::addLight(std::span<Lighting> lightings, std::span<const uint32_t> lights) {
  if (contains(summed, Term::direct)) {
    const std::vector<uint32_t> direct = directLights(lights);
    if (!direct.empty())
      addDirect(lightings, direct);
    else
      graph->leaveOut("lights", "core", "the scene has no light");
    addEnvironment(lightings);
  }
  if (!contains(summed, Term::indirect)) return;
  for (Use& use : uses) {
    if (!contains(termsOf(*use.settings), Term::indirect)) continue;
    for (Lighting& lit : lightings) lit.radiance = ask(use, Term::indirect, lights, lit);
  }
}

frame::TextureHandle Renderer::Implementation::addSubsurface(frame::TextureHandle radiance,
                                                             frame::TextureHandle entering,
                                                             std::span<const uint32_t> lights) {
  const Lighting seen{handles, matte, radiance};
  Use* use = answering(Term::subsurface);
  return use ? ask(*use, Term::subsurface, lights, seen, entering)
             : Deferred::addLocalSubsurface(frameOf(seen), radiance, entering);
}

frame::TextureHandle Renderer::Implementation::addRadiance() {
  Use* specular = answeringSpecular();
  matte = specular
              ? mattePass.add(*graph, gpuScene, handles, settings.size, scene::Surfaces::matte, readsPlaces())
              : gbuffer;
  const bool all = settings.term == Term::final;
  summed = all || specular                     ? kAnswerableTerms
           : settings.term == Term::subsurface ? Term::direct | Term::indirect | Term::subsurface
                                               : termSet(settings.term);
  frame::TextureHandle radiance =
      deferred.start({*graph, handles, matte, settings.size}, specular ? Deferred::Start::emission
                                                              : all    ? Deferred::Start::emissionAndSpecular
                                                                       : Deferred::Start::black);
  if (!gbuffer.depth) {
    graph->leaveOut("lighting", "core", "the scene has no geometry");
    return radiance;
  }
  const std::vector<uint32_t> lights = activeLights();
  std::vector<Lighting> lit = lightings(radiance);
  if (!lit.empty()) {
    addLight(lit, lights);
    if (!lit.front().bodyAlbedo) radiance = lit.front().radiance;
    if (lit.back().bodyAlbedo) radiance = addSubsurface(radiance, lit.back().radiance, lights);
  }
  const Deferred::Frame frame{*graph, handles, gbuffer, settings.size};
  if (specular) {
    const frame::TextureHandle seen = ask(*specular, Term::specular, lights, {handles, gbuffer, radiance});
    radiance = all ? deferred.addSpecular(frame, radiance, seen) : seen;
  }
  const auto add = [&](Term term) {
    if (!all && settings.term != term) return;
    for (Use& use : uses)
      if (contains(termsOf(*use.settings), term))
        radiance = ask(use, term, lights, {handles, gbuffer, radiance});
  };
  add(Term::caustic);
  const char* clear = !scene.medium.present()        ? "the scene has no medium"
                      : settings.term == Term::media ? "no surface is shown"
                                                     : nullptr;
  if (clear)
    graph->leaveOut("transmittance", "core", clear);
  else
    radiance = deferred.addTransmittance(frame, radiance);
  add(Term::media);
  return radiance;
}

frame::TextureHandle Renderer::Implementation::addFactor() {
  const Term term = settings.term;
  const std::vector<uint32_t> lights = directLights(activeLights());
  if (lights.size() != 1)
    throw UsageError(
        fmt::format("--output-term {} shows one light; choose it with --light", limn::name(term)));
  if (!gbuffer.depth)
    throw Error(fmt::format("{} has no surface to show: the scene has no geometry", limn::name(term)));
  matte = gbuffer;
  const frame::TextureHandle target = factorTarget(term, 1);
  if (term == Term::relief && !bumps) return Deferred::clearFactor(*graph, target);
  return ask(*answering(term), term, lights, {handles, gbuffer, target});
}

void Renderer::Implementation::addInspector() {
  if (!settings.inspect) return;
  const Inspection& wanted = *settings.inspect;
  const frame::TextureHandle texture = graph->find(wanted.technique, wanted.pass, wanted.access);
  if (texture) inspector = std::make_unique<TextureInspector>(*graph, texture, inspectionView);
}

}  // namespace limn::render
