// A window that shows a scene with the settings of a chapter.
#pragma once

#include "apps/chapters/support/chapter.h"
#include "apps/limn/options.h"

namespace limn::app {

/// Runs until the window is closed. The camera turns around the middle of the scene with the mouse's left
/// button and the arrow keys and approaches with the wheel; number keys and space choose the setting; P
/// pauses the animation. `frames` > 0 ends after so many. Throws Error if no window can be opened.
void showWindow(const Chapter& chapter, const SceneOptions& scene, int frames);

}  // namespace limn::app
