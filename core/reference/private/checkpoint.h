// Keeps the state of unfinished work on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/reference/private/integrator.h"

namespace limn::reference {

/// Holds the sums over all samples so far, in two halves with independent random numbers: the difference of
/// the halves gives the noise.
struct Accumulators {
  uint32_t samples = 0;    ///< per pixel and half
  std::vector<Sums> sums;  ///< 2 * pixel + half
};

/// Writes the state to a file beside `file` and renames it. `hash` names the request (32 digits).
void saveCheckpoint(const std::filesystem::path& file, const std::string& hash, const Accumulators& state);

/// Reads a checkpoint into `state`. Returns true if the file is complete, belongs to that request, and fits
/// `state.sums` in size; only then does `state` hold what was read.
bool loadCheckpoint(const std::filesystem::path& file, const std::string& hash, Accumulators& state);

}  // namespace limn::reference
