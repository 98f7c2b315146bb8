// Declares widgets for declared parameters: name, unit, range, tooltip and reset value all come from the
// declaration.
#pragma once

#include "core/base/parameters.h"

namespace limn::app {

/// Shows a row for each parameter and returns whether one was changed. `defaults` holds the values that reset
/// restores.
bool parameterWidgets(ParameterValues& values, const ParameterValues& defaults);

}  // namespace limn::app
