// From bytes to a tinygltf model whose structure is sound. tinygltf trusts its input in places (nesting
// depth, types, image and buffer ranges), so the JSON is checked first and buffers and images are taken out
// of it: this loader reads them itself.
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json_depth.h"
#include "core/base/text.h"
#include "core/scene_io/private/document.h"
#include "core/scene_io/private/document_schema.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 34;

// clang-format off
constexpr std::array kSupportedExtensions = {
    "KHR_lights_punctual",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_scatter",
    "KHR_materials_volume_scatter",
    "KHR_texture_transform",
    "KHR_materials_emissive_strength",
    "EXT_mesh_gpu_instancing",
    "KHR_mesh_quantization",
    "KHR_materials_unlit",
    "KHR_materials_pbrSpecularGlossiness",
    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",
    "EXT_texture_webp",
};
// clang-format on

bool isSupported(std::string_view extension) {
  return std::ranges::find(kSupportedExtensions, extension) != kSupportedExtensions.end();
}

/// The names in extensionsUsed of what is not read, a few of them; empty if there is nothing of that kind.
std::string unreadExtensions(const json& root) {
  constexpr std::size_t most = 8;
  std::string names;
  const auto used = root.find("extensionsUsed");
  if (used == root.end() || !used->is_array()) return names;
  std::size_t count = 0;
  for (const json& entry : *used) {
    if (!entry.is_string() || isSupported(entry.get_ref<const std::string&>())) continue;
    if (++count > most) return names + " and others";
    names += (count == 1 ? "" : ", ") + entry.get_ref<const std::string&>();
  }
  return names;
}

std::uint32_t word(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
  return value;
}

/// Every number must survive the conversion to int where tinygltf wants one: an integer outside 53 bits never
/// does.
bool integersFit(const json& value) {
  if (value.is_structured()) {
    return std::all_of(value.begin(), value.end(), [](const json& v) { return integersFit(v); });
  }
  if (value.is_number_unsigned()) return value.get<std::uint64_t>() < (std::uint64_t{1} << 53);
  if (value.is_number_integer()) return value.get<std::int64_t>() > -(std::int64_t{1} << 53);
  return true;
}

/// tinygltf holds whole numbers of extras and extensions as int, where larger ones would turn into others:
/// these become reals, which it keeps. `untyped` says whether `value` belongs to either.
void keepLargeNumbers(json& value, bool untyped = false) {
  if (value.is_object()) {
    for (const auto& [name, member] : value.items())
      keepLargeNumbers(member, untyped || name == "extras" || name == "extensions");
  } else if (value.is_array()) {
    for (json& element : value) keepLargeNumbers(element, untyped);
  } else if (untyped && value.is_number_integer()) {
    const auto number = value.get<std::int64_t>();  // of 53 bits: integersFit()
    if (number != static_cast<int>(number)) value = static_cast<double>(number);
  }
}

}  // namespace

Container openContainer(std::span<const std::byte> bytes, const std::string& name) {
  const auto fail = [&](const std::string& what) -> void { throw Error(fmt::format("{}: {}", name, what)); };
  const bool binary = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
  if (!binary) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || text[first] != '{')
      fail("not a glTF 2.0 file (.gltf or .glb); limn import converts other formats, by assimp");
    return {text, {}};
  }
  if (bytes.size() < 20) fail(fmt::format("truncated GLB: {} bytes, a header has 20", bytes.size()));
  if (word(bytes, 4) != 2) fail(fmt::format("GLB version {}; version 2 is accepted", word(bytes, 4)));
  if (word(bytes, 8) != bytes.size())
    fail(fmt::format("truncated or damaged GLB: the header declares {} bytes, the file has {}",
                     word(bytes, 8), bytes.size()));
  Container container;
  std::size_t at = 12;
  for (int chunk = 0; at < bytes.size(); ++chunk) {
    if (bytes.size() - at < 8) fail(fmt::format("truncated GLB: chunk {} has no header", chunk));
    const std::size_t length = word(bytes, at);
    const std::uint32_t type = word(bytes, at + 4);
    at += 8;
    if (length > bytes.size() - at)
      fail(fmt::format("truncated GLB: chunk {} declares {} bytes, {} are left", chunk, length,
                       bytes.size() - at));
    const auto content = bytes.subspan(at, length);
    at += length;
    if (chunk == 0) {
      if (type != 0x4e4f534au) fail("damaged GLB: the first chunk is not JSON");
      container.json = {reinterpret_cast<const char*>(content.data()), content.size()};
    } else if (chunk == 1 && type == 0x004e4942u) {
      container.binary = content;
    }
  }
  return container;
}

