// Writes index.html: the rows as a page for people, error against run time. The page itself (HTML, CSS and
// JavaScript) lies in benchmarks/report/ and is compiled in; this file declares only the data that it is
// given.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/base/export.h"
#include "core/bench/row.h"

namespace limn::bench {

/// Returns what the page shows, as JSON that is safe inside a script element whatever the rows contain:
/// tables as makeTables() groups them, the pictures of report_pictures.h, and what `limn stress` left in the
/// folder. Throws Error if that cannot be read.
LIMN_API std::string reportData(std::span<const Row> rows, const std::filesystem::path& folder);

/// Writes index.html into `folder`, where the rows' pictures are found: one file that loads no other.
LIMN_API void writeReport(std::span<const Row> rows, const std::filesystem::path& folder);

}  // namespace limn::bench
