// Declares how limn runs its helper programs, which do work that may crash, hang or grow without bound, each
// in a process of its own.
//
// Such a program is started by core/base/spawn.h: it inherits no thread, no lock and no file except the three
// standard ones. It limits itself before it reads its input, and answers on its standard output.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// Returns the folder from which the library liblimn was loaded.
LIMN_API std::filesystem::path libraryFolder();

struct HelperLimits {
  std::chrono::milliseconds time{60'000};  ///< wall-clock time, from the start to the end of the answer
  std::uint64_t answerBytes = 0;
};

/// Holds the answer of a helper program. The answer is untrusted: the input may have taken over the program.
struct HelperAnswer {
  std::vector<std::byte> bytes;
  std::string failure;  ///< how it failed, "it crashed: Segmentation fault"; empty after exit status 0
};

/// Runs the program `name` from the folder limn/ beside liblimn, waits for it and returns its answer. Its
/// standard input is a file in memory that holds `input`. An interrupt from the keyboard does not reach the
/// program. Throws Error if it cannot be started.
LIMN_API HelperAnswer runHelper(const std::string& name, const std::vector<std::string>& arguments,
                                const HelperLimits& limits, std::span<const std::byte> input = {});

}  // namespace limn
