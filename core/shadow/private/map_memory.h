// Limits the memory of shadow maps and of what is derived from them.
#pragma once

#include <cstdint>

namespace limn::shadow {

inline constexpr int64_t kMemoryLimit = int64_t{4} << 30;  ///< bytes of all maps of one request
inline constexpr int64_t kKeptLimit =
    int64_t{256} << 20;  ///< bytes of all maps that are kept; what is derived comes on top

}  // namespace limn::shadow
