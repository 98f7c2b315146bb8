// Declares how files that were built or installed with limn are found by name.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/export.h"

namespace limn::session {

/// Returns the file itself, or the scene of that name that was built with limn. Throws Error when there is
/// neither.
LIMN_API std::filesystem::path findScene(const std::filesystem::path& nameOrFile);

/// Returns the file itself, or the environment map of that name that was built with limn. Throws Error when
/// there is neither.
LIMN_API std::filesystem::path findEnvironment(const std::filesystem::path& nameOrFile);

/// Returns the environment map that lights scenes beside the default lights. Throws Error when it was not
/// built or installed with limn.
LIMN_API std::filesystem::path findDefaultEnvironment();

/// Returns the file itself, or the suite of that name that came with limn. Throws Error when there is
/// neither.
LIMN_API std::filesystem::path findSuite(const std::filesystem::path& nameOrFile);

/// Returns the names of the scenes, environment maps and suites that were built or installed with limn,
/// sorted.
LIMN_API std::vector<std::string> sceneNames();
LIMN_API std::vector<std::string> environmentNames();
LIMN_API std::vector<std::string> suiteNames();

/// Returns what limn's own scenes, and its environment maps, are for, by name. Empty where limn's scenes were
/// neither built nor installed.
LIMN_API std::map<std::string, std::string> aboutScenes();
LIMN_API std::map<std::string, std::string> aboutEnvironments();

/// Returns the path of `file` in `folder` of what was built or installed with limn; empty when it does not
/// exist.
LIMN_API std::filesystem::path findShared(const std::filesystem::path& folder,
                                          const std::filesystem::path& file);

}  // namespace limn::session
