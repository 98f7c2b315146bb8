// Declares what the steps of the scene loader share. Internal to the loader. One Loader reads one file.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/image/image.h"
#include "core/scene/metaballs.h"
#include "core/scene/scene.h"
#include "core/scene_io/load.h"

namespace tinygltf {
class Model;
class Node;
class Value;
struct Accessor;
struct AnimationChannel;
struct AnimationSampler;
struct Material;
struct Primitive;
struct Texture;
}  // namespace tinygltf

namespace limn::scene {

/// Holds the two parts of a glTF file: the JSON text, and the binary chunk of a GLB (empty otherwise).
struct Container {
  std::string_view json;
  std::span<const std::byte> binary;
};
/// Splits a file into its parts. The result points into `bytes`. Throws Error that names `name` for a damaged
/// GLB.
Container openContainer(std::span<const std::byte> bytes, const std::string& name);

/// Stands for an index of refraction of "infinity" (KHR_materials_ior): a surface that reflects all but 0.4 %
/// of its specular colour.
constexpr float kInfiniteIndex = 1000;

/// Returns whether a URI holds its data itself (RFC 2397) instead of naming a file.
bool isDataUri(std::string_view uri);

/// Holds the components of one accessor, converted to float: count * components values.
struct Floats {
  std::size_t count = 0;
  int components = 0;
  std::vector<float> values;
};

/// Holds texture coordinates as a texture or a material wants them: a set, and an affine map of it.
struct UvUse {
  bool used = false;
  int set = 0;
  glm::vec2 offset{0}, scale{1};
  float rotation = 0;
  bool operator==(const UvUse&) const = default;
};

/// Holds a map between texture coordinates under which an image that repeats repeats again: u and v, which
/// trade places first where `turned` says so, times whole numbers other than 0, plus `shift` in [0, 1].
struct UvMap {
  bool turned = false;
  glm::ivec2 repeats{1};
  glm::dvec2 shift{0};
};

class Loader {
 public:
  /// Prepares to read one file. An empty `folder` means that no other file may be read.
  Loader(std::string name, std::filesystem::path folder, const LoadLimits& limits);
  Scene load(std::span<const std::byte> bytes);

 private:
  /// Holds a texture of the material that is being read.
  struct TextureUse {
    TextureRef* texture = nullptr;  ///< null: a height map
    UvUse uvs;
    std::string what;
  };
  /// Holds glTF's textureInfo.
  struct TextureInfo {
    int index = -1, texCoord = 0;
    const tinygltf::Value* transform = nullptr;  ///< KHR_texture_transform; null: none
  };
  struct ImageSource {
    std::string name, uri;
    int view = kNone;
    int first = kNone;  ///< of the file's images, the first one that is the same picture
  };
  /// Holds what becomes of an image of specular colours and glossiness.
  struct GlossyImage {
    int roughness = kNone;  ///< index into Scene::images
    glm::vec3 meanSpecular{1};
    bool varies = false;  ///< the specular colours do
  };

  // load.cpp
  void readSceneExtras();
  void readMedium(const tinygltf::Value& medium);
  void readSmoke(const tinygltf::Value& smoke, const std::string& what);
  /// Returns the pose at the time 0. Throws Error that names the file.
  Pose poseAtRest() const;
  void checkResult();

  // loader_files.cpp
  /// Returns the path of a file that the scene names by a URI, which may be percent-encoded. Throws Error
  /// when it lies outside the folder.
  std::filesystem::path resolve(const std::string& uri, const std::string& what) const;
  /// Returns the bytes that a URI refers to. Throws Error "WHAT: ..." without the scene's name.
  std::vector<std::byte> uriBytes(const std::string& uri, const std::string& what,
                                  std::uint64_t maxBytes) const;
  /// Returns the same bytes; errors name the scene as well.
  std::vector<std::byte> readUri(const std::string& uri, const std::string& what,
                                 std::uint64_t maxBytes) const;

  // loader_document.cpp
  struct Document;
  /// Checks the JSON text before tinygltf reads it, moves the buffers and images out of it, and parses the
  /// rest.
  void parse(const Container& container, tinygltf::Model& model);
  void takeBuffers(Document& document, std::span<const std::byte> binary);
  void takeImages(Document& document);

