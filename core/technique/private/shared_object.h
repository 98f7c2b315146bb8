// Declares the check whether a file can be passed to the dynamic linker, which trusts what it maps.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "core/base/export.h"

namespace limn {

/// Returns, as a clause ("it is ..."), why these bytes are not a whole ELF shared object for this machine;
/// empty when they are: everything that its program and section headers name lies within the bytes.
LIMN_API std::string sharedObjectProblem(std::span<const std::byte> file);

}  // namespace limn
