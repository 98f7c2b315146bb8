// Remembers, from one window to the next, which files of scenes were opened.
#pragma once

#include <filesystem>
#include <vector>

namespace limn::app {

/// Returns the files that were opened last and still exist, the last one first: at most ten. They are kept in
/// limn/scenes in the user's folder for such things (XDG_STATE_HOME, else ~/.local/state).
std::vector<std::filesystem::path> recentScenes();

/// Puts a scene's file first among them. Names of limn's own scenes, which every window offers, are left
/// alone, and so is everything where nothing can be written: windows work without it.
void noteRecentScene(const std::filesystem::path& scene);

}  // namespace limn::app
