// A scene as the generator describes it: plain data, indices into the scene's own arrays (-1: none).
// The conventions beyond glTF 2.0 (extras.limn_area, limn_angle, limn_environment, limn_height,
// limn_material, limn_subsurface) are described in assets/README.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "assets/generator/image.h"
#include "assets/generator/mesh.h"
#include "core/brdf/tabulated.h"

namespace limn::assets {

/// extras.limn_material: a reflection model in place of glTF's own. What is not set is not written, and has
/// the default that assets/README.md says.
struct ReflectionModel {
  std::string model;                      ///< torrance_sparrow, ward, banks, phong, coated or measured
  std::optional<glm::vec2> roughness{};   ///< along and across the tangent
  std::optional<glm::vec3> eta{}, k{};    ///< index of refraction and of absorption
  std::optional<glm::vec3> kd{}, ks{};    ///< albedos
  std::optional<float> exponent{};        ///< of phong and banks
  std::string distribution{}, masking{};  ///< beckmann or gaussian; correlated or product
  std::string banks{}, combine{};         ///< stalling or printed; sum, blend or physical
  std::string file{};                     ///< of measured, in the scene's folder
};

/// extras.limn_height: bumps of a texture that addHeights() made.
struct HeightMap {
  int texture = -1;
  float scale = 1, offset = 0;  ///< metres: height = scale * value + offset
  glm::vec2 tile{1};            ///< metres per unit of u and v
};

/// extras.limn_subsurface: how light scatters below a surface. The mean free path, where it is set, stands in
/// place of the coefficients, and the base colour is the albedo then.
struct Subsurface {
  glm::vec3 sigmaA{0}, sigmaSPrime{0};      ///< absorption and reduced scattering, per metre
  std::optional<glm::vec3> meanFreePath{};  ///< reduced, metres
};

struct Material {
  std::string name;
  glm::vec4 baseColour{0.8f, 0.8f, 0.8f, 1};  ///< linear
  float roughness = 0.8f;
  float metallic = 0;
  float specularFactor = 1;  ///< KHR_materials_specular; 0 with roughness 1 is a pure Lambert surface
  glm::vec3 emissive{0};     ///< colour, at most 1 a channel
  float emissiveStrength = 1;
  int baseColourTexture = -1;
  int normalTexture = -1;
  float normalScale = 1;
  bool doubleSided = false;
  std::optional<float> alphaCutoff{};  ///< set: alpha mode MASK
  float transmission = 0;
  float ior = 1.5f;
  float thickness = 0;  ///< metres; > 0: bounds a body
  std::optional<ReflectionModel> model{};
  std::optional<HeightMap> height{};
  std::optional<Subsurface> subsurface{};
};

struct Texture {
  std::string name;  ///< written as NAME.png beside the scene
  Image image;
  bool linear = false;   ///< normal maps: no sRGB encoding
  bool heights = false;  ///< red alone, with 16 bits
};

struct Primitive {
  Mesh mesh;
  int material = -1;
};

struct MeshAsset {
  std::string name;
  std::vector<Primitive> primitives;
};

struct Camera {
  float yfov = 0.8f;  ///< vertical, radians
  float near = 0.05f;
};

struct Light {
  enum class Type { point, spot, directional };
  Type type = Type::point;
  glm::vec3 colour{1};
  float intensity = 1;                                   ///< W/sr, directional: W/m^2
  float innerConeAngle = 0, outerConeAngle = 0.785398f;  ///< half angles of a spot, radians
  int texture = -1;                                      ///< extras.limn_texture: that a spot shines through
};

struct Instance {
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 scale{1};
};

/// extras.limn_metaballs: balls that melt into each other, in the cube [-1, 1]^3 of their node.
struct Metaballs {
  int count = 8, resolution = 32;
  float radius = 0.2f;
  std::uint32_t seed = 0;
  int material = -1;
};

struct Node {
  std::string name;
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  int mesh = -1, camera = -1, light = -1, skin = -1;
  std::vector<int> children{};
  std::vector<Instance> instances{};  ///< EXT_mesh_gpu_instancing where not empty
  std::optional<glm::vec2> area{};    ///< extras.limn_area, metres
  std::optional<float> angle{};       ///< extras.limn_angle, radians
  std::optional<Metaballs> metaballs{};
  glm::vec3 scale{1};
};

struct Skin {
  std::vector<int> joints;  ///< nodes
  std::vector<glm::mat4> inverseBind;
};

struct Channel {
  int node = -1;
  std::vector<float> times = {};             ///< seconds, rising
  std::vector<glm::quat> rotations = {};     ///< one per time, or
  std::vector<glm::vec3> translations = {};  ///< one per time
};

struct Animation {
  std::string name;
  std::vector<Channel> channels;
};

/// Procedural smoke in a box; see scene::Smoke.
struct Smoke {
  glm::vec3 low{0}, high{0};
  float whirl = 1, rise = 0;
  std::uint32_t seed = 0;
  int resolution = 64;
};

/// Coefficients per metre; of smoke those at density 1.
struct Medium {
  float sigmaA = 0, sigmaS = 0, g = 0;
  std::optional<Smoke> smoke{};
};

struct Scene {
  std::string name;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<MeshAsset> meshes;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<Node> nodes;
  std::vector<Skin> skins;
  std::vector<Animation> animations;
  std::optional<Image> environment;  ///< linear RGB, written as environment.exr
  std::optional<Medium> medium;      ///< extras.limn_medium
  struct Measured {
    std::string file;
    brdf::AnisotropicTable table;
  };
  std::vector<Measured> measured;  ///< files of measured reflectance, which materials name

