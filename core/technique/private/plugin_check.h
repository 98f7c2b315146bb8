// Declares the check of what a plug-in declares, before core uses it.
#pragma once

#include <string>
#include <string_view>

#include "core/technique/technique.h"

namespace limn {

/// Returns, as a clause, why a plug-in whose handshake matches cannot be used as technique `name`; empty when
/// it can. Checks every pointer, text, range and default that it declares.
LIMN_API std::string pluginProblem(const TechniquePlugin& plugin, std::string_view name);

}  // namespace limn
