// The plug-in interface. A technique is one folder that builds to one shared module with one entry point.
//
//     #include "core/technique/technique.h"
//
//     namespace {
//     constexpr limn::Parameter parameters[] = {...};
//     class Example : public limn::Technique {
//       limn::frame::TextureHandle addPasses(limn::frame::FrameGraph& graph, const limn::TechniqueInputs&
//       inputs,
//                                            const limn::TermRequest& request) override { ... }
//     };
//     constexpr limn::TechniqueInfo info{.name = "example", ...};
//     }  // namespace
//     LIMN_TECHNIQUE(info, Example)
//
// The core loads the module when the technique is asked for, compares the handshake (interface number,
// compiler, settings that change the layout of types, hash of all headers and shared GLSL), looks over what
// the module declares, and refuses with a message that names both sides.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>

#include "core/frame/frame_graph.h"
#include "core/gpu/shader_source.h"
#include "core/technique/handshake.h"
#include "core/technique/parameters.h"
#include "core/technique/stress_case.h"

namespace limn {

namespace scene {
struct Scene;
struct Pose;
class GpuScene;
}  // namespace scene
namespace shadow {
class ShadowMapService;
}
namespace indirect {
class VirtualLightService;
}
namespace caustics {
class CausticRayService;
}

/// The terms of the rendering equation a technique may answer (path classes: direct L D E, indirect L D+ D E,
/// caustic L S+ D E, media L S* M E, specular L D+ S+ E and the environment's S+ E).
enum class Term : uint32_t {
  visibility = 1,  ///< V of each light, 0 occluded .. 1 lit
  direct = 2,      ///< sum over the lights of reflected direct light, shadows included
  indirect = 4,
  caustic = 8,
  media = 16,
  environment =
      32,  ///< reflected light of the environment's map, shadows included; instead of all lights that stand
           ///< for parts of it. One technique at most, beside one that answers visibility or direct
  specular = 64,  ///< what the camera sees in specular surfaces, caustics and light in a medium left out;
                  ///< unanswered: the environment alone. One technique at most
};
using TermSet = uint32_t;
constexpr TermSet operator|(Term a, Term b) {
  return static_cast<TermSet>(a) | static_cast<TermSet>(b);
}
constexpr TermSet operator|(TermSet a, Term b) {
  return a | static_cast<TermSet>(b);
}
constexpr TermSet termSet(Term term) {
  return static_cast<TermSet>(term);
}
constexpr bool contains(TermSet set, Term term) {
  return (set & static_cast<TermSet>(term)) != 0;
}
LIMN_API const char* name(Term term);

struct TechniqueInfo {
  const char* name;    ///< folder name, identifier
  const char* title;   ///< for people
  const char* source;  ///< paper, year, or the thesis's chapter
  TermSet terms = 0;
  std::span<const Parameter> parameters;
  /// Extremes of the method itself; those that every technique meets are core's (core/bench/stress.h).
  std::span<const StressCase> stress;
};

/// The G-buffer (layout: glsl/gbuffer.glsl). Screen-sized, one sample at the pixel centre.
struct GBuffer {
  frame::TextureHandle depth;            ///< R32F, linear view depth in metres, 0: no coverage
  frame::TextureHandle normal;           ///< RG16_SNORM octahedral, shading normal, world space
  frame::TextureHandle geometricNormal;  ///< RG16_SNORM octahedral, faces the camera
  frame::TextureHandle albedo;           ///< RGBA16, square root of the base colour, a: metallic
  frame::TextureHandle material;         ///< RGBA8, see glsl/gbuffer.glsl
  frame::TextureHandle emission;         ///< RGBA16F, W/(sr m^2)
  frame::TextureHandle instance;         ///< R32UI, index into Pose::instances, 0xffffffff: none
};

/// Scene data as graph resources. Their versions change with what they hold, so a cacheable pass that reads
/// `geometry` and `lights` (and not `frame`) survives a moving camera.
struct SceneHandles {
  frame::BufferHandle frame;           ///< uniform block FrameBlock
  frame::BufferHandle geometry;        ///< stands for all vertex, index and instance data after deformation
  frame::BufferHandle instances;       ///< storage buffer of glsl::Instance
  frame::BufferHandle materials;       ///< storage buffer of glsl::Material
  frame::BufferHandle lights;          ///< storage buffer of glsl::Light, index = light index
  frame::TextureHandle lightTextures;  ///< RGBA32F array that spots shine through; empty: none does
  frame::TextureHandle density;        ///< R32F volume (scene::DensityGrid); empty: the medium is homogeneous
};

/// What every technique is given.
struct TechniqueInputs {
  const scene::Scene& scene;
  const scene::Pose&
      pose;  ///< state at the time of building; moves afterwards, so read it only for its structure
  scene::GpuScene& gpuScene;  ///< draws geometry
  shadow::ShadowMapService& shadowMaps;
  indirect::VirtualLightService& virtualLights;
  caustics::CausticRayService& causticRays;
  const ParameterValues& parameters;
  SceneHandles handles;
  /// The surfaces to light. Where specular is answered: of visibility, direct, environment and indirect those
  /// behind the specular ones.
  GBuffer gbuffer;
  glm::ivec2 size;                        ///< pixels
  GBuffer matte{};                        ///< of specular: the G-buffer without specular surfaces
  frame::TextureHandle environmentMap{};  ///< of specular: equirectangular, RGB32F; empty: no environment
};

/// One question to a technique.
struct TermRequest {
  Term term;
  /// The lights asked about (indices into Pose::lights); none for environment. For visibility: one batch,
  /// answered layer by layer.
  std::span<const uint32_t> lights;
  /// visibility: R16 array with one layer per entry of `lights`; the pass writes every pixel, and 1 where the
  /// pixel has no coverage or the light lies wholly behind the surface. specular: RGBA32F, radiance of
  /// TechniqueInputs::matte and the background behind it, to be read; the answer is a texture of its own,
  /// black where no specular surface is seen. Other terms: RGBA32F radiance to add to.
  frame::TextureHandle target;
};

/// One instance per use in a frame graph; holds what lives as long as the graph (imported buffers, tables).
class Technique {
 public:
  virtual ~Technique() = default;
  /// Declares the passes that answer `request` and returns the target after them. Called once per batch of
  /// lights. Passes that the scene does not need are not declared but reported with graph.leaveOut().
  virtual frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                         const TermRequest& request) = 0;
  /// Called before each frame when lights or geometry may have moved. True asks for the graph to be rebuilt.
  virtual bool update(const scene::Pose&) { return false; }
};

/// What the entry point returns.
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
