// Programs that come with limn for work that may crash, hang or grow without bound: each runs in a process of
// its own.
//
// Such a program is started by posix_spawn, not by fork alone: a process with threads and OpenGL contexts may
// do next to nothing between fork and exec, and nothing at all without exec. It inherits no thread, no lock
// and no file but the three standard ones; it limits itself before it touches its input, and answers on its
// standard output.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// The folder that the library liblimn was loaded from.
LIMN_API std::filesystem::path libraryFolder();

struct HelperLimits {
  std::chrono::milliseconds time{60'000};  ///< on the clock, from the start to the end of the answer
  std::uint64_t answerBytes = 0;
};

/// What a helper program answered. Whatever it says is untrusted: its input may have taken it over.
struct HelperAnswer {
  std::vector<std::byte> bytes;
  std::string failure;  ///< how it failed, "it crashed: Segmentation fault"; empty: it ended with status 0
};

/// Runs the program `name` from the folder limn/ beside liblimn and waits for it. An interruption from the
/// keyboard does not reach it. Throws Error if it cannot be started.
LIMN_API HelperAnswer runHelper(const std::string& name, const std::vector<std::string>& arguments,
                                const HelperLimits& limits);

}  // namespace limn