  // loader_compressed.cpp
  void decodeViews(Document& document);

  // loader_draco.cpp
  /// Gives the primitives that are compressed by Draco accessors of their own, which hold what was decoded.
  void decodeDraco(Document& document);

  // loader_accessor.cpp
  /// Returns the accessor's values, which are finite. `expected` is the count that it must have; negative:
  /// any.
  Floats readFloats(int accessor, std::initializer_list<int> components, std::int64_t expected,
                    const std::string& what);
  std::vector<std::uint32_t> readIntegers(int accessor, int components, std::int64_t expected,
                                          const std::string& what);
  const tinygltf::Accessor& accessorAt(int index, const std::string& what) const;
  std::span<const std::byte> viewBytes(int view, const std::string& what) const;
  std::span<const std::byte> bufferBytes(int buffer, std::uint64_t offset, std::uint64_t length,
                                         const std::string& what) const;
  /// Calls store(element, pointer to its first component) for every element, sparse ones last.
  template <class Store>
  void forEachElement(const tinygltf::Accessor& accessor, int components, std::int64_t expected,
                      const std::string& what, Store store);
  template <class Store>
  void forEachSparse(const tinygltf::Accessor& accessor, std::size_t elementBytes, const std::string& what,
                     Store store) const;

  // loader_material.cpp
  void readMaterials();
  Material readMaterial(const tinygltf::Material& source, const std::string& what);
  void readMaterialExtensions(const tinygltf::Material& source, Material& material, const std::string& what);
  /// Gives a surface whose specular colour is above 1, or says alone what it reflects (kInfiniteIndex), one
  /// whose largest channel is 1, and the index of refraction with which it reflects as much: the G-buffer
  /// holds dark colours in few steps. Clamps the colour, with a warning, where light is refracted, too.
  void settleSpecularColour(Material& material, const std::string& what);
  /// Makes the surface show its base colour whatever lights it (KHR_materials_unlit).
  void applyUnlit(Material& material, const std::string& what);
  // loader_specular_glossiness.cpp
  /// Replaces the material's metallic-roughness by KHR_materials_pbrSpecularGlossiness.
  void applySpecularGlossiness(const tinygltf::Value& extension, Material& material,
                               std::vector<TextureUse>& uses, const std::string& what);
  int readGlossiness(int image, bool another, float glossiness, glm::vec3& meanSpecular,
                     const std::string& what);
  /// Appends the image's glossiness, as roughness, to Scene::images.
  GlossyImage addGlossiness(int index, float glossiness, Image8 image);
  // loader_material_model.cpp
  /// Returns the model that extras.limn_material describes.
  glsl::MaterialModel readModel(const tinygltf::Value& extras, const std::string& what);
  /// Returns the model of a file of measured reflectance, whose values it appends to the scene; a file that
  /// several materials name is read once.
  glsl::MaterialModel readMeasured(const tinygltf::Value& file, const std::string& what);
  void limitEnergy(glsl::MaterialModel& model, const std::string& what);
  void applyModel(Material& material, const glsl::MaterialModel& model, const std::string& what);

  // loader_subsurface.cpp
  /// Makes the material translucent where extras.limn_subsurface or a draft of Khronos says so.
  void applySubsurface(const tinygltf::Material& source, Material& material, const std::string& what);
  Subsurface readSubsurface(const tinygltf::Value& extras, const Material& material, const std::string& what);
  /// Returns the scattering of KHR_materials_scatter or KHR_materials_volume_scatter; none, with a warning,
  /// where the material says nothing of a volume.
  std::optional<Subsurface> readScatterDraft(const tinygltf::Material& source, const Material& material,
                                             const std::string& what);
  /// Returns the index in Scene::images of an image with another one's alpha and no colour: its own where it
  /// has none.
  int maskOf(int image, const std::string& what);
  /// Returns one number for all channels or three of them, none negative.
  glm::vec3 readChannels(const tinygltf::Value& object, const char* key, const std::string& what);

