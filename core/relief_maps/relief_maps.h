// Declares the service that makes tables of the scene's height maps on the GPU: what their texels see, or
// their heights. Each is computed once, when a technique first requests it, and kept for as long as the
// graphs that follow request it.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/gpu/objects.h"
#include "core/relief/interreflection.h"
#include "core/scene/scene.h"
#include "core/technique/frame_service.h"
#include "glsl/relief/relief_field.glsl"

namespace limn::relief_maps {

enum class Table : uint8_t {
  moments,    ///< moment ellipses of the horizons, with levels of means (relief::EllipseMean)
  nearest,    ///< the ellipses that differ least from what the horizons leave (relief::nearestEllipse), too
  published,  ///< the published fit's ellipses (relief::fitPublished), as centres and covariances; one level
  ambient,    ///< the share of the sky that the horizons leave as floats, with levels of means
  horizons,   ///< tangents of the horizons' elevations (glsl/relief/horizon_map.glsl) as halfs
  heights,    ///< metres, floats
  bounces     ///< which texels light from bump to bump comes from (glsl/relief/bounce_paths.glsl)
};

struct ReliefMapDesc {
  Table table = Table::moments;
  int azimuths = 32;     ///< of ellipses and of shares of the sky from horizons, and of horizons
  int directions = 256;  ///< of the published fit
  int paths = 64;        ///< of bounces, to each texel
  relief::BounceDirections bounceDirections = relief::BounceDirections::ownFrame;
  auto operator<=>(const ReliefMapDesc&) const = default;
};

/// Holds a table of all height maps of the scene as glsl/relief/relief_maps.glsl reads it.
struct ReliefMaps {
  frame::BufferHandle fields;  ///< storage buffer of glsl::ReliefField, one per entry of Scene::heights
  frame::BufferHandle values;  ///< storage buffer of words
};

/// Holds the contents of such a table.
struct ReliefTable {
  std::vector<glsl::ReliefField> fields;
  std::vector<uint32_t> values;
};

/// Returns the words that a table of the fields takes.
LIMN_API int64_t reliefTableWords(std::span<const relief::HeightField> fields, const ReliefMapDesc& desc);
/// Returns the bytes of the horizons that a field's part of a table is made from; 0: it needs none. They are
/// there until that part is made, and can be many times as large.
LIMN_API int64_t reliefHorizonBytes(const relief::HeightField& field, const ReliefMapDesc& desc);
/// Computes a table of the fields. Throws UsageError for horizons of a field above 4 GiB, and for bounces of
/// one of 2^24 - 1 texels or more.
LIMN_API ReliefTable makeReliefTable(std::span<const relief::HeightField> fields, const ReliefMapDesc& desc);

class LIMN_API ReliefMapService : public FrameService {
 public:
  static constexpr const char* serviceName = "relief maps";

  ReliefMapService(gpu::Device& device, const scene::Scene& scene);
  ~ReliefMapService() override;

  /// Returns a table of the scene's height maps, of which there is at least one. Throws UsageError when it
  /// would take more memory than a storage buffer may, for horizons of a map above 4 GiB, and for bounces of
  /// a map of 2^24 - 1 texels or more.
  ReliefMaps request(const ReliefMapDesc& desc);

 private:
  struct Entry {
    gpu::Buffer fields, values;
    ReliefMaps handles;     ///< in the graph that is being built
    bool requested = true;  ///< for the last graph
  };
  void begin() override;

  gpu::Device& device_;
  const scene::Scene& scene_;
  std::map<ReliefMapDesc, Entry> entries_;
};

}  // namespace limn::relief_maps
