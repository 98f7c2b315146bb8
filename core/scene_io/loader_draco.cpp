// Primitives that are compressed (KHR_draco_mesh_compression): their meshes are decoded together, in a
// process of its own, and each primitive is given plain accessors before tinygltf sees the document.
#include <array>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene_io/private/document.h"
#include "core/scene_io/private/draco_meshes.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

using nlohmann::json;

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// Where an array of a decoded mesh goes: the accessor that describes it, and the key that shall name the one
/// which holds it.
struct Target {
  json* key;
  std::size_t accessor;
};

/// A primitive that is compressed. Its first target is that of the indices; those of the attributes of `mesh`
/// follow in their order.
struct Compressed {
  std::string what;
  DracoMesh mesh;
  std::vector<Target> targets;
};

std::uint32_t componentsOf(std::string_view type) {
  constexpr std::array<std::string_view, 4> kTypes{"SCALAR", "VEC2", "VEC3", "VEC4"};
  for (std::uint32_t i = 0; i < kTypes.size(); ++i)
    if (type == kTypes[i]) return i + 1;
  return 0;
}

/// Reads what the extension says of one primitive. Throws Error with what is not allowed.
class Primitives {
 public:
  explicit Primitives(json& root) : accessors_(root["accessors"]) {}

  Compressed read(json& primitive, const std::string& what) {
    Compressed out{.what = what, .mesh = {}, .targets = {}};
    if (const int mode = primitive.value("mode", 4); mode != 4)
      throw Error(fmt::format("mode {}; 4, triangles, is accepted", mode));
    if (!primitive.contains("indices")) throw Error("the primitive has no indices");
    const json& indices = target(out, primitive["indices"]);
    out.mesh.indices = indices.at("count").get<std::uint64_t>();
    json& attributes = primitive.at("attributes");
    for (const auto& [name, id] : primitive["extensions"][kDracoExtension].at("attributes").items()) {
      if (!attributes.contains(name)) throw Error(fmt::format("the primitive has no {}", oneLine(name, 60)));
      const json& accessor = target(out, attributes[name]);
      const DracoAttribute wanted{id.get<std::uint32_t>(), accessor.at("componentType").get<std::uint32_t>(),
                                  componentsOf(accessor.at("type").get_ref<const std::string&>())};
      const auto count = accessor.at("count").get<std::uint64_t>();
      if (wanted.components == 0) throw Error(fmt::format("{} is of matrices", oneLine(name, 60)));
      if (!out.mesh.attributes.empty() && count != out.mesh.vertices)
        throw Error(
            fmt::format("{} has {} elements, others have {}", oneLine(name, 60), count, out.mesh.vertices));
      out.mesh.vertices = count;
      out.mesh.attributes.push_back(wanted);
    }
    return out;
  }

 private:
  const json& target(Compressed& out, json& key) {
    const auto index = key.get<std::size_t>();
    if (index >= accessors_.size())
      throw Error(fmt::format("accessor {} does not exist; there are {}", index, accessors_.size()));
    out.targets.push_back({&key, index});
    return accessors_[index];
  }

  json& accessors_;
};

/// Whether the primitive is there without compression, too.
bool plainToo(const json& primitive, const json& root) {
  const json::json_pointer bufferView(
      fmt::format("/accessors/{}/bufferView", primitive.value("indices", std::uint64_t{0})));
  return primitive.contains("indices") && root.contains(bufferView);
}

/// Adds accessors of `arrays`, a buffer's bytes from `offset` on, and points the primitive at them. They have
/// of those that the file describes them by what is read: many primitives may name one that says much else.
void pointAt(json& root, const Compressed& primitive, std::size_t buffer, std::uint64_t& offset) {
  for (std::size_t i = 0; i < primitive.targets.size(); ++i) {
    const Target& target = primitive.targets[i];
    const std::uint64_t bytes = i == 0 ? primitive.mesh.indices * sizeof(std::uint32_t)
                                       : primitive.mesh.attributeBytes(primitive.mesh.attributes[i - 1]);
    const json& described = root["accessors"][target.accessor];
    json accessor = {{"bufferView", root["bufferViews"].size()},
                     {"componentType", described.at("componentType")},
                     {"count", described.at("count")},
                     {"normalized", described.value("normalized", false)},
                     {"type", described.at("type")}};
    if (i == 0) accessor["componentType"] = 5125;
    root["bufferViews"].push_back({{"buffer", buffer}, {"byteOffset", offset}, {"byteLength", bytes}});
    *target.key = root["accessors"].size();
    root["accessors"].push_back(std::move(accessor));
    offset += bytes;
  }
}

}  // namespace

void Loader::decodeDraco(Document& document) {
  json& root = document.root;
  if (!root.contains("meshes") || !root.contains("accessors") || !root.contains("bufferViews")) return;
  std::vector<Compressed> found;
  Primitives primitives(root);
  for (std::size_t m = 0; m < root["meshes"].size(); ++m) {
    json& list = root["meshes"][m]["primitives"];
    for (std::size_t p = 0; p < list.size(); ++p) {
      const json::json_pointer place(std::string("/extensions/") + kDracoExtension);
      if (!list[p].contains(place) || plainToo(list[p], root)) continue;
      const std::string what = fmt::format("mesh {} primitive {} {}", m, p, kDracoExtension);
      const json& views = root["bufferViews"];
      const auto view = list[p][place].at("bufferView").get<std::size_t>();
      if (view >= views.size())
        fail(fmt::format("{}: buffer view {} does not exist; there are {}", what, view, views.size()));
      try {
        found.push_back(primitives.read(list[p], what));
      } catch (const Error& error) {
        fail(fmt::format("{}: {}", what, error.what()));
      }
      DracoMesh& mesh = found.back().mesh;
      mesh.bytes =
          bufferBytes(views[view].at("buffer").get<int>(), views[view].value("byteOffset", std::uint64_t{0}),
                      views[view].at("byteLength").get<std::uint64_t>(), what);
      spend(mesh.bytes.size() / 16, what);  // which many primitives may name, and the request repeats
      for (const DracoAttribute& attribute : mesh.attributes)
        spend((mesh.vertices * attribute.components + 3) / 4, what);
      spend(mesh.indices, what);
    }
  }
  if (found.empty()) return;
  std::vector<DracoMesh> meshes;
  meshes.reserve(found.size());
  for (const Compressed& primitive : found) meshes.push_back(primitive.mesh);
  std::string problem;
  try {
    DracoArrays arrays = decodeDracoMeshes(meshes);
    if (!arrays.reason.empty()) problem = fmt::format("{}: {}", found[arrays.refused].what, arrays.reason);
    bufferStorage_.push_back(std::move(arrays.bytes));
  } catch (const Error& error) {
    problem = fmt::format("{}: {}", kDracoExtension, error.what());
  }
  if (!problem.empty()) fail(problem);
  std::uint64_t offset = 0;
  for (const Compressed& primitive : found) pointAt(root, primitive, buffers_.size(), offset);
  buffers_.push_back(bufferStorage_.back());
}

}  // namespace limn::scene
