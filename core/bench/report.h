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

/// Holds what the page is given.
struct ReportData {
  /// JSON that is safe inside a script element whatever the rows contain: tables as makeTables() groups them,
  /// and what `limn stress` left in the folder.
  std::string json;
  /// HTML elements with the pictures of report_pictures.h, which the JSON names by their positions. They
  /// stand behind the page's script, so that the page is drawn before they are read.
  std::string pictures;
};

/// Returns what the page shows. Throws Error if what `limn stress` left cannot be read.
LIMN_API ReportData reportData(std::span<const Row> rows, const std::filesystem::path& folder);

/// Writes index.html into `folder`, where the rows' pictures are found: one file that loads no other.
LIMN_API void writeReport(std::span<const Row> rows, const std::filesystem::path& folder);

}  // namespace limn::bench
