// The scenes, one function each.
#pragma once

#include <string_view>
#include <vector>

#include "assets/generator/scene.h"

namespace limn::assets {

Scene makeArcadeDark();
Scene makeAtrium();
Scene makeAtriumRobots();
Scene makeBalls();
Scene makeBallsSky();
Scene makeBumpSphere();
Scene makeBumpWall();
Scene makeChess();
Scene makeClosedBox();
Scene makeColonnade();
Scene makeCornellBox();
Scene makeCornellHorse();
Scene makeDiskAndSphere();
Scene makeEggCrate();
Scene makeFlyingDragon();
Scene makeFoliageCard();
Scene makeFresnelSpheres();
Scene makeFrog();
Scene makeGem();
Scene makeGem2Lights();
Scene makeGem4Lights();
Scene makeGlassSphere();
Scene makeGlassStatue();
Scene makeGlassware();
Scene makeGlossyFurnace();
Scene makeGlossyGlobe();
Scene makeGlossyRoom();
Scene makeGlossySphere();
Scene makeGlossyTorus();
Scene makeGroove();
Scene makeLights();
Scene makeMarbleStatue();
Scene makeMeasuredSpheres();
Scene makeMetaballs();
Scene makeMilk();
Scene makeMonster();
Scene makeNineSpheres();
Scene makeNineSpheresBump();
Scene makeNineSpheresGlossy();
Scene makeNineSpheresMetal();
Scene makePatrol();
Scene makePlant();
Scene makeRing();
Scene makeRobot();
Scene makeRobotBrdfs();
Scene makeSmoke();
Scene makeSodaCorner();
Scene makeSoldiers();
Scene makeStainedLight();
Scene makeStatue();
Scene makeTeapot();
Scene makeTeapotCoarse();
Scene makeTeapotGroove();
Scene makeTeapotPattern();
Scene makeThreeLights();
Scene makeTorusMetal();
Scene makeTranslucentChecker();
Scene makeTranslucentEar();
Scene makeTranslucentEdge();
Scene makeTranslucentHead();
Scene makeTranslucentSpheres();
Scene makeWater();
Scene makeWhiteFurnace();

struct SceneEntry {
  std::string_view name;
  Scene (*make)();
  std::string_view about;  ///< what it is for, as in assets/README.md
};

/// Every scene of the library.
const std::vector<SceneEntry>& allScenes();

/// 512 x 256 pixels: a low sun, a glowing horizon, two windows.
Image makeSky();
/// 256 x 128 pixels: a grey room with a soft box above left and a strip light on the right, seen from where
/// a camera looks along -z.
Image makeStudio();

struct EnvironmentEntry {
  std::string_view name;
  Image (*make)();
  std::string_view about;  ///< what it shows
};

/// Every environment map of the library.
const std::vector<EnvironmentEntry>& allEnvironments();

}  // namespace limn::assets
