// Declares the protocol between the program limn-read-draco and the process that starts it: arguments and a
// request one way, one message back.
//
//   limn-read-draco MEMORY SECONDS < REQUEST
//
// MEMORY is in bytes, SECONDS in seconds. A request is a header in the machine's own byte order, then for
// each mesh its numbers, its attributes and its bytes. The message is a header, then `bytes` bytes: the
// arrays of all meshes, one after another, or, when a mesh is refused, the reason. Nothing follows. The
// message is untrusted, because a damaged mesh may have taken over the program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn::scene {

/// Names an array that is asked for: the attribute's id in the compressed mesh, and how its numbers are
/// stored in the answer (glTF's codes of component types).
struct DracoAttribute {
  std::uint32_t id = 0, componentType = 0, components = 0;
};

/// Holds what is asked of one compressed mesh, whose bytes belong to the caller.
struct DracoMesh {
  std::span<const std::byte> bytes;
  std::uint64_t indices = 0, vertices = 0;  ///< which it must have
  std::vector<DracoAttribute> attributes;

  /// Returns the size of an attribute's array in bytes.
  std::uint64_t attributeBytes(const DracoAttribute& attribute) const;
  /// Returns the size of its arrays: `indices` 32-bit integers, then those of its attributes, packed.
  LIMN_API std::uint64_t answerBytes() const;
};

/// Returns the size in bytes of a component of glTF's type, or 0 where there is no such type.
std::uint64_t componentBytes(std::uint32_t componentType);

LIMN_API std::vector<std::byte> encodeDracoRequest(std::span<const DracoMesh> meshes);
/// Returns the meshes of a request, whose bytes they point to. Throws Error unless it is whole.
LIMN_API std::vector<DracoMesh> decodeDracoRequest(std::span<const std::byte> request);

LIMN_API std::vector<std::byte> encodeDracoAnswer(std::span<const std::byte> arrays);
/// Returns the message that mesh `mesh` of the request cannot be read.
LIMN_API std::vector<std::byte> encodeDracoRefusal(std::size_t mesh, std::string_view reason);

/// Returns the size in bytes of the largest message that answers a request for these meshes.
std::uint64_t largestDracoMessage(std::span<const DracoMesh> meshes);

/// Holds the arrays of all meshes, or why one is refused.
struct DracoAnswer {
  std::span<const std::byte> arrays;
  std::size_t refused = 0;
  std::string reason;  ///< empty: none is refused
};
/// Returns what a message says, which points into it. Throws Error where it is no answer to the request.
LIMN_API DracoAnswer decodeDracoAnswer(std::span<const std::byte> message, std::span<const DracoMesh> meshes);

}  // namespace limn::scene
