// What core and a plug-in compare before a word is exchanged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/export.h"
#include "core/technique/abi.h"

namespace limn {

/// Grows when Handshake or TechniquePlugin changes.
constexpr uint32_t technique_interface_number = 2;

/// Only the number may be read before it is known to be the same; it stays the first member.
struct Handshake {
  uint32_t interfaceNumber;
  char compiler[64];
  char headers[33];  ///< hash of all headers and shared GLSL that the side was compiled from
  char abi[640];     ///< technique_abi
};

/// Copies `text`, shortened if need be, into zeroed `room`.
template <size_t size>
constexpr void copyText(char (&room)[size], std::string_view text) {
  text.substr(0, size - 1).copy(room, size - 1);
}

/// The side that is being compiled. `headers` is what limn_interface_hash() (cmake/LimnTechnique.cmake)
/// compiled into it.
inline Handshake handshake(std::string_view headers) {
  static_assert(sizeof technique_abi <= sizeof Handshake::abi);
  Handshake side{technique_interface_number, {}, {}, {}};
  copyText(side.compiler, __VERSION__);
  copyText(side.headers, headers);
  copyText(side.abi, technique_abi);
  return side;
}

/// The hash of the headers that liblimn was compiled from.
LIMN_API const char* interfaceHash();

/// Every difference between a plug-in and this limn in words, "it ..., limn ...; ..."; empty if they fit.
LIMN_API std::string mismatch(const Handshake& plugin, const Handshake& limn);

}  // namespace limn
