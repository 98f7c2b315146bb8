// Declares the frequency content of an error: noise is spread over all frequencies, while banding and bias
// are concentrated at the low ones.
#pragma once

#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/image/image.h"

namespace limn {

/// Rings of equal width between 0 and 0.5 cycles per pixel; the corners beyond belong to none.
inline constexpr int kSpectrumBins = 32;

/// Returns the radially averaged power spectrum of e = image - reference, kSpectrumBins values: ring b is the
/// mean of |E(f)|^2 / n over the frequencies with b <= 2 kSpectrumBins |f| < b + 1 cycles per pixel, where E
/// is the discrete Fourier transform of e (0 outside the n pixels whose mask is 1), averaged over R, G, B.
/// White noise of variance s gives s in every ring. Sides shorter than 2 kSpectrumBins pixels, and those with
/// large prime factors, are extended by zeros. A mask without pixels gives zeros. Throws Error if the sizes
/// differ.
LIMN_API std::vector<double> errorSpectrum(const Image& image, const Image& reference,
                                           std::span<const unsigned char> mask);

}  // namespace limn