namespace {

/// The checks tinygltf leaves out; each failure is a sentence for Error.
class DocumentCheck {
 public:
  explicit DocumentCheck(const LoadLimits& limits) : limits_(limits) {}

  /// Empty if all is well.
  std::string check(const json& root) {
    if (!root.is_object()) return "the JSON is not an object";
    const json* asset = member(root, "asset");
    const json* version = asset ? member(*asset, "version") : nullptr;
    if (!version || !version->is_string()) return "no asset.version: not glTF 2.0";
    const std::string& text = version->get_ref<const std::string&>();
    if (!text.starts_with("2.")) return fmt::format("glTF version '{}'; 2.0 is accepted", oneLine(text));
    if (!integersFit(root)) return "an integer in the JSON is too large; less than 2^53 is accepted";
    for (const char* list : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images",
                             "materials", "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
      if (const std::string problem = checkList(root, list); !problem.empty()) return problem;
    }
    if (const std::string problem = checkExtensions(root); !problem.empty()) return problem;
    return checkProperties(root);
  }

 private:
  static const json* member(const json& object, const char* name) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
  }

  std::string checkList(const json& root, const char* name) const {
    const json* list = member(root, name);
    if (!list) return {};
    if (!list->is_array()) return fmt::format("'{}' is not an array", name);
    if (list->size() > static_cast<std::size_t>(limits_.nodes))
      return fmt::format("{} {}; at most {} are accepted", list->size(), name, limits_.nodes);
    for (std::size_t i = 0; i < list->size(); ++i) {
      if (!(*list)[i].is_object()) return fmt::format("{}[{}] is not an object", name, i);
    }
    return {};
  }

  static std::string checkExtensions(const json& root) {
    const json* required = member(root, "extensionsRequired");
    if (!required) return {};
    if (!required->is_array()) return "'extensionsRequired' is not an array";
    for (const json& entry : *required) {
      if (!entry.is_string()) return "'extensionsRequired' does not hold names";
      const std::string& extension = entry.get_ref<const std::string&>();
      if (!isSupported(extension)) {
        return fmt::format(
            "needs the extension {}, which is not supported; save the file without it, for example "
            "with gltf-transform",
            oneLine(extension));
      }
    }
    return {};
  }

  const LoadLimits& limits_;
};

}  // namespace

namespace {

/// Names end up in messages, tables and lists, a line each.
void cleanNames(json& entries) {
  for (json& entry : entries)
    if (const auto name = entry.find("name"); name != entry.end()) *name = oneLine(name->get<std::string>());
}

/// tinygltf gives each sampler of an animation a copy of the animation's own extensions, of which none is
/// read.
void dropAnimationExtensions(json& root) {
  const auto animations = root.find("animations");
  if (animations == root.end()) return;
  for (json& animation : *animations) animation.erase("extensions");
}

}  // namespace

