// The table of glsl/ltc.glsl, compiled in.
#include <array>

#include "core/shading/ltc_table.h"

namespace limn {
namespace {

constexpr glm::vec4 kTexels[] = {
#include "core/shading/ltc_table.inc"
};
static_assert(std::size(kTexels) == 2 * glsl::ltc_size * glsl::ltc_size);

}  // namespace

glm::vec4 glsl::ltc_texel(int layer, int x, int y) {
  return kTexels[2 * (y * ltc_size + x) + layer];
}

}  // namespace limn
