// Says how much a reading program may say of why it refuses a file.
#pragma once

#include <cstddef>

namespace limn::scene {

inline constexpr std::size_t kMostReasonBytes = 4096;

}  // namespace limn::scene
