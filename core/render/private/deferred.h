// Declares core's own passes of the frame: emission and background, unshadowed light times visibility,
// environment light, what enters translucent surfaces, and what is seen in specular surfaces, drawn over the
// rest.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/frame/frame_graph.h"
#include "core/image/tone_mapping.h"
#include "core/scene/scene.h"
#include "core/shading_maps/shading_maps.h"
#include "core/technique/technique.h"

namespace limn::render {

class Deferred {
 public:
  Deferred(const scene::Scene& scene, shading_maps::ShadingMapService& maps) : scene_(scene), maps_(maps) {}

  struct Frame {
    frame::FrameGraph& graph;
    const SceneHandles& handles;
    const GBuffer& gbuffer;  ///< handles may be empty: the scene has no geometry
    glm::ivec2 size;
  };

  /// Says what is seen without any light.
  enum class Start : uint8_t {
    black,
    emission,            ///< and the background
    emissionAndSpecular  ///< also the environment in specular surfaces
  };
  frame::TextureHandle start(const Frame& frame, Start with);
  /// Returns a new RGBA32F texture of that size and name, black.
  static frame::TextureHandle black(frame::FrameGraph& graph, const char* name, glm::ivec2 size);
  /// Says how light meets translucent surfaces.
  enum class Boundary : uint8_t { reflecting, entering };
  /// Returns the frame's G-buffer with translucent surfaces that reflect at their boundaries alone, or with
  /// what enters them (glsl/deferred/translucent_view.comp.glsl).
  static GBuffer addTranslucentView(const Frame& frame, Boundary boundary);
  /// Adds the local limit of `entering`, RGBA32F, E / pi.
  static frame::TextureHandle addLocalSubsurface(const Frame& frame, frame::TextureHandle radiance,
                                                 frame::TextureHandle entering);
  /// Holds at most kLightBatch lights and their factors: R16 arrays, layer per light; an empty handle stands
  /// for 1.
  struct Batch {
    std::span<const uint32_t> lights;
    frame::TextureHandle visibility, relief;
  };
  /// Adds the sum of L_u V W over the batch.
  frame::TextureHandle addLights(const Frame& frame, frame::TextureHandle radiance, const Batch& batch);
  /// Holds, over the batches so far, what surfaces reflect of the environment's lights and what they would
  /// without shadows, diffuse parts and lobes apart, RGBA32F; empty handles before the first batch.
  using EnvironmentSums = std::array<frame::TextureHandle, 4>;
  /// Adds a batch of the environment's lights to `sums`; after the last one, adds the light of the
  /// environment, as far as these lights are seen, to the radiance that it returns.
  frame::TextureHandle addEnvironmentShare(const Frame& frame, frame::TextureHandle radiance,
                                           const Batch& batch, EnvironmentSums& sums, bool last);
  /// Returns `factor`, an array of one layer, as 1 everywhere.
  static frame::TextureHandle clearFactor(frame::FrameGraph& graph, frame::TextureHandle factor);
  /// Multiplies the radiance by the transmittance of the medium from what each pixel shows to the camera.
  frame::TextureHandle addTransmittance(const Frame& frame, frame::TextureHandle radiance);
  /// Adds the light of the environment, V = 1.
  frame::TextureHandle addEnvironment(const Frame& frame, frame::TextureHandle radiance);
  /// Returns a new texture: `seen` and their emission where the frame shows specular surfaces, `radiance`
  /// elsewhere.
  frame::TextureHandle addSpecular(const Frame& frame, frame::TextureHandle radiance,
                                   frame::TextureHandle seen);
  /// Returns what the window shows: RGBA8 of the tone-mapped picture. `layered` says that the picture is a
  /// factor of a light.
  frame::TextureHandle addToneMapping(const Frame& frame, frame::TextureHandle picture, bool layered,
                                      const ToneMapping& tone);

 private:
  /// Declares what passes over a batch of lights read (glsl/deferred/light_batch.glsl and
  /// glsl/surface/surface_response.glsl), and returns the program of `file` with its defines.
  gpu::ProgramDesc readLights(frame::PassBuilder& builder, const Frame& frame, const char* file,
                              const Batch& batch);
  /// Lets the pass run the program over a picture of that size.
  static void shadeLights(frame::PassBuilder& builder, gpu::ProgramDesc desc, const Batch& batch,
                          glm::ivec2 size);

  const scene::Scene& scene_;
  shading_maps::ShadingMapService& maps_;
};

}  // namespace limn::render