void Loader::parse(const Container& container, tinygltf::Model& model) {
  if (isTooDeepJson(container.json)) fail(fmt::format("JSON nested deeper than {} levels", kMaxJsonDepth));
  Document document;
  json& root = document.root;
  try {
    root = json::parse(container.json);
  } catch (const json::exception& error) {
    fail(fmt::format("not valid JSON: {}", oneLine(error.what())));
  }
  if (const std::string problem = DocumentCheck(limits_).check(root); !problem.empty()) fail(problem);
  if (const std::string names = unreadExtensions(root); !names.empty())
    warn(fmt::format("what these extensions add is not read: {}", names));
  for (const char* list : {"animations", "cameras", "images", "materials", "meshes", "nodes", "skins"})
    if (const auto entries = root.find(list); entries != root.end()) cleanNames(*entries);
  if (const json::json_pointer lights("/extensions/KHR_lights_punctual/lights"); root.contains(lights))
    cleanNames(root[lights]);
  dropAnimationExtensions(root);
  takeBuffers(document, container.binary);
  takeImages(document);
  decodeViews(document);
  decodeDraco(document);
  keepLargeNumbers(root);

  const std::string text = root.dump();
  if (text.size() > std::numeric_limits<unsigned>::max()) fail("more than 4 GiB of JSON");
  std::string error, warning;
  bool parsed = false;
  try {
    tinygltf::TinyGLTF parser;
    parsed = parser.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                        static_cast<unsigned>(text.size()), "", tinygltf::REQUIRE_VERSION);
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  if (!parsed) fail(fmt::format("not valid glTF: {}", oneLine(error)));
}

void Loader::takeBuffers(Document& document, std::span<const std::byte> binary) {
  json& root = document.root;
  const auto list = root.find("buffers");
  if (list == root.end()) return;
  // Each is read once, however many buffers name it.
  std::map<std::filesystem::path, std::span<const std::byte>> files;
  const auto contentOf = [&](const std::string& uri, const std::string& what) {
    const auto read = [&]() -> std::span<const std::byte> {
      return bufferStorage_.emplace_back(readUri(uri, what, kMaxFileBytes));
    };
    if (isDataUri(uri)) return read();
    const auto [file, isNew] = files.try_emplace(resolve(uri, what));
    if (isNew) file->second = read();
    return file->second;
  };
  for (std::size_t i = 0; i < list->size(); ++i) {
    const json& buffer = (*list)[i];
    const std::string what = fmt::format("buffer {}", i);
    const auto bytes = buffer.at("byteLength").get<std::uint64_t>();
    const auto uri = buffer.find("uri");
    std::span<const std::byte> content = binary;
    if (buffer.value(json::json_pointer("/extensions/EXT_meshopt_compression/fallback"), false)) {
      buffers_.emplace_back();  // stands for what is decoded instead
      continue;
    }
    if (uri != buffer.end()) {
      content = contentOf(uri->get_ref<const std::string&>(), what);
    } else if (i != 0) {
      fail(fmt::format("{} has no uri; only buffer 0 may be the GLB's binary chunk", what));
    }
    if (bytes > content.size())
      fail(fmt::format("{} declares {} bytes, {} are there", what, bytes, content.size()));
    buffers_.push_back(content.first(static_cast<std::size_t>(bytes)));
  }
  root.erase(list);
}

void Loader::takeImages(Document& document) {
  json& root = document.root;
  const auto list = root.find("images");
  if (list == root.end()) return;
  // Files may have one image for each texture that shows a picture: it is decoded once.
  std::map<std::pair<std::string_view, int>, int> known;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const json& image = (*list)[i];
    ImageSource source;
    source.name = image.value("name", "");
    const std::string what = fmt::format("image {}", i);
    const auto uri = image.find("uri");
    const auto view = image.find("bufferView");
    if (uri != image.end()) {
      source.uri = uri->get<std::string>();
      if (!isDataUri(source.uri)) resolve(source.uri, what);
    } else if (view != image.end()) {
      source.view = view->get<int>();
    } else {
      fail(fmt::format("{} has neither a uri nor a bufferView", what));
    }
    const std::string_view name =
        uri != image.end() ? uri->get_ref<const std::string&>() : std::string_view();
    source.first = known.emplace(std::pair(name, source.view), static_cast<int>(i)).first->second;
    imageSources_.push_back(std::move(source));
  }
  root.erase(list);
}

}  // namespace limn::scene
