// Declares the service that holds what shading looks up on the GPU, whoever asks: the environment's map, the
// same with coarser levels and filtered for surfaces, and the table of linearly transformed cosines. Each is
// made and uploaded when a pass that needs it is first declared, and kept; and so is what samples of the
// environment are drawn by.
#pragma once

#include <memory>

#include "core/frame/frame_graph.h"
#include "core/gpu/objects.h"
#include "core/scene/scene.h"
#include "core/technique/frame_service.h"

namespace limn::scene {
class EnvironmentLight;
}

namespace limn::shading_maps {

class LIMN_API ShadingMapService : public FrameService {
 public:
  static constexpr const char* serviceName = "shading maps";

  /// Takes the device and the scene, which must outlive the service. A scene without an environment has a
  /// black one.
  ShadingMapService(gpu::Device& device, const scene::Scene& scene);
  ~ShadingMapService() override;

  /// Returns the scene's environment as a light that is sampled. Its tables are made once, for all rotations
  /// and scales.
  const scene::EnvironmentLight& environmentLight();
  /// Returns the equirectangular map of the scene's environment, RGB32F, W/(sr m^2), in the environment's own
  /// frame and without its scale: bilinear, repeated around the horizon. Empty without an environment.
  frame::TextureHandle radiance();
  /// Returns the same with coarser levels, each the mean over solid angle of the one before, and trilinear; a
  /// black one without an environment. For glsl/light/radiance_levels.glsl.
  frame::TextureHandle radianceLevels();
  /// Returns the table of linearly transformed cosines ("ltc_table" in glsl/light/ltc.glsl).
  frame::TextureHandle ltcTable();
  /// Declares what glsl/light/reflected_environment.glsl looks up of the environment, for a pass that reads
  /// surfaces of the kinds `modelKinds` (SceneHandles::modelKinds).
  void readReflected(frame::PassBuilder& pass, uint32_t modelKinds);

 private:
  struct Entry {
    gpu::Texture texture;
    frame::TextureHandle handle;  ///< in the graph that is being built; empty: not asked for
  };
  void begin() override;
  /// Returns the entry's texture, which is there, in the graph that is being built.
  frame::TextureHandle handleOf(Entry& entry, const char* name);
  /// Returns the same, and makes the texture first where it is not there.
  template <class Make>
  frame::TextureHandle import(Entry& entry, const char* name, Make make);
  /// Returns the scene's environment, or a black one.
  const scene::Environment& environment() const;

  gpu::Device& device_;
  const scene::Scene& scene_;
  Entry radiance_, levels_, ltc_, irradiance_, filtered_, grazing_;
  std::unique_ptr<scene::EnvironmentLight> light_;  ///< null: not asked for
};

}  // namespace limn::shading_maps
