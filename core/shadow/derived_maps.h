// Declares what shadow techniques look up instead of single texels of a shadow map: min-max pyramids and
// windows, N-buffers, summed-area and moment tables. Each is built by passes of the frame graph when the
// first technique requests it, and shared by all that request it.
#pragma once

#include <cstdint>
#include <memory>

#include "core/frame/frame_graph.h"
#include "core/shadow/moment_table.h"

namespace limn::shadow {

/// Holds an RG32F array with a mip chain: (least, greatest) depth. Lookups are in
/// glsl/shadow/min_max_pyramid.glsl.
struct MinMaxPyramid {
  frame::TextureHandle texture;
  int levels = 0;
};

/// Says which quantities a summed-area table sums.
enum class SatMoments {
  z,
  zAndSquare,  ///< z and z^2
};

/// Says how a summed-area table is built; the result is identical to the bit. `automatic` chooses by the kind
/// of renderer, not by a measurement at start-up. With few threads, one thread per row is fastest at every
/// size (llvmpipe: sharedMemory takes 5.5 to 8 times as long at 512 texels, 3.4 to 4.2 times at 2048); a GPU
/// needs more threads than a map has rows. A measurement would cost start-up time and could be wrong on a
/// busy machine.
enum class SatMethod {
  automatic,     ///< rowParallel on software renderers, sharedMemory elsewhere
  rowParallel,   ///< one thread per row, then one per column
  sharedMemory,  ///< a work group scans a row (column) in parts and carries the sum over
};

struct SatDesc {
  int bits = 16;  ///< per quantised depth, 8 to 24
  /// Holds the number of 32-bit words per moment. 1: z exact up to glsl::sat_largest_box() texels, 65537 at
  /// 16 bits; z^2 rounded to `bits` bits, which leaves an error of the order 2^-bits in the variance. 2: both
  /// exact as 64-bit sums. 0: 1 for z alone, else 2.
  int words = 0;
  SatMoments moments = SatMoments::zAndSquare;
  SatMethod method = SatMethod::automatic;
  bool operator==(const SatDesc&) const = default;
};

/// Holds a summed-area table. Lookups are in glsl/shadow/summed_area_table.glsl.
struct SummedAreaTable {
  frame::TextureHandle texture;  ///< integer array of one level: R32UI, RG32UI or RGBA32UI
  uint32_t format = 0;           ///< uniform that the lookups need: see glsl::sat_format()
};

/// Holds the derived maps of one graph, which is passed to each call. A source is an R32F array with values
/// in [0, 1]; `cacheable` says whether its contents, and therefore the derived ones, are kept while nothing
/// changes.
class LIMN_API DerivedMaps {
 public:
  explicit DerivedMaps(const gpu::Device& device);
  ~DerivedMaps();
  DerivedMaps(const DerivedMaps&) = delete;
  DerivedMaps& operator=(const DerivedMaps&) = delete;

  /// Forgets what was built, before another graph is built.
  void clear();

  /// Returns the min-max pyramid of `depth`, with the levels that boxes of up to `boxSide` texels along their
  /// sides are looked up in, or with more of them. 0: with all.
  MinMaxPyramid minMaxPyramid(frame::FrameGraph& graph, frame::TextureHandle depth, bool cacheable,
                              int boxSide = 0);
  /// Returns an RG32F array with a mip chain: (least, greatest) depth of overlapping windows, which bound
  /// boxes more tightly than a pyramid for the same time and memory. Lookups are in
  /// glsl/shadow/min_max_windows.glsl.
  frame::TextureHandle minMaxWindows(frame::FrameGraph& graph, frame::TextureHandle depth, bool cacheable);
  /// Returns an RG32F array of one level: (least, greatest) depth of overlapping windows, which bound boxes
  /// more tightly than a pyramid for 2 log2(size) times a map's memory. Lookups are in
  /// glsl/shadow/n_buffer.glsl. Throws UsageError beyond 4 GiB and beyond the number of layers that the
  /// device allows in one array.
  frame::TextureHandle nBuffer(frame::FrameGraph& graph, frame::TextureHandle depth, bool cacheable);
  /// Returns the summed-area table of `depth`. Throws UsageError for a description out of range and for
  /// tables beyond 4 GiB.
  SummedAreaTable summedAreaTable(frame::FrameGraph& graph, frame::TextureHandle depth, bool cacheable,
                                  const SatDesc& desc);
  /// Returns the moment table of `depth`. `bits` of each moment: 10 to 20; 0: chosen by the maps' size
  /// (momentBits). Throws UsageError as summedAreaTable does.
  MomentTable momentTable(frame::FrameGraph& graph, frame::TextureHandle depth, bool cacheable, int bits);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace limn::shadow
