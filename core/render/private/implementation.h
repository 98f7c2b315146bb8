// Internal: what a renderer holds, and the frame graph of one picture.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/gpu_scene/gpu_scene.h"
#include "core/render/private/deferred.h"
#include "core/render/renderer.h"
#include "core/render/services.h"

namespace limn::render {

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
  bool begun = false;          ///< the sequence has a whole frame
  std::vector<bool> emitting;  ///< of each light, when the graph was built
  std::vector<std::string> mounted;
  std::vector<Use> uses;

  // Handles of the current graph.
  std::unique_ptr<frame::FrameGraph> graph;
  SceneHandles handles;
  Use* bumps = nullptr;    ///< answers relief for the current graph
  TermSet summed = 0;      ///< terms that the radiance of the current graph holds
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
        deferred(shown, services.get<shading_maps::ShadingMapService>()) {
    shaders.mount("", embeddedSources(), shaderOverride);
  }

  ~Implementation() { dropGraph(); }

  void dropGraph();
  /// Where that fails there is no graph: the next frame builds one again.
  void rebuildGraph();
  /// Throws Error before the first frame, and after one whose graph could not be built.
  frame::FrameGraph& builtGraph() const;
  void refreshPose();
  bool render(frame::Timing timing, const frame::FrameGraph::Cancelled& cancelled);
  /// Returns whether a light was turned on or off: the graph leaves out what dark ones would need.
  bool switched() const;

  // In build_graph.cpp: who answers which terms of the picture, and in which order the passes run.
  void build();
  void mountTechnique(const TechniquePlugin& plugin);
  /// Holds light that is added up, and the surfaces that it falls on.
  struct Lighting {
    SceneHandles handles;
    GBuffer gbuffer;
    frame::TextureHandle radiance;
    /// Holds the albedo of bodies if the radiance is E / pi, that of light which enters them; empty: it is
    /// what surfaces reflect.
    frame::TextureHandle bodyAlbedo{};
  };
  Deferred::Frame frameOf(const Lighting& lighting) {
    return {*graph, lighting.handles, lighting.gbuffer, settings.size};
  }
  TechniqueInputs inputsOf(const Use& use, const SceneHandles& resources, const GBuffer& seen);
  /// Asks for light on `lit`, whose radiance is the target.
  frame::TextureHandle ask(Use& use, Term term, std::span<const uint32_t> lights, const Lighting& lit,
                           frame::TextureHandle entering = {});
  /// Asks how materials reflect light, for all passes that reflect it.
  void askSurface();
  /// Returns the first technique that answers the term; null: none.
  Use* answering(Term term);
  bool forced(Saving saving) const {
    return std::ranges::find(settings.forced, saving) != settings.forced.end();
  }
  bool emits(size_t light) const { return pose.lights[light].emission != glm::vec3(0); }
  void noteEmitting();
  bool standsForEnvironment(uint32_t light) const {
    return (pose.lights[light].flags & glsl::light_flag_environment) != 0;
  }
  /// Returns the lights that can contribute: the one asked for, or all that emit.
  std::vector<uint32_t> activeLights();
  /// Returns those of the lights whose direct light nobody else answers: of the environment's lights a
  /// technique that answers the environment takes the place there, and only there.
  std::vector<uint32_t> directLights(std::span<const uint32_t> lights);
  frame::TextureHandle factorTarget(Term term, int layers);
  /// Returns how many lights, the last ones, stand for the environment whose light has the shadows of theirs.
  size_t lightsByRatio(std::span<const uint32_t> lights);
  /// Adds the light of lamps to each lighting; V and W are the same for all.
  void addDirect(std::span<Lighting> lightings, std::span<const uint32_t> lights);
  void addEnvironment(std::span<Lighting> lightings);
  /// Returns what the picture asks to be lit: the surfaces, and what enters the translucent ones.
  std::vector<Lighting> lightings(frame::TextureHandle radiance);
  /// Adds direct light, that of the environment and that over other surfaces, as far as the picture has them.
  void addLight(std::span<Lighting> lightings, std::span<const uint32_t> lights);
  /// Returns the technique that shows the scene in its specular surfaces, if the picture has them.
  Use* answeringSpecular();
  /// Returns the technique that says what bumps leave of each light, if the picture has such light on height
  /// maps.
  Use* answeringRelief();
  /// Adds what leaves translucent surfaces, by a technique or by its local limit.
  frame::TextureHandle addSubsurface(frame::TextureHandle radiance, frame::TextureHandle entering,
                                     std::span<const uint32_t> lights);
  /// Returns whether the picture has light of a technique that reads where pixels lie in their height maps.
  bool readsPlaces() const;
  frame::TextureHandle addRadiance();
  /// Adds V or W of one light.
  frame::TextureHandle addFactor();
  /// Comes behind everything else: the pass looked at may be any.
  void addInspector();
};

}  // namespace limn::render
