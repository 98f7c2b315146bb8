// Declares the scene and its G-buffer as resources of a frame graph.
#pragma once

#include <cstdint>
#include <memory>

#include "core/frame/frame_graph.h"

namespace limn {

namespace scene {
struct SurfaceAnswer;
}  // namespace scene

/// Holds the G-buffer (layout: glsl/surface/gbuffer.glsl), screen-sized with one sample at the pixel centre.
struct GBuffer {
  frame::TextureHandle depth;            ///< R32F, linear view depth in metres, 0: no coverage
  frame::TextureHandle normal;           ///< RG16_SNORM octahedral, shading normal, world space
  frame::TextureHandle geometricNormal;  ///< RG16_SNORM octahedral, faces the camera
  frame::TextureHandle albedo;           ///< RGBA16, square root of the base colour, a: metallic
  frame::TextureHandle material;         ///< RGBA8, see glsl/surface/gbuffer.glsl
  frame::TextureHandle emission;         ///< RGBA16F, W/(sr m^2)
  frame::TextureHandle instance;         ///< R32UI, index into Pose::instances, 0xffffffff: none
  /// R16: the tangent as a turn about the normal (glsl::frame_turned); empty where no material of the scene
  /// is anisotropic. With `places` RGBA16: also where the pixel lies in its height map
  /// (glsl::GBufferPlace).
  frame::TextureHandle tangent{};
  bool places = false;
};

/// Holds the names by which shaders sample the textures of a GBuffer (glsl/surface/gbuffer_input.glsl).
struct GBufferNames {
  const char* depth = "gbuffer_depth";
  const char* normal = "gbuffer_normal";
  const char* geometricNormal = "gbuffer_geometric_normal";
  const char* albedo = "gbuffer_albedo";
  const char* material = "gbuffer_material";
  const char* emission = "gbuffer_emission";
  const char* instance = "gbuffer_instance";
  const char* tangent = "gbuffer_tangent";
};
inline constexpr GBufferNames kGBufferNames;

/// Declares that a pass samples what glsl/surface/gbuffer_input.glsl's pixel_surface() and pixel_position()
/// need: all of the G-buffer but its instances and tangents.
LIMN_API void readSurfaces(frame::PassBuilder& pass, const GBuffer& gbuffer);

/// Holds scene data as graph resources. The version of each handle changes when its contents change, so the
/// results of a cacheable pass that reads `geometry`, `instances` and `lights` (and not `frame`) stay valid
/// while the camera moves. Whatever depends on where surfaces are reads both `geometry` and `instances`: an
/// instance that moves as a whole changes the latter alone.
struct SceneHandles {
  frame::BufferHandle frame;  ///< uniform block FrameBlock
  /// Uniform block FrameBlock that holds the medium and nothing else, for cacheable passes of light that is
  /// on its way to surfaces: what they make stays valid while the camera moves.
  frame::BufferHandle medium;
  frame::BufferHandle geometry;        ///< stands for all vertex and index data after deformation
  frame::BufferHandle instances;       ///< storage buffer of glsl::Instance: matrices and materials
  frame::BufferHandle materials;       ///< storage buffer of glsl::Material
  frame::BufferHandle lights;          ///< storage buffer of glsl::Light, index = light index
  frame::TextureHandle lightTextures;  ///< RGBA32F array of textures in front of spot lights; empty: none
  frame::TextureHandle density;        ///< R32F volume (scene::DensityGrid); empty: the medium is homogeneous
  frame::BufferHandle models{};    ///< storage buffer of glsl::MaterialModel, one per material; empty: none
  frame::BufferHandle measured{};  ///< storage buffer of Scene::measured; empty: none
  uint32_t modelKinds = 0;         ///< bit 1 << kind of each model of the scene's materials
  /// Holds the answer to Term::surface; null: none, or the scene has no models.
  std::shared_ptr<const scene::SurfaceAnswer> surface{};
};

}  // namespace limn
