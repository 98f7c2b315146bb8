// What a plug-in says of itself, looked over before core works with it.
#pragma once

#include <string>
#include <string_view>

#include "core/technique/technique.h"

namespace limn {

/// Why a plug-in whose handshake fits cannot be used as technique `name`, as a clause; empty if it can. Looks
/// at every pointer, text, range and default of what it declares.
LIMN_API std::string pluginProblem(const TechniquePlugin& plugin, std::string_view name);

}  // namespace limn
