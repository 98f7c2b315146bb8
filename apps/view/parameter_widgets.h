// Widgets of declared parameters: name, unit, range, tooltip and reset all come from the declaration.
#pragma once

#include "core/technique/parameters.h"

namespace limn::app {

/// A row for each parameter. True if one was changed. `defaults`: values that reset gives back.
bool parameterWidgets(ParameterValues& values, const ParameterValues& defaults);

}  // namespace limn::app
