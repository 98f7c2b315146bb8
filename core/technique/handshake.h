// Declares what core and a plug-in compare before the plug-in is used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/export.h"
#include "core/technique/abi.h"

namespace limn {

/// Increases whenever Handshake or TechniquePlugin changes.
constexpr uint32_t kTechniqueInterfaceNumber = 3;

/// Describes one side of the interface. Only the number may be read before it is known to be equal, so it
/// stays the first member.
struct Handshake {
  uint32_t interfaceNumber;
  char compiler[64];
  char headers[33];  ///< hash of all headers and shared GLSL that the side was compiled from
  char abi[640];     ///< kTechniqueAbi
};

/// Copies `text`, truncated if necessary, into zeroed `room`.
template <size_t size>
constexpr void copyText(char (&room)[size], std::string_view text) {
  text.substr(0, size - 1).copy(room, size - 1);
}

/// Returns the handshake of the side that is being compiled. `headers` is the hash that limn_interface_hash()
/// (cmake/LimnTechnique.cmake) compiled into it.
inline Handshake handshake(std::string_view headers) {
  static_assert(sizeof kTechniqueAbi <= sizeof Handshake::abi);
  Handshake side{kTechniqueInterfaceNumber, {}, {}, {}};
  copyText(side.compiler, __VERSION__);
  copyText(side.headers, headers);
  copyText(side.abi, kTechniqueAbi);
  return side;
}

/// Returns the hash of the headers that liblimn was compiled from.
LIMN_API const char* interfaceHash();

/// Returns every difference between a plug-in and this limn in words, "it ..., limn ...; ..."; empty when
/// they match.
LIMN_API std::string mismatch(const Handshake& plugin, const Handshake& limn);

}  // namespace limn
