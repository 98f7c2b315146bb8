// Puts the results of several folders into one.
#pragma once

#include <filesystem>
#include <functional>
#include <span>

#include "core/base/export.h"
#include "core/bench/row.h"

namespace limn::bench {

/// Appends the rows of the folders `from`, one after the other, to those of `into`, with their references and
/// pictures, and returns how many. Where `into` has a row of its key, a row replaces it only if it was
/// measured with what `provenance` gives for the case now and that row was not; if both or neither were, a
/// good row replaces a failed one, and a good one of more turns a good one of the same provenance. Rows of
/// `into` that are valid now are written once more behind others that were appended after them (Row::line).
/// `provenance` may be empty: every row then counts as valid. Throws Error when a file cannot be read or
/// written; what was appended before stays and is whole.
LIMN_API int mergeResults(std::span<const std::filesystem::path> from, const std::filesystem::path& into,
                          const std::function<Provenance(const Case&)>& provenance);

}  // namespace limn::bench
