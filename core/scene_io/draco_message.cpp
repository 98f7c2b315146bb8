#include "core/scene_io/private/draco_message.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene_io/private/refusal.h"

namespace limn::scene {
namespace {

constexpr std::array<char, 8> kMagic{'l', 'i', 'm', 'n', 'd', 'r', 'a', 'c'};
struct RequestHeader {
  std::array<char, 8> magic = kMagic;
  std::uint64_t meshes = 0;
};

struct MeshHeader {
  std::uint64_t bytes = 0, indices = 0, vertices = 0, attributes = 0;
};

struct AnswerHeader {
  static constexpr std::uint64_t arrays = 0, refusal = 1;

  std::array<char, 8> magic = kMagic;
  std::uint64_t kind = arrays;
  std::uint64_t mesh = 0;  ///< that is refused
  std::uint64_t bytes = 0;
};

/// Appends a value that can be copied byte by byte.
template <class Value>
void put(std::vector<std::byte>& out, const Value& value) {
  static_assert(std::has_unique_object_representations_v<Value>);
  const auto bytes = std::as_bytes(std::span(&value, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

/// Takes values and bytes off the front of a message. Throws Error at its end.
class Taker {
 public:
  explicit Taker(std::span<const std::byte> message) : rest_(message) {}

  template <class Value>
  Value value() {
    Value result;
    std::memcpy(&result, bytes(sizeof result).data(), sizeof result);
    return result;
  }
  std::span<const std::byte> bytes(std::uint64_t count) {
    if (count > rest_.size()) throw Error("the message is incomplete");
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  std::uint64_t left() const { return rest_.size(); }

 private:
  std::span<const std::byte> rest_;
};

}  // namespace

std::uint64_t componentBytes(std::uint32_t componentType) {
  switch (componentType) {
    case 5120:  // signed and unsigned bytes
    case 5121:
      return 1;
    case 5122:  // shorts
    case 5123:
      return 2;
    case 5125:  // 32-bit integers and floats
    case 5126:
      return 4;
    default:
      return 0;
  }
}

std::uint64_t DracoMesh::attributeBytes(const DracoAttribute& attribute) const {
  return vertices * attribute.components * componentBytes(attribute.componentType);
}

std::uint64_t DracoMesh::answerBytes() const {
  std::uint64_t sum = indices * sizeof(std::uint32_t);
  for (const DracoAttribute& attribute : attributes) sum += attributeBytes(attribute);
  return sum;
}

std::vector<std::byte> encodeDracoRequest(std::span<const DracoMesh> meshes) {
  std::vector<std::byte> request;
  put(request, RequestHeader{.meshes = meshes.size()});
  for (const DracoMesh& mesh : meshes) {
    put(request, MeshHeader{mesh.bytes.size(), mesh.indices, mesh.vertices, mesh.attributes.size()});
    for (const DracoAttribute& attribute : mesh.attributes) put(request, attribute);
    request.insert(request.end(), mesh.bytes.begin(), mesh.bytes.end());
  }
  return request;
}

std::vector<DracoMesh> decodeDracoRequest(std::span<const std::byte> request) {
  Taker take(request);
  const auto header = take.value<RequestHeader>();
  if (header.magic != kMagic) throw Error("not a request");
  std::vector<DracoMesh> meshes;
  for (std::uint64_t i = 0; i < header.meshes; ++i) {
    const auto numbers = take.value<MeshHeader>();
    DracoMesh& mesh = meshes.emplace_back();
    mesh.indices = numbers.indices;
    mesh.vertices = numbers.vertices;
    for (std::uint64_t a = 0; a < numbers.attributes; ++a)
      mesh.attributes.push_back(take.value<DracoAttribute>());
    mesh.bytes = take.bytes(numbers.bytes);
  }
  return meshes;
}

std::vector<std::byte> encodeDracoAnswer(std::span<const std::byte> arrays) {
  std::vector<std::byte> message;
  put(message, AnswerHeader{.bytes = arrays.size()});
  message.insert(message.end(), arrays.begin(), arrays.end());
  return message;
}

std::vector<std::byte> encodeDracoRefusal(std::size_t mesh, std::string_view reason) {
  const std::string_view kept = reason.substr(0, kMostReasonBytes);
  const auto bytes = std::as_bytes(std::span(kept));
  std::vector<std::byte> message;
  put(message, AnswerHeader{.kind = AnswerHeader::refusal, .mesh = mesh, .bytes = bytes.size()});
  message.insert(message.end(), bytes.begin(), bytes.end());
  return message;
}

std::uint64_t largestDracoMessage(std::span<const DracoMesh> meshes) {
  std::uint64_t bytes = 0;
  for (const DracoMesh& mesh : meshes) bytes += mesh.answerBytes();
  return sizeof(AnswerHeader) + std::max<std::uint64_t>(bytes, kMostReasonBytes);
}

DracoAnswer decodeDracoAnswer(std::span<const std::byte> message, std::span<const DracoMesh> meshes) {
  Taker take(message);
  const auto header = take.value<AnswerHeader>();
  const std::span<const std::byte> rest = take.bytes(take.left());
  const auto refuse = [] { throw Error("decoding it gave no meshes"); };
  if (header.magic != kMagic || header.bytes != rest.size()) refuse();
  DracoAnswer answer;
  if (header.kind == AnswerHeader::refusal && header.mesh < meshes.size()) {
    answer.refused = header.mesh;
    answer.reason = oneLine({reinterpret_cast<const char*>(rest.data()), rest.size()}, kMostReasonBytes);
    if (!answer.reason.empty()) return answer;
  }
  std::uint64_t expected = 0;
  for (const DracoMesh& mesh : meshes) expected += mesh.answerBytes();
  if (header.kind != AnswerHeader::arrays || rest.size() != expected) refuse();
  answer.arrays = rest;
  return answer;
}

}  // namespace limn::scene
