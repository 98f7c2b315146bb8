// Declares a scene on the CPU: the content of a glTF 2.0 file, validated, as plain values. Units are metres,
// radians, seconds, W/(sr m^2) for radiance and W/sr for intensity. Everything may move: evaluate() returns
// the state at a time.
//
// World positions are relative to Scene::origin, in scenes, poses and everything made from them, so that
// scenes far from the file's origin keep their precision. Only values that people read and write are in the
// file's own world coordinates.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/export.h"
#include "core/relief/height_field.h"
#include "glsl/materials/material_model.glsl"
#include "glsl/scene/light.glsl"

namespace limn::scene {

constexpr int kNone = -1;

struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{std::numeric_limits<float>::lowest()};
  bool empty() const { return low.x > high.x; }
  void add(const glm::vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void add(const Bounds& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  glm::vec3 centre() const { return empty() ? glm::vec3(0) : 0.5f * (low + high); }
  /// Returns the radius of the sphere through the corners; 0 when empty.
  float radius() const { return empty() ? 0.f : 0.5f * glm::length(high - low); }
  bool operator==(const Bounds&) const = default;
};

/// Holds an 8-bit RGBA image with its whole mip chain, built once on the CPU (averaged in linear light for
/// sRGB), so that the GPU and the reference filter the same texels.
struct TextureImage {
  std::string name;
  bool srgb = false;
  struct Level {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;  ///< width * height * 4, top row first
  };
  std::vector<Level> levels;  ///< [0] is the full size
};

enum class Wrap { repeat, clamp, mirror };

struct TextureRef {
  int image = kNone;  ///< index into Scene::images; none: absent
  Wrap wrapS = Wrap::repeat, wrapT = Wrap::repeat;
};

/// Holds how light scatters below a surface, as a half space of uniform matter whose index is the material's
/// `ior` (glsl/diffusion).
struct Subsurface {
  glm::vec3 extinction{1};  ///< sigma_t' = sigma_a + sigma_s', reduced, per metre: 1e-6 to 1e9
  glm::vec3 absorption{0};  ///< sigma_a / sigma_t', 0 to 1
  /// Says whether the base colour, with texture and vertex colours, is the share of entering light that
  /// leaves again (glsl::walk_absorption); `absorption` is that of its factor alone. Otherwise the factor is
  /// the share that follows from `absorption`.
  bool albedoFromBaseColour = false;
};

struct Material {
  std::string name;
  glm::vec4 baseColour{1};
  float metallic = 1, roughness = 1;
  float normalScale = 1;
  glm::vec3 emission{0};  ///< emissiveFactor * emissive_strength
  float alphaCutoff = 0;  ///< 0: opaque; MASK's cutoff; BLEND counts as 0.5
  bool doubleSided = false;
  bool unlit = false;  ///< vertex colours are a factor on `emission`, too (KHR_materials_unlit)
  float ior = 1.5f;
  float specularFactor = 1;
  glm::vec3 specularColour{1};
  float transmission = 0;
  float thickness = 0;            ///< of a body, in the space of its mesh; 0: a thin wall
  float attenuationDistance = 0;  ///< 0: infinite
  glm::vec3 attenuationColour{1};
  TextureRef baseColourTexture, metalRoughTexture, normalTexture, emissiveTexture;
  int height = kNone;  ///< the height map of extras.limn_height: index into Scene::heights; none: flat
  /// Holds the model of extras.limn_material, which replaces metallic-roughness: `baseColour`, `metallic` and
  /// `roughness` are then the metal that comes next to it, for what does not evaluate the model itself
  /// (radiosity, the flux of virtual lights).
  std::optional<glsl::MaterialModel> model;
  /// Holds the scattering of a translucent material; there is none beside `model`, and `metallic` and
  /// `transmission` are then 0.
  std::optional<Subsurface> subsurface;

  /// Says whether the material has no specular part, whatever its textures hold (glsl::brdf_is_lambertian).
  bool lambertian() const { return metallic == 0 && specularFactor == 0 && !model; }
  /// Says whether the surface blocks direct and indirect light in both renderers (transmission > 0, or
  /// metallic with roughness below 0.05).
  bool specularSurface() const {
    return !model && (transmission > 0 || (metallic >= 0.5f && roughness < 0.05f));
  }
  /// Says whether the material looks up a texture.
  bool textured() const {
    return baseColourTexture.image != kNone || metalRoughTexture.image != kNone ||
           normalTexture.image != kNone || emissiveTexture.image != kNone || height != kNone;
  }
  /// Says whether primitives of the material have tangents: its shading depends on them.
  bool tangents() const {
    return normalTexture.image != kNone || height != kNone || (model && glsl::model_anisotropic(*model));
  }
};

struct MorphTarget {
  std::vector<glm::vec3> positions, normals, tangents;  ///< deltas; empty or one per vertex
  Bounds deltaBounds;                                   ///< of the position deltas, 0 included
};

/// Holds a rectangle in object space, formed by two coplanar triangles.
struct Quad {
  glm::vec3 centre{0};
  glm::vec3 sideU{0}, sideV{0};  ///< whole sides; cross(sideU, sideV) points to the front face
};

/// Holds a part of an emissive quad that emits uniformly: a rectangle light that is geometry as well.
struct EmissivePart {
  Quad quad;
  glm::vec3 texture{1};  ///< factor on the material's emission
};

/// Holds triangles with one material. Each vertex array has positions.size() elements or is empty.
struct Primitive {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;   ///< unit; always present after loading (flat if the file has none)
  std::vector<glm::vec4> tangents;  ///< xyz unit, w = +-1; present as Material::tangents() says
  std::vector<glm::vec2> uvs;       ///< present when the material has a texture or, from the file, a tangent
  std::vector<glm::vec4> colours;   ///< linear factor on the base colour; may be empty
  std::vector<glm::u16vec4> joints;
  std::vector<glm::vec4> weights;  ///< normalised to sum 1
  std::vector<uint32_t> indices;   ///< 3 per triangle, every one < positions.size()
  std::vector<MorphTarget> morphTargets;
  int material = kNone;  ///< always valid after loading
  Bounds bounds;
  /// Holds, where skinned, each joint that moves a vertex, in rising order, and the bounds of those that it
  /// moves.
  std::vector<std::pair<std::uint16_t, Bounds>> jointBounds;
  std::vector<EmissivePart>
      emissiveParts;  ///< one, or several where the emission is textured; they may overlap
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<float> morphWeights;  ///< default weights
};

struct Transform {
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 scale{1};
  LIMN_API glm::mat4 matrix() const;
};

/// Holds a light of KHR_lights_punctual with the extra limn_angle; limn_area belongs to the node.
struct LightSource {
  std::string name;
  uint32_t type = glsl::light_point;  ///< light_point, light_spot or light_directional
  glm::vec3 colour{1};
  float intensity = 1;                          ///< W/sr (point, spot, rectangle); W/m^2 (directional)
  float range = 0;                              ///< metres, 0: unlimited
  float innerCone = 0, outerCone = 0.7853982f;  ///< half angles, radians (spot)
  float angle = 0;                              ///< angular diameter of a directional light, radians
  int texture = kNone;                          ///< projected by a spot: index into Scene::lightTextures
};

struct CameraLens {
  std::string name;
  float yfov = 0.8f;  ///< vertical, radians
  float near = 0.01f;
};

struct Node {
  std::string name;
  int parent = kNone;
  Transform transform;
  std::optional<glm::mat4> matrix;  ///< replaces transform when the file gives a matrix
  std::optional<glm::mat4> placed;  ///< node to world, set by hand; overrides parents and animations
  int mesh = kNone, skin = kNone, camera = kNone, light = kNone;
  std::vector<float> morphWeights;   ///< overrides the mesh's
  std::vector<Transform> instances;  ///< EXT_mesh_gpu_instancing; empty: the node itself
  glm::vec2 limnArea{0};  ///< extras.limn_area (u, v) in metres: its light is a rectangle facing -Z
  /// Holds a translation that is added to that of transform, matrix or animation, metres; 0 when
  /// Scene::origin is 0.
  glm::dvec3 base{0};
};

struct Skin {
  std::vector<int> joints;
  std::vector<glm::mat4> inverseBind;
};

struct AnimationChannel {
  enum class Path { translation, rotation, scale, weights } path;
  enum class Interpolation { step, linear, cubic } interpolation;
  int node = kNone;
  std::vector<float> times;   ///< strictly increasing
  std::vector<float> values;  ///< times.size() * (cubic ? 3 : 1) * components
};
struct Animation {
  std::string name;
  float duration = 0;
  std::vector<AnimationChannel> channels;
};

/// Holds a uniform rectangle at infinity. A receiver sees it in the directions centre + a u + b v, |a|, |b|
/// <= 1/2, with the sides u = sides.x axisU and v = sides.y axisV. Lengths are tangents: the rectangle lies
/// in the plane at distance 1.
struct DistantRectangle {
  glm::vec3 centre{0, 0, 1};  ///< on that plane
  glm::vec3 axisU{1, 0, 0},
      axisV{0, 1, 0};  ///< unit; cross(axisU, axisV) is the plane's normal, away from the receiver
  glm::vec2 sides{1};
  glm::vec3 irradiance{0};  ///< W/m^2 on a perpendicular surface: radiance times solid angle
};

/// Holds equirectangular radiance as RGB floats, top row first, >= 0 and finite.
struct Environment {
  int width = 0, height = 0;
  std::vector<glm::vec3> texels;
  float rotation = 0;  ///< about +Y, radians
  float scale = 1;
  /// Holds rectangles at infinity that stand for the map (shading::decomposeEnvironment), in the map's own
  /// frame and without scale; empty: not decomposed. They are lights of every pose, after all others.
  std::vector<DistantRectangle> lights;
  /// Says whether each of `lights` is reflected as if its light came from its centre (as published) instead
  /// of from its area.
  bool reflectCentres = false;
  /// Says whether the light of the map is reflected as far as that of `lights` is seen, diffuse part and lobe
  /// apart, instead of the light of `lights` itself. Pictures of one light alone do not change.
  bool shadowedByRatio = false;
  explicit operator bool() const { return width > 0; }
};

/// Holds factors on the light of a spot, by direction (glsl::light_texture_place).
struct LightTexture {
  static constexpr int side = 256;
  std::vector<glm::vec3> texels;  ///< side * side, linear, 0 to 1, bottom row first
};

/// Holds the density of a medium: factors on its coefficients at the centres of voxels that fill a box, x
/// fastest. Values are interpolated linearly between the centres and are constant beyond them, in the outer
/// half voxels. There is no medium outside the box.
struct DensityGrid {
  glm::ivec3 size{0};         ///< voxels
  std::vector<float> values;  ///< size.x * size.y * size.z, >= 0 and finite
  glm::mat4 worldToBox{1};    ///< affine, from world space to the unit cube
};

/// Holds smoke: a density that is a function of position and time (glsl/media/smoke.glsl), looked up in a
/// grid.
struct Smoke {
  glm::vec3 low{0}, high{0};  ///< corners of the box that it fills, world, metres
  float whirl = 1;            ///< size of its largest whirls, metres
  float rise = 0;             ///< metres per second, along +Y
  uint32_t seed = 0;
  int resolution = 64;  ///< voxels along the box's longest side, 2 to 256
};

/// Holds a participating medium from extras.limn_medium or flags. Coefficients are per metre; with a grid or
/// smoke they are those at density 1.
struct Medium {
  glm::vec3 sigmaA{0}, sigmaS{0};
  float g = 0;
  std::shared_ptr<const DensityGrid> grid;  ///< null: homogeneous, or smoke; not all 0
  std::optional<Smoke> smoke;               ///< instead of a grid
  bool present() const { return sigmaA != glm::vec3(0) || sigmaS != glm::vec3(0); }
  bool inhomogeneous() const { return present() && (grid || smoke); }
};

/// Provides triangles that an outside source rewrites, count and topology included (isosurfaces, cloth,
/// particles).
class LIMN_API GeometrySource {
 public:
  virtual ~GeometrySource() = default;
  /// Returns the triangles at `time` seconds, in world space, relative to Scene::origin: positions, one
  /// normal each, and indices. Anything else is optional; material and bounds are ignored. The same pointer
  /// as in the last call means that nothing changed; null means that there are no triangles. The primitive
  /// must not change while a caller holds its pointer.
  virtual std::shared_ptr<const Primitive> at(double time) = 0;
};

struct Scene {
  std::filesystem::path file;
  std::vector<TextureImage> images;
  std::vector<Material> materials;
  /// Holds the height maps of extras.limn_height. u of a texture coordinate runs along x of the field, v
  /// along y, and (0, 0) is the corner of texel (0, 0), half a texel from its centre.
  std::vector<relief::HeightField> heights;
  /// Holds the tables of measured models, one after another: values of f, 1/sr
  /// (glsl/materials/measured.glsl).
  std::vector<glm::vec3> measured;
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;  ///< parents come before children
  std::vector<Skin> skins;
  std::vector<Animation> animations;
  std::vector<CameraLens> cameras;
  std::vector<LightSource> lights;
  std::vector<LightTexture> lightTextures;
  Environment environment;
  Medium medium;
  struct Dynamic {
    std::string name;
    std::shared_ptr<GeometrySource> source;
    int material = 0;
  };
  std::vector<Dynamic> dynamic;
  std::vector<std::string> warnings;  ///< one line each, shown once
  /// Holds the point of the file's world to which positions are relative, metres: 0 unless the drawn geometry
  /// lies far away (load.h).
  glm::dvec3 origin{0};
  LIMN_API uint64_t triangles() const;  ///< drawn, instances counted
};

/// Holds one drawn primitive. Its index in Pose::instances is the instance id of the G-buffer, in both
/// renderers.
struct DrawInstance {
  int node = kNone;  ///< none: dynamic geometry
  int mesh = kNone;  ///< Scene::meshes index, or Scene::dynamic index when node is none
  int primitive = 0;
  glm::mat4 objectToWorld{
      1};                ///< identity for skinned primitives: their vertices are deformed into world space
  int deformed = kNone;  ///< index into Pose::deformed when skinned or morphed
  /// Says whether front faces turn round although objectToWorld does not mirror: those of a skinned primitive
  /// whose node does. Its transform decides on the winding, as that of rigid nodes (glTF 2.0, section 3.7.4).
  bool mirroredSkin = false;
  bool operator==(const DrawInstance&) const = default;
};

/// Holds the skin and morph state of one primitive instance.
struct Deformation {
  int mesh = kNone, primitive = 0;
  std::vector<glm::mat4> joints;    ///< empty: not skinned; maps bind-space positions to world
  std::vector<float> morphWeights;  ///< empty: not morphed
};

/// Holds the geometry that a GeometrySource returned.
struct DynamicGeometry {
  std::shared_ptr<const Primitive> primitive;  ///< never null
  Bounds bounds;                               ///< world
};

struct CameraPose {
  std::string name;
  glm::mat4 worldToView{1};
  float yfov = 0.8f;
  float near = 0.01f;
};

struct Pose {
  double time = 0;  ///< seconds, as passed to evaluate()
  std::vector<DrawInstance> instances;
  std::vector<Deformation> deformed;
  std::vector<DynamicGeometry> dynamic;  ///< parallel to Scene::dynamic
  std::vector<glsl::Light>
      lights;  ///< punctual lights in node order, then emissive quads, then the environment's
  std::vector<std::string> lightNames;  ///< parallel to lights; "#index" where the file gives no name
  std::vector<CameraPose> cameras;
  Bounds bounds;                       ///< world, all instances (skinned ones: conservative)
  std::vector<Transform> nodeLocal;    ///< animated transform of each node
  std::vector<glm::mat4> nodeToWorld;  ///< of each node
  std::vector<int> weightChannel;      ///< of each node: the animation channel of its morph weights, or none
  glm::dvec3 origin{0};                ///< Scene::origin
  /// Holds nodeToWorld before rounding, in double precision, where large translations cancel; empty when
  /// Scene::origin is 0.
  std::vector<glm::dmat4> nodeToWorldExact;
};

/// Returns the state at `time` seconds. `animation` none: the first one. Animations repeat (time modulo
/// duration). Throws UsageError when `time` is not finite or there is no such animation, and Error when a
/// geometry source returns invalid triangles or nodes have grown or gone beyond what floats hold.
LIMN_API Pose evaluate(const Scene& scene, double time, int animation = kNone);
/// Writes the same state to `pose`, whose memory is reused: nothing is allocated from the second call for one
/// scene on.
LIMN_API void evaluate(const Scene& scene, double time, int animation, Pose& pose);

/// Returns the box around a transformed box (Arvo 1990, "Transforming Axis-Aligned Bounding Boxes").
LIMN_API Bounds transformed(const Bounds& box, const glm::mat4& matrix);
/// Returns conservative bounds of a deformed primitive: in world space when skinned, in object space when
/// only morphed.
LIMN_API Bounds deformedBounds(const Primitive& primitive, const Deformation& state);
/// Returns the world bounds of an instance at `pose`; conservative for deformed ones.
LIMN_API Bounds instanceBounds(const Scene& scene, const Pose& pose, const DrawInstance& instance);

/// Computes the deformed vertices of one primitive on the CPU, for the reference, with the same formulas as
/// the compute shader (glsl/geometry/deform.glsl). Positions and normals are in world space when skinned, in
/// object space when only morphed.
LIMN_API void deform(const Primitive& primitive, const Deformation& state, std::vector<glm::vec3>& positions,
                     std::vector<glm::vec3>& normals, std::vector<glm::vec4>& tangents);

}  // namespace limn::scene
