// Declares the error metrics that say how far a picture is from its reference (design, "Comparability").
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/export.h"
#include "core/image/image.h"

namespace limn {

/// Holds the metrics over the unmasked pixels; x is the image, r the reference, both in linear values.
struct Metrics {
  double rmse = 0;     ///< root mean square error over R, G, B
  double rel_mse = 0;  ///< mean((x - r)^2 / (r^2 + 1e-2 mean(r)^2)), per channel; mean(r) over all channels
  double bias = 0;     ///< mean of x - r over R, G, B (signed)
  double p999 = 0;     ///< 99.9th percentile of |x - r| in luminance (Rec. 709)
  double psnr = 0;     ///< 20 log10(peak / rmse), peak = 99.9th percentile of r; +inf for equal images
  double flip = 0;     ///< mean LDR-FLIP of the tone-mapped pictures, in [0, 1]
  double structured = 0;  ///< RMS of the error after a 9 x 9 Gaussian (sigma 2 pixels, renormalised at masks)
  std::size_t pixels = 0;  ///< pixels compared
  /// Share, among the pixels covered in either picture, of those that differ in coverage, id or depth.
  double masked_share = 0;
  /// Three times the reference's own noise over the compared pixels, in image units: a smaller rmse is no
  /// difference. Known where the reference has a channel "variance" (that of its R, G and B, averaged over
  /// the three), or metadata "noise_rms" (RMS relative to the mean), which is then taken for that of every
  /// part of the picture.
  std::optional<double> noise_floor;
};

struct CompareOptions {
  float exposureEv = 0;           ///< exposure of the tone mapping for FLIP
  double maxMaskedShare = 0.005;  ///< more is an Error (foliage: 0.02)
  double depthTolerance = 1e-3;   ///< relative difference in Z beyond which a pixel is dropped
  bool useMask = true;            ///< drop pixels by the channels coverage, masked, id and Z
  bool background = false;        ///< keep pixels in which neither picture sees a surface
  /// Only pixels whose reference, R, lies in the open interval (penumbra pixels of a visibility term).
  std::optional<std::pair<float, float>> maskTermRange;
};

struct Comparison {
  Metrics metrics;
  int width = 0, height = 0;        ///< pixels
  std::vector<float> flipMap;       ///< per pixel, 0 where masked
  std::vector<unsigned char> mask;  ///< 1 where compared
};

/// Compares the unmasked pixels of two pictures; compareImages() returns the metrics alone. Where only one
/// picture has a coverage channel, that one decides which pixels are dropped; pixels whose channel "masked"
/// is 1 in either picture (where a term is undefined) are dropped without being counted. A ratio whose
/// denominator is 0 (rel_mse of a black reference) is infinite; the psnr of a black reference is -infinity
/// unless the images are equal. Throws Error if the sizes differ, a value of R, G, B is NaN or infinite
/// (masked or not), a compared value of the reference's channel variance is no number >= 0, no pixel is left,
/// or the masked share exceeds its limit.
LIMN_API Comparison compareImagesDetailed(const Image& image, const Image& reference,
                                          const CompareOptions& options = {});
LIMN_API Metrics compareImages(const Image& image, const Image& reference,
                               const CompareOptions& options = {});

/// Returns the metrics over those compared pixels of `whole` whose reference, R, lies in the open interval
/// `range`: what compareImages() gives with that maskTermRange, without computing masks and FLIP again.
/// `whole` is what compareImagesDetailed() gave for the same pictures. Returns nullopt where no pixel is
/// left. Throws Error for pictures of another size, and where compareImages() does.
LIMN_API std::optional<Metrics> metricsWithin(const Image& image, const Image& reference,
                                              const Comparison& whole, std::pair<float, float> range);

/// Returns the comparison's FLIP map in false colour (black = equal, light yellow = 1; grey = masked), as
/// linear R, G, B for writePng().
LIMN_API Image differenceImage(const Comparison& comparison);

}  // namespace limn
