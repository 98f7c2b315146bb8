// What core and a plug-in compare before a word is exchanged. Its layout never changes.
#pragma once

#include <cstdint>

#include "core/technique/interface_hash.h"

namespace limn {

constexpr uint32_t technique_interface_number = 1;

struct Handshake {
  uint32_t interfaceNumber;
  char compiler[64];
  char headers[33];  ///< hash of every public header both sides were compiled with
};

constexpr Handshake handshake() {
  Handshake h{technique_interface_number, {}, {}};
  const char* compiler = __VERSION__;
  for (int i = 0; i < 63 && compiler[i] != 0; ++i) h.compiler[i] = compiler[i];
  const char* headers = LIMN_INTERFACE_HASH;
  for (int i = 0; i < 32 && headers[i] != 0; ++i) h.headers[i] = headers[i];
  return h;
}

}  // namespace limn
