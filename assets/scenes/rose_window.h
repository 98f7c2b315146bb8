// What spot lights shine through.
#pragma once

#include "assets/generator/image.h"

namespace limn::assets {

/// A round window of coloured glass in lead.
Image roseWindow();

}  // namespace limn::assets