  // loader_height.cpp
  /// Returns the index in Scene::heights of the map that extras.limn_height describes.
  int readHeight(const tinygltf::Value& extras, std::vector<TextureUse>& uses, const std::string& what);
  /// Warns where the texture coordinates of a primitive do not fit the size that its material's map has.
  void checkHeightUvs(const Primitive& primitive);

  // loader_texture_space.cpp
  /// Returns the texture coordinates of a material: those of the first of its textures that all others can
  /// follow, which are resampled to them; otherwise those of the first one, with a warning for each other one
  /// that cannot follow.
  UvUse settleUvs(std::vector<TextureUse> uses, const Material& material);
  /// Makes the texture one that looks at u as it did at map(u). Returns false where that would be too large.
  bool resample(TextureRef& texture, const UvMap& map);

  // loader_material.cpp
  /// Returns the textureInfo of an extension or of extras, which tinygltf leaves as it is in the file.
  static TextureInfo textureInfo(const tinygltf::Value& object);
  void readTexture(const TextureInfo& info, bool srgb, TextureRef& out, std::vector<TextureUse>& uses,
                   const std::string& what);
  const tinygltf::Texture& textureAt(int index, const std::string& what) const;
  /// Returns the first result other than none of read(image, another): of the texture's WebP image
  /// (EXT_texture_webp), where it has one, with `another` saying whether there is one to fall back on, and
  /// then of that. Warns where the texture has no image that can be read.
  int firstImage(const tinygltf::Texture& texture, const std::string& what,
                 const std::function<int(int image, bool another)>& read);
  /// Returns how a texture goes on beyond its edges, along u and v.
  std::pair<Wrap, Wrap> wrapsOf(const tinygltf::Texture& texture, const std::string& what) const;
  /// Returns the texture coordinates that a texture names.
  UvUse uvsOf(const TextureInfo& info, const std::string& what) const;
  const ImageSource& imageAt(int index, const std::string& what) const;
  std::string imageLabel(int index) const;
  /// Returns the bytes of an image, which `storage` keeps where no buffer does. Throws Error "LABEL: ..."
  /// without the scene's name when they cannot be read.
  std::span<const std::byte> imageBytes(const ImageSource& source, const std::string& label,
                                        std::vector<std::byte>& storage) const;
  /// Returns the index in Scene::images of the texture's image, or none, with a warning, when it cannot be
  /// read.
  int readTextureImage(const tinygltf::Texture& texture, bool srgb, const std::string& what);
  /// Returns the same of an image; `another` says that there is another one to take instead.
  int readImage(int index, bool another, bool srgb, const std::string& what);
  /// Returns the image as stored, or nothing, with a warning, when it cannot be read.
  std::optional<Image8> decodeImage(int index, bool another, const std::string& what);
  /// Appends the image, with its smaller levels, to Scene::images and returns its index.
  int addImage(int index, bool srgb, Image8 image);
  /// Returns how many texels a picture says that it has. Throws Error where they are beyond the limits,
  /// before a decoder sees it.
  std::uint64_t statedTexels(std::span<const std::byte> bytes, const std::string& label) const;

  // loader_mesh.cpp
  void readMeshes();
  bool readPrimitive(const tinygltf::Primitive& source, Primitive& out, const std::string& what);
  void readAttributes(const tinygltf::Primitive& source, Primitive& out, const std::string& what);
  void readUvs(const tinygltf::Primitive& source, Primitive& out, const std::string& what);
  void readSkinAttributes(const tinygltf::Primitive& source, Primitive& out, const std::string& what);
  void readMorphTargets(const tinygltf::Primitive& source, Primitive& out, const std::string& what);
  void readTriangles(const tinygltf::Primitive& source, Primitive& out, const std::string& what);
  int defaultMaterial();
  void completePrimitive(Primitive& out, const std::string& what);
  void completeNormals(Primitive& out, const std::string& what);

  // loader_node.cpp
  void readNodes();
  void orderNodes();
  void findVisible();
  Node readNode(const tinygltf::Node& source, const std::string& what);
  void readInstances(const tinygltf::Node& source, Node& node, const std::string& what);
  void readNodeLight(const tinygltf::Node& source, Node& node, const std::string& what);
  void readSkins();
  void checkNodeUses();
  glm::quat unitRotation(const glm::dquat& q, const std::string& what) const;

