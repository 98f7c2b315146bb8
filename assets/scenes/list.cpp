#include "assets/scenes/scenes.h"

namespace limn::assets {

const std::vector<SceneEntry>& allScenes() {
  static const std::vector<SceneEntry> scenes = {
      {"arcade_dark", makeArcadeDark,
       "a vaulted arcade lit through its arches: in the mean a white surface gets a third of the light it "
       "would get in the open (0.34 in main, 0.42 in close), seven places of ten less than half"},
      {"atrium", makeAtrium,
       "courtyard of two storeys: fluted columns, arches, balustrades, banners; shared meshes, normal map"},
      {"atrium_robots", makeAtriumRobots,
       "five of the robots dancing in a plainer atrium at night, lit by a spot light that goes round: most "
       "light is indirect"},
      {"balls", makeBalls, "spheres of many sizes: every penumbra width in one picture"},
      {"balls_sky", makeBallsSky, "balls without the key light, under sky"},
      {"bump_sphere", makeBumpSphere,
       "a ball whose height map is noise: bumps around a curved surface, whose poles are out of sight"},
      {"bump_wall", makeBumpWall,
       "a wall whose bricks are a height map, a small lamp grazing along it and back in 4 s"},
      {"chess", makeChess, "turned pieces on a chequered board: colour from one thing to another"},
      {"closed_box", makeClosedBox,
       "nine_spheres_glossy in a room without windows: light of an environment would be light that leaks"},
      {"colonnade", makeColonnade,
       "a closed room, its aisle lit by one bounce off the hall's wall past five pillars from 40 to 6 cm: "
       "without visibility, indirect light is twice too bright there"},
      {"cornell_box", makeCornellBox, "Lambertian box with colour bleeding"},
      {"cornell_horse", makeCornellHorse,
       "a horse turning in the Cornell box, the beam of a spot light swaying over its walls: nearly all "
       "light is indirect"},
      {"disk_and_sphere", makeDiskAndSphere,
       "discs and spheres of aluminium: plain, brushed along circles and along radii (ward); a ball of silk "
       "(banks)"},
      {"egg_crate", makeEggCrate, "a plane whose height map is a product of sines, slopes of 0.47 (RMS)"},
      {"flying_dragon", makeFlyingDragon,
       "a dragon, skinned (3 joints), 2.7k vertices; wings beat in a loop of 2 s"},
      {"foliage_card", makeFoliageCard, "alpha-masked, double-sided leaf cards"},
      {"fresnel_spheres", makeFresnelSpheres,
       "spheres of index 1.5, 5 and 200 by three models: torrance_sparrow, phong, coated"},
      {"frog", makeFrog, "one implicit surface of 3.4k vertices on a patterned floor, all Lambertian"},
      {"gem", makeGem, "a cut stone of index 1.7 turning in thin fog: reflection and refraction by facets"},
      {"gem_2_lights", makeGem2Lights, "gem under two spots: what each further light costs"},
      {"gem_4_lights", makeGem4Lights, "gem under four spots: what each further light costs"},
      {"glass_sphere", makeGlassSphere, "a glass ball in thin fog under a spot: the caustic behind a lens"},
      {"glass_statue", makeGlassStatue, "the statue of glass turning in thin fog"},
      {"glassware", makeGlassware,
       "a glass ball, a silver ring and a cut stone before tiles: what is seen in mirrors and through glass"},
      {"glossy_furnace", makeGlossyFurnace,
       "the inside of a sphere lit from its centre, grey but for a satin cap: after one bounce every place "
       "sees the same radiance all round"},
      {"glossy_globe", makeGlossyGlobe, "a patterned globe over a satin floor, before a wall"},
      {"glossy_room", makeGlossyRoom, "a closed room, its floor of satin metal, a box floating over it"},
      {"glossy_sphere", makeGlossySphere, "satin metal over a patterned floor"},
      {"glossy_torus", makeGlossyTorus, "a lacquered torus and sphere: phong, exponent 100"},
      {"groove", makeGroove,
       "a plane whose height map is endless V-shaped grooves with a right angle between their walls: shadows "
       "in closed form"},
      {"lights", makeLights, "one light of every type"},
      {"marble_statue", makeMarbleStatue,
       "the statue 25 cm high, of marble, under a spot that shines through a window of coloured glass: light "
       "blurs below the surface, and through the veil"},
      {"measured_spheres", makeMeasuredSpheres,
       "spheres of V-shaped grooves of 20, 45 and 65 degrees in two colours, simulated and kept as measured "
       "data (measured)"},
      {"metaballs", makeMetaballs,
       "nine balls melting into each other in the Cornell box: geometry whose topology changes all the time"},
      {"milk", makeMilk, "a bowl of whole milk, the shadows of its rim and of two berries on it"},
      {"monster", makeMonster, "like frog, with concave parts: mouth, arms, tail"},
      {"nine_spheres", makeNineSpheres,
       "nine spheres on a checkered floor, all Lambertian, that get three quarters of the light they would "
       "get in the open (0.74 in main, 0.77 in close)"},
      {"nine_spheres_bump", makeNineSpheresBump,
       "nine_spheres with normal maps of noise, slopes of 0.26 (RMS)"},
      {"nine_spheres_glossy", makeNineSpheresGlossy,
       "nine_spheres under a lacquer of index 1.8 and alpha 0.15"},
      {"nine_spheres_metal", makeNineSpheresMetal, "nine_spheres of metals, alpha 0.1 to 0.25"},
      {"patrol", makePatrol, "ten soldiers under sky: bound by geometry where each of many lights has a map"},
      {"plant", makePlant, "potted fig of real leaves: depth complexity"},
      {"ring", makeRing, "a golden ring turning in thin fog: the caustics of one reflection"},
      {"robot", makeRobot,
       "a robot, skinned (23 joints, weights blended), a dance of 4 s that loops; normal-mapped floor"},
      {"robot_brdfs", makeRobotBrdfs,
       "four robots with shells of phong with a wide lobe and a narrow one, metallic paint and copper "
       "(torrance_sparrow); they dance on a turntable that goes round in 12 s, so that one after the other "
       "comes to the front"},
      {"smoke", makeSmoke, "a glass ball in rising procedural smoke under a spot"},
      {"soda_corner", makeSodaCorner,
       "a corner of a soda shop, a third of its surfaces glossy: steel, lacquer, tiles"},
      {"soldiers", makeSoldiers, "a soldier in 100 instances (EXT_mesh_gpu_instancing)"},
      {"stained_light", makeStainedLight,
       "a glass ball in thin fog under a spot that shines through a window of coloured glass"},
      {"statue", makeStatue, "one closed surface with folds, openings and thin parts"},
      {"teapot", makeTeapot, "the Utah teapot, Newell's 32 patches"},
      {"teapot_coarse", makeTeapotCoarse,
       "teapot_pattern with 800 vertices: too few for methods that light vertices"},
      {"teapot_groove", makeTeapotGroove,
       "the teapot of V-shaped grooves (measured), blue from one side and red from the other"},
      {"teapot_pattern", makeTeapotPattern,
       "the teapot with 3,872 vertices on a patterned floor, all Lambertian"},
      {"three_lights", makeThreeLights,
       "a satin plate that throws the light of three coloured lamps onto a wall"},
      {"torus_metal", makeTorusMetal,
       "two tori of 200 x 200 quads, of copper (m = 0.1) and of aluminium (m = 0.05): torrance_sparrow"},
      {"translucent_checker", makeTranslucentChecker,
       "a board of marble in two colours, one mean free path, under the shadows of pawns"},
      {"translucent_ear", makeTranslucentEar,
       "a bent shell of skin on a table, 2 mm thick at its upper end and 10 mm at the lower one, the lamp "
       "behind it; lit looks at the side of the lamp"},
      {"translucent_edge", makeTranslucentEdge,
       "a block of skin with the sharp edge of a shadow across it, in view alone; a pixel of 192 rows is a "
       "third of the mean distance that light of any colour goes"},
      {"translucent_head", makeTranslucentHead, "a bust of skin whose wrinkles are a height map"},
      {"translucent_spheres", makeTranslucentSpheres,
       "five spheres with radii of 1, 3, 10, 30 and 100 times the mean distance that light goes below their "
       "surfaces"},
      {"water", makeWater, "waves over a pool's floor, seen from below: shafts of light in the water"},
      {"white_furnace", makeWhiteFurnace,
       "Lambert sphere of albedo 1 in a constant environment of radiance 1: the picture is 1 everywhere"},
  };
  return scenes;
}

const std::vector<EnvironmentEntry>& allEnvironments() {
  static const std::vector<EnvironmentEntry> environments = {
      {"sky", makeSky, "a low sun behind haze, a glowing horizon, clouds and two windows"},
      {"studio", makeStudio, "a grey room with a soft box and a strip light, for scenes without lights"}};
  return environments;
}

}  // namespace limn::assets
