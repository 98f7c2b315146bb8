// What a suite names, looked for before anything is measured.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/bench/suite.h"
#include "core/technique/registry.h"

namespace limn::app {

/// One line for each thing that the cases name and that is not there: scenes, environments, grids,
/// animations, cameras, lights, techniques and their parameters. Prints the scenes' warnings to stderr. A
/// scene that is there but broken is left to the rows of its cases. `alive` is called before each scene.
std::vector<std::string> missingThings(const std::vector<bench::Case>& cases,
                                       const TechniqueRegistry& registry, const std::function<void()>& alive);

}  // namespace limn::app