  int addTexture(std::string textureName, Image image, bool linear = false);
  /// A texture of heights from 0 to 1 in red.
  int addHeights(std::string textureName, Image image);
  int addMaterial(Material material);
  /// A material that reflects as the table has it, which is written as NAME.bsdf. Viewers that do not know
  /// limn_material show a Lambertian surface of that albedo.
  int addMeasured(const std::string& materialName, brdf::AnisotropicTable table, glm::vec3 albedo);
  int addMesh(std::string meshName, std::vector<Primitive> primitives);
  int addNode(Node node);
  /// A mesh of one primitive and the node that shows it.
  int add(std::string nodeName, Mesh mesh, int material);
  void addCamera(std::string cameraName, glm::vec3 eye, glm::vec3 target, float yfovDegrees);
  void addLight(std::string lightName, const Light& light, glm::vec3 position, glm::vec3 target);
  /// The light "key", parallel, from `elevation` degrees above the ground, out of the direction (x, z).
  void addSun(float elevation, glm::vec2 from, float intensity, glm::vec3 colour = glm::vec3(1));
  /// A one-sided Lambertian rectangle of `size` metres facing `target`; radiance = colour * intensity / area.
  /// It shines into a cone of `coneDegrees` half angle that fades from half of it on; 0: everywhere.
  void addAreaLight(std::string lightName, glm::vec3 position, glm::vec3 target, glm::vec2 size,
                    float intensity, glm::vec3 colour = glm::vec3(1), float coneDegrees = 0);
};

/// A material that reflects by Lambert's law alone.
Material lambert(std::string name, glm::vec3 albedo);

/// A body of clear glass or another transparent material.
Material glass(std::string name, float ior, glm::vec3 tint = glm::vec3(1));

/// A translucent body of those coefficients per metre. Its base colour, for viewers that do not know
/// limn_subsurface, is what a half space of it reflects of the light that enters.
Material translucent(std::string name, glm::vec3 sigmaA, glm::vec3 sigmaSPrime, float ior, float roughness);

/// A dielectric or metal.
Material glossy(std::string name, glm::vec3 baseColour, float roughness, float metallic = 0);

/// A material of that model. Its glTF values, which are for viewers that do not know limn_material, are those
/// of the metal of equal reflectance at normal incidence or, where kd is not 0, of the dielectric over kd,
/// with a GGX lobe of about the same width.
Material reflecting(std::string name, const ReflectionModel& model);

}  // namespace limn::assets
