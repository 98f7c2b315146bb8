// Declares the plug-in interface. A technique is a folder that builds one shared module with one entry point.
//
//     #include "core/technique/technique.h"
//
//     namespace {
//     constexpr limn::Parameter kParameters[] = {...};
//     class Example : public limn::Technique {
//       limn::frame::TextureHandle addPasses(
//           limn::frame::FrameGraph& graph, const limn::TechniqueInputs& inputs,
//           const limn::TermRequest& request) override { ... }
//     };
//     constexpr limn::TechniqueInfo kInfo{.name = "example", ...};
//     }  // namespace
//     LIMN_TECHNIQUE(kInfo, Example)
//
// The core loads the module when the technique is requested, compares the handshake (interface number,
// compiler, settings that change the layout of types, hash of all headers and shared GLSL) and checks what
// the module declares. It refuses a module that does not match with a message that names both sides.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>

#include "core/base/parameters.h"
#include "core/frame/frame_graph.h"
#include "core/gpu/shader_source.h"
#include "core/gpu_scene/scene_handles.h"
#include "core/gpu_scene/surface_input.h"
#include "core/question/term.h"
#include "core/technique/frame_service.h"
#include "core/technique/handshake.h"
#include "core/technique/stress_case.h"

namespace limn {

namespace scene {
struct Scene;
struct Pose;
class GpuScene;
}  // namespace scene

/// Declares a technique: what `limn list`, flags, suites and the renderer know of it.
struct TechniqueInfo {
  const char* name;    ///< folder name, identifier
  const char* title;   ///< for people
  const char* source;  ///< paper, year, or the thesis's chapter
  TermSet terms = 0;   ///< answered terms; core/question/term.h says which may be answered
  std::span<const Parameter> parameters;
  /// Holds extremes of the method itself; those that every technique meets are in core/bench/stress.h.
  std::span<const StressCase> stress;
  /// Says whether its passes read GBuffer::places, which exist only where the scene has height maps.
  bool places = false;
};

/// Holds what every technique receives.
struct TechniqueInputs {
  const scene::Scene& scene;
  /// Holds the state at the time of building; it changes afterwards, so only its structure may be read.
  const scene::Pose& pose;
  scene::GpuScene& gpuScene;  ///< draws geometry
  const FrameServices& services;
  const ParameterValues& parameters;
  SceneHandles handles;
  /// Holds the surfaces to light. When specular is answered: for visibility, relief, direct, environment,
  /// indirect and subsurface, the surfaces behind the specular ones. For direct, environment and indirect,
  /// translucent surfaces reflect as their boundaries do; what enters them is asked for by a second request,
  /// in whose G-buffer they reflect F_t / pi and nothing else reflects (glsl/materials/entry.glsl).
  GBuffer gbuffer;
  glm::ivec2 size;  ///< pixels
  GBuffer matte{};  ///< for specular: the G-buffer without specular surfaces
  /// For subsurface: RGBA32F, E / pi in W/(sr m^2) at each translucent pixel, where E is the irradiance that
  /// enters the body; 0 elsewhere.
  frame::TextureHandle entering{};
  /// For the request for what enters translucent surfaces: the albedo of the surfaces as they are, as
  /// GBuffer::albedo, whose colour is the share of entering light that leaves again. Empty for all others.
  frame::TextureHandle bodyAlbedo{};
  /// Says whether shadow::addVisibilityPass() runs the technique's bound (core/technique/bound.h).
  bool bound = false;

  /// Returns a service that shares work with other techniques, such as shadow::ShadowMapService.
  template <NamedService S>
  S& service() const {
    return services.get<S>();
  }
};

/// Holds one request to a technique.
struct TermRequest {
  Term term;
  /// Holds the lights of the request (indices into Pose::lights); none for environment. For visibility and
  /// relief: one batch, answered layer by layer.
  std::span<const uint32_t> lights;
  /// Holds the texture to answer into. visibility: R16 array with one layer per entry of `lights`; the pass
  /// writes every pixel, and 1 where the pixel has no coverage or the light lies wholly behind the surface.
  /// relief: the same texture for W, asked for only where the scene has height maps; 1 where the pixel has no
  /// place in a height map.
  /// specular: RGBA32F, radiance of TechniqueInputs::matte and the background behind it, to be read; the
  /// result is a separate texture, black where no specular surface is seen. Other terms: RGBA32F radiance to
  /// add to; subsurface is asked for only where the scene has translucent surfaces.
  frame::TextureHandle target;
  /// Says whether one light was chosen (--light): nothing else lights the picture, neither other lights nor
  /// the environment, whatever the scene has.
  bool chosen = false;
};

/// Answers requests; there is one instance per use in a frame graph. Holds what lives as long as the graph
/// (imported buffers, tables).
class Technique {
 public:
  virtual ~Technique() = default;
  /// Declares the passes that answer `request` and returns the target after them. Called once per batch of
  /// lights, and for direct, environment and indirect twice where the scene has translucent surfaces. Passes
  /// that the scene does not need are not declared but reported with graph.leaveOut().
  virtual frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                         const TermRequest& request) = 0;
  /// Declares the passes that make what material_response() looks up, and returns how Term::surface is
  /// answered: asked of techniques that declare it, before everything that reflects light, where the scene
  /// has material models. Its requests do not reach addPasses().
  virtual scene::SurfaceAnswer surface(frame::FrameGraph&, const TechniqueInputs&) { return {}; }
  /// Updates the technique: called before each frame when lights or geometry may have moved. Returns true to
  /// request that the graph is built again.
  virtual bool update(const scene::Pose&) { return false; }
};

/// Holds what the entry point returns.
struct TechniquePlugin {
  Handshake handshake;
  const TechniqueInfo* info;
  std::span<const gpu::EmbeddedSource> (*sources)();
  std::unique_ptr<Technique> (*create)();
};

}  // namespace limn

/// Defines the module's entry point. LIMN_TECHNIQUE_ID comes from limn_add_technique().
#define LIMN_TECHNIQUE(INFO, CLASS) LIMN_TECHNIQUE_EXPANDED(INFO, CLASS, LIMN_TECHNIQUE_ID)
#define LIMN_TECHNIQUE_EXPANDED(INFO, CLASS, ID) LIMN_TECHNIQUE_ENTRY(INFO, CLASS, ID)
#define LIMN_TECHNIQUE_ENTRY(INFO, CLASS, ID)                                                                \
  namespace limn_technique_##ID {                                                                            \
    std::span<const limn::gpu::EmbeddedSource> embeddedSources();                                            \
    const char* interfaceHash();                                                                             \
  }                                                                                                          \
  extern "C" __attribute__((visibility("default"))) const limn::TechniquePlugin* limnTechniquePlugin() {     \
    static const limn::TechniquePlugin plugin{                                                               \
        limn::handshake(limn_technique_##ID::interfaceHash()), &INFO, &limn_technique_##ID::embeddedSources, \
        []() -> std::unique_ptr<limn::Technique> { return std::make_unique<CLASS>(); }};                     \
    return &plugin;                                                                                          \
  }
