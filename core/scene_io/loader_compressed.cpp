// Buffer views that are compressed (EXT_meshopt_compression): each becomes a plain view of a buffer of its
// own before tinygltf sees the document. The decoders of meshoptimizer are safe to use for untrusted input;
// how much they write is checked here.
#include <meshoptimizer.h>

#include "core/scene_io/private/document.h"
#include "core/scene_io/private/loader.h"

namespace limn::scene {
namespace {

using nlohmann::json;

constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";

/// What the extension says of one view.
struct PackedView {
  std::span<const std::byte> bytes;
  std::size_t count = 0, stride = 0;
  std::string mode, filter;

  const unsigned char* data() const { return reinterpret_cast<const unsigned char*>(bytes.data()); }
};

/// What is not allowed; empty if all is well. A stream that is shorter than the least one of that many
/// elements is refused before memory is taken: a triangle and an index take a byte, and 16 bytes of an
/// attribute, the same in as many elements, take 2 bits.
std::string problemOf(const PackedView& c) {
  constexpr std::size_t kDensest = 64;
  const bool attributes = c.mode == "ATTRIBUTES";
  if (attributes ? c.stride % 4 != 0 : c.stride != 2 && c.stride != 4)
    return fmt::format("byteStride {} with mode {}; {} is accepted", c.stride, c.mode,
                       attributes ? "a multiple of 4" : "2 or 4");
  if (c.mode == "TRIANGLES" && c.count % 3 != 0)
    return fmt::format("count {} with mode TRIANGLES; a multiple of 3 is accepted", c.count);
  if (c.filter != "NONE" && !attributes)
    return fmt::format("filter {} with mode {}; filters are for ATTRIBUTES", c.filter, c.mode);
  if ((c.filter == "OCTAHEDRAL" && c.stride != 4 && c.stride != 8) ||
      (c.filter == "QUATERNION" && c.stride != 8))
    return fmt::format("byteStride {} with filter {}; {} is accepted", c.stride, c.filter,
                       c.filter == "OCTAHEDRAL" ? "4 or 8" : "8");
  const std::size_t least = c.mode == "TRIANGLES" ? c.count / 3
                            : c.mode == "INDICES" ? c.count
                                                  : c.count / kDensest * c.stride;
  if (c.bytes.size() < least)
    return fmt::format("{} bytes cannot hold {} elements of {} bytes", c.bytes.size(), c.count, c.stride);
  return {};
}

/// Returns whether the bytes could be decoded.
bool decode(const PackedView& c, std::vector<std::byte>& out) {
  if (c.mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(out.data(), c.count, c.stride, c.data(), c.bytes.size()) == 0;
  if (c.mode == "INDICES")
    return meshopt_decodeIndexSequence(out.data(), c.count, c.stride, c.data(), c.bytes.size()) == 0;
  if (meshopt_decodeVertexBuffer(out.data(), c.count, c.stride, c.data(), c.bytes.size()) != 0) return false;
  if (c.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), c.count, c.stride);
  if (c.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), c.count, c.stride);
  if (c.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), c.count, c.stride);
  return true;
}

}  // namespace

void Loader::decodeViews(Document& document) {
  const auto views = document.root.find("bufferViews");
  if (views == document.root.end()) return;
  for (std::size_t i = 0; i < views->size(); ++i) {
    json& view = (*views)[i];
    const json::json_pointer place(std::string("/extensions/") + kMeshoptExtension);
    if (!view.contains(place)) continue;
    const json& source = view[place];
    const std::string what = fmt::format("buffer view {} {}", i, kMeshoptExtension);
    PackedView compressed;
    compressed.bytes =
        bufferBytes(source.at("buffer").get<int>(), source.value("byteOffset", std::uint64_t{0}),
                    source.at("byteLength").get<std::uint64_t>(), what);
    compressed.count = source.at("count").get<std::size_t>();
    compressed.stride = source.at("byteStride").get<std::size_t>();
    compressed.mode = source.at("mode").get<std::string>();
    compressed.filter = source.value("filter", "NONE");
    spend(compressed.count * ((compressed.stride + 15) / 16), what);  // as many elements of four floats
    if (const std::string problem = problemOf(compressed); !problem.empty()) fail(what + ": " + problem);
    const std::size_t size = compressed.count * compressed.stride;
    if (view.at("byteLength").get<std::uint64_t>() != size)
      fail(fmt::format("{}: {} elements of {} bytes; the view has {} bytes", what, compressed.count,
                       compressed.stride, view.at("byteLength").get<std::uint64_t>()));
    std::vector<std::byte> decoded(size);
    if (!decode(compressed, decoded)) fail(what + ": the bytes cannot be decoded");
    bufferStorage_.push_back(std::move(decoded));
    view["buffer"] = buffers_.size();
    view["byteOffset"] = 0;
    view["extensions"].erase(kMeshoptExtension);
    buffers_.push_back(bufferStorage_.back());
  }
}

}  // namespace limn::scene
