// The scenes, one function each.
#pragma once

#include <string_view>
#include <vector>

#include "assets/generator/scene.h"

namespace limn::assets {

Scene makeAtrium();
Scene makeBalls();
Scene makeCornellBox();
Scene makeFoliageCard();
Scene makeLights();
Scene makePlant();
Scene makeRobot();
Scene makeSoldiers();
Scene makeStatue();
Scene makeTeapot();
Scene makeWhiteFurnace();

struct SceneEntry {
  std::string_view name;
  Scene (*make)();
};

/// Every scene of the library.
const std::vector<SceneEntry>& allScenes();

}  // namespace limn::assets
