// Declares limits for a process that reads untrusted input with a library that may fail in any way.
#pragma once

#include <cstdint>

namespace limn {

/// Limits this process to `memory` bytes of address space and `seconds` of processor and wall-clock time,
/// lets it write no file and leave no core dump, and makes it end together with its parent process. Returns
/// false when the system does not grant that.
bool confine(std::uint64_t memory, unsigned seconds);

}  // namespace limn
