// Which files a scene may name: those in its own folder or below.
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/scene_io/load.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percentDecoded(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 && hexDigit(uri[i + 2]) >= 0) {
      out.push_back(static_cast<char>(16 * hexDigit(uri[i + 1]) + hexDigit(uri[i + 2])));
      i += 2;
    } else {
      out.push_back(uri[i]);
    }
  }
  return out;
}

/// The JSON of a .gltf or .glb: of the latter the first chunk, behind 12 bytes of header and 8 of its own.
/// What follows it may be large.
std::string documentOf(const std::filesystem::path& scene) {
  constexpr std::size_t chunk = 20;
  const std::string head = readBeginning(scene, chunk);
  if (!head.starts_with("glTF") || head.size() < chunk)
    return readBeginning(scene, std::numeric_limits<std::uint64_t>::max());
  std::uint32_t length = 0;
  std::memcpy(&length, head.data() + 12, sizeof length);
  return readBeginning(scene, chunk + std::uint64_t{length}).substr(chunk);
}

bool isInside(const std::filesystem::path& file, const std::filesystem::path& folder) {
  auto part = file.begin();
  for (const auto& step : folder) {
    if (part == file.end() || *part != step) return false;
    ++part;
  }
  return part != file.end();
}

/// What a data URI holds, or nothing where that is not in base64.
std::vector<unsigned char> dataOf(const std::string& uri) {
  constexpr std::string_view encoding = ";base64";
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(encoding)) return {};
  // tinygltf decodes what has a header that it knows: octets are right for all, which are told by content.
  std::vector<unsigned char> decoded;
  std::string type;
  tinygltf::DecodeDataURI(&decoded, type, "data:application/octet-stream;base64," + uri.substr(comma + 1), 0,
                          false);
  return decoded;
}

}  // namespace

bool isDataUri(std::string_view uri) {
  constexpr std::string_view scheme = "data:";  // in capitals as well: RFC 3986, 3.1
  return lowerCase(uri.substr(0, scheme.size())) == scheme;
}

std::filesystem::path Loader::resolve(const std::string& uri, const std::string& what) const {
  const std::string decoded = percentDecoded(uri);
  if (folder_.empty())
    fail(fmt::format("{}: '{}' is another file; a scene in memory can name none", what, oneLine(uri, 80)));
  if (decoded.empty() || decoded.find('\0') != std::string::npos || decoded.find("://") != std::string::npos)
    fail(fmt::format("{}: '{}' is not a file name; a file in the scene's folder is accepted", what,
                     oneLine(uri, 80)));
  const std::filesystem::path relative(decoded);
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::weakly_canonical(folder_, error);
  if (error) fail(fmt::format("{}: cannot resolve the scene's folder: {}", what, error.message()));
  const std::filesystem::path file = std::filesystem::weakly_canonical(folder / relative, error);
  if (error) fail(fmt::format("{}: '{}' cannot be resolved: {}", what, oneLine(uri, 80), error.message()));
  // `..` is refused even where it would lead back: whether it does depends on the folder's own name.
  bool climbs = relative.is_absolute();
  for (const auto& step : relative) climbs = climbs || step == "..";
  if (climbs || !isInside(file, folder))
    fail(fmt::format("{}: '{}' lies outside the scene's folder; only files in it or below are read", what,
                     oneLine(uri, 80)));
  return file;
}

std::vector<std::byte> Loader::uriBytes(const std::string& uri, const std::string& what,
                                        std::uint64_t maxBytes) const {
  if (!isDataUri(uri)) {
    const std::filesystem::path file = resolve(uri, what);
    try {
      return readFile(file, maxBytes);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", what, error.what()));
    }
  }
  const std::vector<unsigned char> decoded = dataOf(uri);
  if (decoded.empty())
    throw Error(fmt::format("{}: the data URI cannot be decoded; base64 is accepted", what));
  const auto bytes = std::as_bytes(std::span(decoded));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> Loader::readUri(const std::string& uri, const std::string& what,
                                       std::uint64_t maxBytes) const {
  std::string problem;
  try {
    return uriBytes(uri, what, maxBytes);
  } catch (const Error& error) {
    problem = error.what();
  }
  fail(problem);
}

std::vector<std::filesystem::path> filesOf(const std::filesystem::path& scene) {
  std::vector<std::filesystem::path> files = {scene};
  std::set<std::string> known;
  const std::filesystem::path folder = scene.has_parent_path() ? scene.parent_path() : ".";
  const auto add = [&](const std::string& text) {
    constexpr std::size_t longest = 4096;
    if (text.empty() || text.size() > longest) return;  // a data URI may be a large one
    const std::string name = percentDecoded(text);
    const std::filesystem::path relative(name);
    if (name.find('\0') != std::string::npos) return;
    if (relative.is_absolute() || std::find(relative.begin(), relative.end(), "..") != relative.end()) return;
    std::error_code ignored;
    if (!known.insert(name).second || !std::filesystem::is_regular_file(folder / name, ignored)) return;
    files.push_back(folder / name);
  };
  const nlohmann::json document = nlohmann::json::parse(documentOf(scene), nullptr, false);
  std::vector<const nlohmann::json*> left = {&document};  // no recursion: nobody has looked at its depth
  while (!left.empty()) {
    const nlohmann::json& value = *left.back();
    left.pop_back();
    if (value.is_string()) add(value.get_ref<const std::string&>());
    if (value.is_structured())
      for (const nlohmann::json& part : value) left.push_back(&part);
  }
  return files;
}

}  // namespace limn::scene
