// Declares what a process needs that reads untrusted input with a library that may fail in any way: limits,
// and a way to answer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

/// Limits this process to `memory` bytes of address space and `seconds` of processor and wall-clock time,
/// lets it write no file and leave no core dump, and makes it end together with its parent process. Returns
/// false when the system does not grant that.
bool confine(std::uint64_t memory, unsigned seconds);

/// Writes bytes to standard output. Returns false where they could not be written whole.
bool writeAnswer(std::span<const std::byte> bytes);

}  // namespace limn
