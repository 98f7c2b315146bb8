// How much pictures change from one frame to the next where the surfaces stand still.
#pragma once

#include <vector>

#include "core/base/export.h"
#include "core/image/image.h"

namespace limn {

/// Pixels that show the same surface at the same place in both pictures: same id, depth within 1e-3 of
/// itself, normals within 1e-3. Throws Error if the sizes differ or the channels Z, coverage, id or N are
/// missing.
LIMN_API std::vector<bool> stillPixels(const Image& before, const Image& after);

/// What a sequence of pictures changed, added up frame by frame.
struct LIMN_API Change {
  double sum = 0;    ///< of |after - before| in luminance
  double count = 0;  ///< of pixels

  /// Over the pixels marked in `still`. Throws Error if a size differs.
  void add(const Image& before, const Image& after, const std::vector<bool>& still);
  double mean() const { return count > 0 ? sum / count : 0; }
};

/// Mean absolute change without the part that is noise: squares subtract. `noise` is the mean absolute change
/// of pure noise of that strength; 0 where it hides everything.
LIMN_API double withoutNoise(double change, double noise);

}  // namespace limn
