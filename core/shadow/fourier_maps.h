// Declares Fourier basis maps of shadow maps: the filtered basis images from which convolution shadow maps
// compute the shadow test and the mean blocker depth for whole kernels (Annen et al. 2007, 2008). Series and
// lookups are in glsl/shadow/fourier_shadow.glsl and glsl/shadow/fourier_lookup.glsl.
#pragma once

#include <map>
#include <string>

#include "core/frame/frame_graph.h"
#include "core/shadow/derived_maps.h"

namespace limn::shadow {

enum class FourierFilter {
  mip,  ///< mip chains of 8-bit (z times basis: 16-bit) images: cheap, kernels are roughly tents
  sat,  ///< summed-area tables of integers, 32 bits per image: kernels are exact boxes
};

enum class FourierWindow { none, lanczos, fejer };  // as fourier_window_* in glsl/shadow/fourier_shadow.glsl

/// Says which depths of a map the series spans.
enum class FourierFit {
  map,    ///< near to far of the view
  range,  ///< from the least to the greatest depth in the map
  plane,  ///< the same relative to a plane fitted to the map, where that range is smaller
};

struct FourierDesc {
  int order = 4;  ///< M, terms of the series, 1 to 64
  FourierFilter filter = FourierFilter::sat;
  FourierWindow window = FourierWindow::none;
  FourierFit fit = FourierFit::plane;
  SatMethod method = SatMethod::automatic;
  bool operator==(const FourierDesc&) const = default;
};

/// Holds constants of the series S(x) = 1/2 + sum of u_k sin(c_k x), derived numerically.
struct FourierConstants {
  double delta = 0;      ///< offset before the receiver for evaluation: S(delta) = 1, or S is flat there
  double range = 0;      ///< R = 1 - 2 delta: depths lie in [0, R]
  double overshoot = 0;  ///< greatest S - 1; negative where S stays below 1
  double dip = 0;        ///< least S in [delta, 1 - delta]
  double valley = 0;     ///< place of the dip, at most 1/2; S falls monotonically to it once below 1
  double gain = 0;       ///< a_M of ringing suppression: maps depths at or behind the receiver to 1
  double level = 0;      ///< S(delta): 1, or less where S stays below 1
  double tolerance =
      0;  ///< half the depth t that a lit plane may span within a kernel: mean S stays above dip
  double curvature = 0;  ///< mean S over such a plane is at least level - curvature t^2
};

/// Returns S(x).
LIMN_API double fourierSeries(double x, int order, FourierWindow window);
/// Returns the constants of a series. Throws UsageError for an order outside 1 to 64.
LIMN_API FourierConstants fourierConstants(int order, FourierWindow window);
/// Returns a bound on the error of S when every basis value is off by at most half of 1 / scale.
LIMN_API double fourierNoise(int order, FourierWindow window, int scale);

struct FourierMaps {
  frame::TextureHandle basis = {};       ///< groups() layers per map: RGBA8_SNORM with mips, or RGBA32I sums
  frame::TextureHandle depthBasis = {};  ///< the same times depth: RGBA16_SNORM with mips, or RGBA32I
  frame::TextureHandle depth = {};       ///< a layer per map: R16 with mips, or R32I
  frame::BufferHandle ranges = {};       ///< storage buffer of glsl::FourierRange, index = layer of the map
  FourierDesc desc = {};
  FourierConstants constants = {};
  double noise = 0;                         ///< of S, from quantisation
  const gpu::Sampler* trilinear = nullptr;  ///< for mip maps; the service's

  int groups() const { return (desc.order + 1) / 2; }
  // Programs that include glsl/shadow/fourier_lookup.glsl must use these definitions and declarations.
  LIMN_API std::map<std::string, std::string> defines() const;
  LIMN_API void declare(frame::PassBuilder& pass) const;
};

/// Declares the passes that build the maps of `depth`, an R32F array with values in [0, 1]. Throws UsageError
/// for a description out of range, and for maps that take more than 4 GiB or more layers than the device
/// allows.
LIMN_API FourierMaps addFourierMaps(frame::FrameGraph& graph, const gpu::Device& device,
                                    frame::TextureHandle depth, const MinMaxPyramid& pyramid, bool cacheable,
                                    FourierDesc desc);

}  // namespace limn::shadow
