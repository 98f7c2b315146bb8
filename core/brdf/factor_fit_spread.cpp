#include "core/brdf/factor_fit_spread.h"

#include <cstddef>

namespace limn::brdf {

using glm::ivec3;
using glm::vec3;

void spread(FactorTable& table, std::vector<char>& known, int axes) {
  const ivec3 size(table.width, table.height, table.depth);
  const auto index = [&](const ivec3& p) {
    return static_cast<std::size_t>((p.z * size.y + p.y) * size.x + p.x);
  };
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<char> next = known;
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const ivec3 p(x, y, z);
          if (known[index(p)]) continue;
          vec3 sum(0);
          int count = 0;
          for (int axis = 0; axis < axes; ++axis)
            for (int step : {-1, 1}) {
              ivec3 q = p;
              q[axis] += step;
              if (q[axis] < 0 || q[axis] >= size[axis] || !known[index(q)]) continue;
              sum += table.texels[index(q)];
              ++count;
            }
          if (count == 0) continue;
          table.texels[index(p)] = sum / static_cast<float>(count);
          next[index(p)] = 1;
          changed = true;
        }
    known = std::move(next);
  }
}

}  // namespace limn::brdf
