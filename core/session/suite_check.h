// Declares the check that everything a suite names exists, made before anything is measured.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/bench/suite.h"
#include "core/session/warn.h"
#include "core/technique/registry.h"

namespace limn::session {

/// Returns one line for each thing that the cases name and that does not exist: scenes, environments, grids,
/// animations, cameras, lights, techniques and their parameters. A scene that exists but is broken is
/// reported by the rows of its cases. `alive` is called before each scene, and `warn` receives the warnings
/// of the scenes.
LIMN_API std::vector<std::string> missingThings(const std::vector<bench::Case>& cases,
                                                const TechniqueRegistry& registry,
                                                const std::function<void()>& alive, const Warn& warn = {});

}  // namespace limn::session
