// The state of unfinished work on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/reference/integrator.h"

namespace limn::reference {

/// What all samples so far have added up to. Two halves with independent random numbers: their difference
/// tells the noise.
struct Accumulators {
  uint32_t samples = 0;    ///< per pixel and half
  std::vector<Sums> sums;  ///< 2 * pixel + half
};

/// Writes beside and renames. `hash` names the request (32 digits).
void saveCheckpoint(const std::filesystem::path& file, const std::string& hash, const Accumulators& state);

/// True if the file is whole, is of that request, and fits `state.sums` in size; then `state` is what it
/// holds.
bool loadCheckpoint(const std::filesystem::path& file, const std::string& hash, Accumulators& state);

}  // namespace limn::reference
