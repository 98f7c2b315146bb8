#include "core/brdf/factor_fit_spread.h"

#include <cstddef>

#include "core/brdf/private/fill_unknown.h"

namespace limn::brdf {

void spread(FactorTable& table, std::vector<char>& known, int axes) {
  const glm::ivec3 size(table.width, table.height, table.depth);
  fillUnknown(table.texels, known, [&](std::size_t texel) {
    GridNeighbours beside;
    std::size_t rest = texel, stride = 1;
    for (int axis = 0; axis < axes; ++axis) {
      const auto side = static_cast<std::size_t>(size[axis]);
      if (rest % side > 0) beside.add(texel - stride);
      if (rest % side + 1 < side) beside.add(texel + stride);
      rest /= side;
      stride *= side;
    }
    return beside;
  });
}

}  // namespace limn::brdf
