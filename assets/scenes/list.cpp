#include "assets/scenes/scenes.h"

namespace limn::assets {

const std::vector<SceneEntry>& allScenes() {
  static const std::vector<SceneEntry> scenes = {
      {"atrium", makeAtrium},
      {"atrium_robots", makeAtriumRobots},
      {"balls", makeBalls},
      {"balls_sky", makeBallsSky},
      {"cornell_box", makeCornellBox},
      {"cornell_horse", makeCornellHorse},
      {"foliage_card", makeFoliageCard},
      {"lights", makeLights},
      {"metaballs", makeMetaballs},
      {"patrol", makePatrol},
      {"plant", makePlant},
      {"robot", makeRobot},
      {"soldiers", makeSoldiers},
      {"statue", makeStatue},
      {"teapot", makeTeapot},
      {"white_furnace", makeWhiteFurnace},
  };
  return scenes;
}

const std::vector<EnvironmentEntry>& allEnvironments() {
  static const std::vector<EnvironmentEntry> environments = {{"sky", makeSky}};
  return environments;
}

}  // namespace limn::assets
