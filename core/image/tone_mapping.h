// Declares how linear pictures become what a display shows: exposure, a tone curve, sRGB.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "core/base/export.h"
#include "core/image/image.h"

namespace limn {

/// Names the tone curves of glsl/numeric/tone_curve.glsl, by their numbers there.
enum class ToneCurve : std::uint8_t {
  none,     ///< clamped, the only one whose values can be compared
  neutral,  ///< Khronos PBR Neutral
  agx       ///< AgX
};
/// Holds the names of all of them, in their order.
inline constexpr std::array<const char*, 3> kToneCurves = {"none", "neutral", "agx"};
/// Returns the curve of that name. Throws UsageError for another one, with all names.
LIMN_API ToneCurve parseToneCurve(const std::string& name);

struct ToneMapping {
  float exposureEv = 0;  ///< light is multiplied by 2^exposureEv first
  ToneCurve curve = ToneCurve::none;
  bool operator==(const ToneMapping&) const = default;
};

/// Returns R, G, B (see Image::rgbChannels) as a display shows them: sRGB, 8 bits, opaque, NaN as 0.
LIMN_API Image8 toneMapped(const Image& image, const ToneMapping& tone);

/// Does what writeImage() does; a .png holds toneMapped().
LIMN_API void writePicture(const std::filesystem::path& path, const Image& image, const ToneMapping& tone);

/// Returns the exposure, EV, at which the geometric mean of the picture's luminance is middle grey, 0.18
/// (Reinhard et al. 2002). Pixels without light do not count, nor do the darkest and the brightest 5 % of the
/// others, so that neither a black background nor a lamp that is seen decides. 0 for a picture without light;
/// at most 60 either way.
LIMN_API float automaticExposure(const Image& image);

}  // namespace limn
