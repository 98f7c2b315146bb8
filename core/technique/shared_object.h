// Whether a file can be handed to the dynamic linker, which trusts what it maps.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "core/base/export.h"

namespace limn {

/// Why these bytes are not a whole ELF shared object for this machine, as a clause ("it is ..."); empty if
/// they are: everything that its program and section headers name lies within the bytes.
LIMN_API std::string sharedObjectProblem(std::span<const std::byte> file);

}  // namespace limn
