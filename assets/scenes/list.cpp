#include "assets/scenes/scenes.h"

namespace limn::assets {

const std::vector<SceneEntry>& allScenes() {
  static const std::vector<SceneEntry> scenes = {
      {"arcade_dark", makeArcadeDark},
      {"atrium", makeAtrium},
      {"atrium_robots", makeAtriumRobots},
      {"balls", makeBalls},
      {"balls_sky", makeBallsSky},
      {"bump_sphere", makeBumpSphere},
      {"bump_wall", makeBumpWall},
      {"chess", makeChess},
      {"closed_box", makeClosedBox},
      {"colonnade", makeColonnade},
      {"cornell_box", makeCornellBox},
      {"cornell_horse", makeCornellHorse},
      {"disk_and_sphere", makeDiskAndSphere},
      {"egg_crate", makeEggCrate},
      {"flying_dragon", makeFlyingDragon},
      {"foliage_card", makeFoliageCard},
      {"fresnel_spheres", makeFresnelSpheres},
      {"frog", makeFrog},
      {"gem", makeGem},
      {"gem_2_lights", makeGem2Lights},
      {"gem_4_lights", makeGem4Lights},
      {"glass_sphere", makeGlassSphere},
      {"glass_statue", makeGlassStatue},
      {"glassware", makeGlassware},
      {"glossy_furnace", makeGlossyFurnace},
      {"glossy_globe", makeGlossyGlobe},
      {"glossy_room", makeGlossyRoom},
      {"glossy_sphere", makeGlossySphere},
      {"glossy_torus", makeGlossyTorus},
      {"groove", makeGroove},
      {"lights", makeLights},
      {"marble_statue", makeMarbleStatue},
      {"measured_spheres", makeMeasuredSpheres},
      {"metaballs", makeMetaballs},
      {"milk", makeMilk},
      {"monster", makeMonster},
      {"nine_spheres", makeNineSpheres},
      {"nine_spheres_bump", makeNineSpheresBump},
      {"nine_spheres_glossy", makeNineSpheresGlossy},
      {"nine_spheres_metal", makeNineSpheresMetal},
      {"patrol", makePatrol},
      {"plant", makePlant},
      {"ring", makeRing},
      {"robot", makeRobot},
      {"robot_brdfs", makeRobotBrdfs},
      {"smoke", makeSmoke},
      {"soda_corner", makeSodaCorner},
      {"soldiers", makeSoldiers},
      {"stained_light", makeStainedLight},
      {"statue", makeStatue},
      {"teapot", makeTeapot},
      {"teapot_coarse", makeTeapotCoarse},
      {"teapot_groove", makeTeapotGroove},
      {"teapot_pattern", makeTeapotPattern},
      {"three_lights", makeThreeLights},
      {"torus_metal", makeTorusMetal},
      {"translucent_checker", makeTranslucentChecker},
      {"translucent_ear", makeTranslucentEar},
      {"translucent_edge", makeTranslucentEdge},
      {"translucent_head", makeTranslucentHead},
      {"translucent_spheres", makeTranslucentSpheres},
      {"water", makeWater},
      {"white_furnace", makeWhiteFurnace},
  };
  return scenes;
}

const std::vector<EnvironmentEntry>& allEnvironments() {
  static const std::vector<EnvironmentEntry> environments = {{"sky", makeSky}, {"studio", makeStudio}};
  return environments;
}

}  // namespace limn::assets
