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
      {"gem", makeGem},
      {"glass_sphere", makeGlassSphere},
      {"glass_statue", makeGlassStatue},
      {"lights", makeLights},
      {"metaballs", makeMetaballs},
      {"patrol", makePatrol},
      {"plant", makePlant},
      {"ring", makeRing},
      {"robot", makeRobot},
      {"soldiers", makeSoldiers},
      {"statue", makeStatue},
      {"teapot", makeTeapot},
      {"water", makeWater},
      {"white_furnace", makeWhiteFurnace},
  };
  return scenes;
}

const std::vector<EnvironmentEntry>& allEnvironments() {
  static const std::vector<EnvironmentEntry> environments = {{"sky", makeSky}};
  return environments;
}

}  // namespace limn::assets
