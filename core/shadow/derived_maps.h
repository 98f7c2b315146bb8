// What shadow techniques look up instead of single texels of a shadow map: min-max pyramids and windows,
// N-buffers, summed-area tables, mip chains of moments. Each is built when the first technique asks, by
// passes of the frame graph, and shared by all that ask.
#pragma once

#include <cstdint>
#include <memory>

#include "core/frame/frame_graph.h"
#include "core/shadow/moment_table.h"

namespace limn::shadow {

/// RG32F array with a full mip chain: (least, greatest) depth. Lookups: glsl/min_max_pyramid.glsl.
struct MinMaxPyramid {
  frame::TextureHandle texture;
  int levels = 0;
};

/// What a summed-area table sums.
enum class SatMoments {
  z,
  zAndSquare,  ///< z and z^2
};

/// How a summed-area table is built; the result is the same to the bit. `automatic` goes by the kind of
/// renderer, not by a measurement at start-up: where threads are few, one per row wins at every size
/// (llvmpipe: sharedMemory takes 5.5 to 8 times as long at 512 texels, 3.4 to 4.2 times at 2048), and a GPU
/// needs more threads than a map has rows. A measurement would cost start-up time and could be wrong on a
/// busy machine.
enum class SatMethod {
  automatic,     ///< rowParallel on software renderers, sharedMemory elsewhere
  rowParallel,   ///< one thread per row, then one per column
  sharedMemory,  ///< a work group scans part of a row (column) at a time and carries its sum on
};

struct SatDesc {
  int bits = 16;  ///< of a quantised depth, 8 to 24
  /// 32-bit words per moment. 1: z exact up to glsl::sat_largest_box() texels, 65537 at 16 bits; z^2 rounded
  /// to `bits` bits, which leaves an error of the order 2^-bits in the variance. 2: both exact as 64-bit
  /// sums. 0: 1 for z alone, else 2.
  int words = 0;
  SatMoments moments = SatMoments::zAndSquare;
  SatMethod method = SatMethod::automatic;
  bool operator==(const SatDesc&) const = default;
};

/// Lookups: glsl/summed_area_table.glsl.
struct SummedAreaTable {
  frame::TextureHandle texture;  ///< integer array of one level: R32UI, RG32UI or RGBA32UI
  uint32_t format = 0;  ///< what the lookups need to know of it, for a uniform: see glsl::sat_format()
};

/// The derived maps of one graph. A source is an R32F array with values in [0, 1]; `cacheable` says whether
/// its contents, and so the derived ones, are to be kept while nothing changes.
class LIMN_API DerivedMaps {
 public:
  explicit DerivedMaps(const gpu::Device& device);
  ~DerivedMaps();
  DerivedMaps(const DerivedMaps&) = delete;
  DerivedMaps& operator=(const DerivedMaps&) = delete;

  /// Forgets what was built in the former graph.
  void begin(frame::FrameGraph& graph);

  MinMaxPyramid minMaxPyramid(frame::TextureHandle depth, bool cacheable);
  /// RG32F array with a mip chain: (least, greatest) depth of overlapping windows, which bound boxes more
  /// tightly than a pyramid for the same time and memory. Lookups: glsl/min_max_windows.glsl.
  frame::TextureHandle minMaxWindows(frame::TextureHandle depth, bool cacheable);
  /// RG32F array of one level: (least, greatest) depth of overlapping windows, which bound boxes more tightly
  /// than a pyramid for 2 log2(size) times a map's memory. Lookups: glsl/n_buffer.glsl. Throws
  /// UsageError beyond 4 GiB and beyond the layers that the device has in one array.
  frame::TextureHandle nBuffer(frame::TextureHandle depth, bool cacheable);
  /// Throws UsageError for a description out of range and for tables beyond 4 GiB.
  SummedAreaTable summedAreaTable(frame::TextureHandle depth, bool cacheable, const SatDesc& desc);
  /// bits: of each moment, 10 to 20; 0: by the maps' size (momentBits). Throws UsageError as summedAreaTable.
  MomentTable momentTable(frame::TextureHandle depth, bool cacheable, int bits);
  /// RG32F array with a full mip chain: means of z and of z^2 over equal parts of the map; also where a size
  /// is odd the mean over each level is that of the map.
  frame::TextureHandle momentMips(frame::TextureHandle depth, bool cacheable);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::shadow
