// Internal to directional trees: what ends those that take too much memory.
#pragma once

#include <cstdint>

namespace limn::radiosity {

/// Throws UsageError: trees take more than the `bytes` allowed.
[[noreturn]] void refuseTrees(uint64_t bytes);

}  // namespace limn::radiosity
