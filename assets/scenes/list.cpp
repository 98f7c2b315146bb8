#include "assets/scenes/scenes.h"

namespace limn::assets {

const std::vector<SceneEntry>& allScenes() {
  static const std::vector<SceneEntry> scenes = {
      {"atrium", makeAtrium},
      {"balls", makeBalls},
      {"cornell_box", makeCornellBox},
      {"foliage_card", makeFoliageCard},
      {"lights", makeLights},
      {"plant", makePlant},
      {"robot", makeRobot},
      {"soldiers", makeSoldiers},
      {"statue", makeStatue},
      {"teapot", makeTeapot},
      {"white_furnace", makeWhiteFurnace},
  };
  return scenes;
}

}  // namespace limn::assets
