// Says how a question is asked on the command line.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/export.h"
#include "core/question/scene_question.h"

namespace limn {

/// Returns the question's flags, each followed by its value: those that are not the default. The scene, which
/// has no flag, is not among them.
LIMN_API std::vector<std::string> questionFlags(const SceneQuestion& question);

/// Returns the command that renders the question's picture by `techniques` (names joined by ",", or nothing),
/// as a line for a shell without --out. `settings` are pairs of "technique.parameter" and value. Flags are
/// left out where the question has the default.
LIMN_API std::string renderCommand(const SceneQuestion& question, const std::string& techniques,
                                   std::span<const std::pair<std::string, std::string>> settings);

/// Returns " OPTION VALUE" with the value quoted for a shell, or nothing where it is empty.
LIMN_API std::string commandOption(const char* option, const std::string& value);

}  // namespace limn
