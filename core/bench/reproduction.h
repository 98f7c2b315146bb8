// Compares what the thesis found, as ratios between techniques, with what is measured here. Only ratios are
// compared, since the thesis's frame rates come from another machine and another decade.
//
// Claims are read from TOML:
//
//     title = "What the thesis found, and what is measured here"   # of the page
//     preface = ["What readers should know,", "in lines of Markdown."]   # below it; both may be missing
//
//     [[claims]]
//     where = "7.6, figure 7.7"           # section, table or figure
//     what = "VSSM against PCSS"
//     measure = "frame"                   # slow / fast in time; memory: slow / fast in bytes
//     thesis = 14.8                       # times as fast (or small)
//     suite = "ch7_512"                   # what measures it
//     # Parts of the row's label; ^ marks the label's beginning, $ its end.
//     slow = ["light size 2.7/balls", "/pcss?", "blocker_samples=1024"]
//     fast = ["light size 2.7/balls", "/vssm?vssm.shadow_map_size=512$"]
//
// What the thesis shows and limn does not compare stands beside them with the reason:
//
//     [[claims]]
//     where = "6.4, figure 6.7"
//     what = "Clusters of the frame before against clusters from the same start"
//     because = "clusters always begin from the same start"
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"
#include "core/bench/row.h"

namespace limn::bench {

enum class ClaimMeasure : std::uint8_t { frame, memory };

struct Claim {
  std::string where, what;
  ClaimMeasure measure = ClaimMeasure::frame;
  double thesis = 0;  ///< ratio; 0 where a claim that is not reproduced has none
  std::string suite;
  std::vector<std::string> slow, fast;  ///< parts of the row's label
  std::string because = {};  ///< not empty: why it is not reproduced; there are then no suite and no rows
};

/// Holds the claims of a file, and what stands above them on a page.
struct Claims {
  std::string title, preface;  ///< of one line; Markdown of any number
  std::vector<Claim> all;
};

/// Reads claims from TOML. Throws UsageError that names file, line and column.
LIMN_API Claims parseClaims(std::string_view toml, const std::string& fileName);
LIMN_API Claims readClaims(const std::filesystem::path& path);

/// Returns Markdown: how to read it, with the rule of each verdict; a table per chapter (the part of `where`
/// before the first dot) with the ratio measured at the suite's settings, the number of turns behind it and
/// its interval, the errors of both sides, what they differ in, the ratio at equal error, the verdict, and
/// where it was measured; the commands of the suites that answer a claim here, and of those that do not. A
/// claim without its two rows, of one renderer and one machine, is "not measured"; of several such, the
/// newest count (Row::line). Throws Error naming the rows when rows of several labels fit, since the claim is
/// then ambiguous.
LIMN_API std::string reproductionMarkdown(std::span<const Claim> claims, std::span<const Row> rows);

}  // namespace limn::bench
