#include "core/shadow/moment_table.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/shadow/private/summed_area_passes.h"
#include "glsl/shadow/moment_shadow.glsl"

namespace limn::shadow {

int momentBits(int mapSize) {
  int bits = 20;
  while (bits > 14 && 8 * glsl::moment_largest_side(bits) < mapSize) --bits;
  return bits;
}

MomentTable addMomentTable(frame::FrameGraph& graph, frame::TextureHandle source, bool cacheable, int bits,
                           bool shared) {
  if (bits < 10 || bits > 20)
    throw UsageError(fmt::format("moments of {} bits: accepted are 10 to 20", bits));
  return {addSummedAreaPasses(graph, source, GL_RGBA32UI,
                              {.name = "moment table",
                               .defines = {{"CONTENTS", "1"}, {"MOMENT_BITS", fmt::format("{}", bits)}},
                               .shared = shared,
                               .cacheable = cacheable}),
          bits};
}

}  // namespace limn::shadow