  // loader_origin.cpp
  /// Moves Scene::origin to a point amid the scene, and positions with it, when the scene lies far away.
  void moveOrigin();
  void rebaseNodes();

  // loader_metaballs.cpp
  void readMetaballs();  ///< replaces those read before
  Metaballs readMetaballs(const tinygltf::Value& extras, const std::string& what) const;
  int metaballMaterial(const tinygltf::Value& extras, const std::string& what);
  /// Returns the index of that material, or of one without the textures that it has.
  int untexturedMaterial(int index, const std::string& what);

  // loader_animation.cpp
  void readAnimations();
  void readChannel(const tinygltf::AnimationChannel& source, const tinygltf::AnimationSampler& sampler,
                   Animation& animation, const std::string& what);

  // loader_light.cpp
  void readLights();
  /// Returns the angular diameter that extras.limn_angle says, of a light or its node; none, with a warning,
  /// where the light is not directional.
  std::optional<float> readAngle(const tinygltf::Value& extras, uint32_t type, const std::string& what);
  int readLightTexture(const tinygltf::Value& index, uint32_t type, const std::string& what);
  void readCameras();

  [[noreturn]] void fail(const std::string& what) const;
  void warn(const std::string& what);
  /// Adds `amount` to what counts against limits_.vertices.
  void spend(std::uint64_t amount, const std::string& what);
  float number(double value, const std::string& what) const;  ///< throws Error unless finite as float
  /// Returns `value` clamped to [low, high], with a warning when that changes it.
  float ranged(double value, double low, double high, const std::string& what);
  /// Returns the `count` numbers of an extras or extension array.
  std::vector<float> numbers(const tinygltf::Value& value, std::size_t count, const std::string& what) const;

  std::string name_;
  std::filesystem::path folder_;
  LoadLimits limits_;
  const tinygltf::Model* model_ = nullptr;  ///< while load() runs
  std::uint64_t spent_ = 0, texels_ = 0;
  Scene scene_;
  std::set<std::string> warned_;

  std::vector<ImageSource> imageSources_;
  std::vector<std::span<const std::byte>> buffers_;
  std::vector<std::vector<std::byte>> bufferStorage_;
  std::map<std::pair<int, bool>, int> imageIndex_;             ///< (image, sRGB) to Scene::images
  std::map<int, std::string> unreadable_;                      ///< images that cannot be read, to why
  std::map<std::pair<int, float>, GlossyImage> glossyImages_;  ///< by image and glossiness factor
  std::map<int, int> maskIndex_;  ///< of Scene::images, to what maskOf() made of them
  /// Holds what tells resampled images apart: the index in Scene::images of what they show, and UvMap.
  using ResampledKey = std::tuple<int, bool, int, int, double, double>;
  std::map<ResampledKey, int> resampledIndex_;  ///< to Scene::images
  std::uint64_t resampledTexels_ = 0;

  std::map<std::string, glsl::MaterialModel> measured_;  ///< by URI

  /// Holds what tells height maps apart: image, wrap, scale, offset, tile.
  using HeightKey = std::tuple<int, relief::Wrap, double, double, double, double>;
  std::map<HeightKey, int> heightIndex_;  ///< to Scene::heights
  std::set<int> badUvs_;                  ///< materials whose height maps do not fit their coordinates
  std::vector<glm::dvec2> heightTiles_;   ///< parallel to Scene::heights, metres per unit of u and v

  std::map<int, int> lightTextureIndex_;  ///< Scene::images to Scene::lightTextures

  int defaultMaterial_ = kNone;    ///< for primitives that name none
  std::map<int, int> untextured_;  ///< materials with textures to those without, for metaballs
  std::vector<UvUse> uvUses_;      ///< parallel to Scene::materials
  std::vector<int> newIndex_;      ///< file's node index to Scene::nodes
  std::vector<int> fileIndex_;
  std::vector<int> cameraIndex_;  ///< file's camera index to Scene::cameras, or none
  std::vector<char> visible_;     ///< by the file's index: below the scene's roots
};

}  // namespace limn::scene
