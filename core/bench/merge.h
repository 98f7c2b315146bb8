// Puts the results of several folders into one.
#pragma once

#include <filesystem>

#include "core/base/export.h"

namespace limn::bench {

/// Appends the rows of the folder `from` to those of `into`, with their references and pictures, and returns
/// how many. A row is left where `into` has a good one of its key, or any where it failed itself. Throws
/// Error when a file cannot be read or written; what was appended before stays and is whole.
LIMN_API int mergeResults(const std::filesystem::path& from, const std::filesystem::path& into);

}  // namespace limn::bench
