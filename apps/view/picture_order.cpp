#include "apps/view/picture_order.h"

#include <algorithm>

namespace limn::app {

bool same(const std::vector<render::TechniqueUse>& a, const std::vector<render::TechniqueUse>& b) {
  return std::ranges::equal(a, b, [](const render::TechniqueUse& x, const render::TechniqueUse& y) {
    return x.plugin == y.plugin && termsOf(x) == termsOf(y) &&
           x.parameters.printed() == y.parameters.printed();
  });
}

bool same(const PictureOrder& a, const PictureOrder& b) {
  return a.of == b.of && a.scene == b.scene && a.tone == b.tone &&
         a.automaticExposure == b.automaticExposure && a.size == b.size && a.beside == b.beside &&
         a.moving == b.moving && a.timed == b.timed && a.inspect == b.inspect &&
         same(a.techniques, b.techniques) && same(a.others, b.others);
}

}  // namespace limn::app
