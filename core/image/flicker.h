// Declares a measure of how much pictures change from one frame to the next where the surfaces do not move.
#pragma once

#include <vector>

#include "core/base/export.h"
#include "core/image/image.h"

namespace limn {

/// Returns, per pixel, whether it shows the same surface at the same place in both pictures: same id,
/// relative depth difference of at most 1e-3, normals within 1e-3. Throws Error if the sizes differ or the
/// channels Z, coverage, id or N are missing.
LIMN_API std::vector<bool> stillPixels(const Image& before, const Image& after);

/// Holds the change over a sequence of pictures, summed frame by frame.
struct LIMN_API Change {
  double sum = 0;    ///< of |after - before| in luminance
  double count = 0;  ///< of pixels

  /// Adds the change over the pixels marked in `still`. Throws Error if a size differs or a change is no
  /// finite number.
  void add(const Image& before, const Image& after, const std::vector<bool>& still);
  double mean() const { return count > 0 ? sum / count : 0; }
};

/// Returns the mean absolute change without the part that is noise, by subtracting squares. `noise` is the
/// mean absolute change of pure noise of that strength; where it is larger than `change`, the result is 0.
LIMN_API double withoutNoise(double change, double noise);

}  // namespace limn
