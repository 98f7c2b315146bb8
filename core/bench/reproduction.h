// What the thesis found, as ratios between techniques, beside what is measured here. Ratios only: its frame
// rates come from another machine and another decade.
//
// Claims are read from TOML:
//
//     [[claims]]
//     where = "7.4, table 7.3"            # section, table or figure
//     what = "VSSM against PCSS"
//     # frame or shadows: slow / fast in time; memory: slow / fast in bytes
//     measure = "frame"
//     thesis = 14.8                       # times as fast (or small)
//     suite = "ch7_512"                   # what measures it
//     # Parts of the row's label; $: there the label ends.
//     slow = ["light size 2.7/balls", "/pcss?", "blocker_samples=1024"]
//     fast = ["light size 2.7/balls", "/vssm?vssm.shadow_map_size=512$"]
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"
#include "core/bench/row.h"

namespace limn::bench {

enum class ClaimMeasure { frame, shadows, memory };

struct Claim {
  std::string where, what;
  ClaimMeasure measure = ClaimMeasure::frame;
  double thesis = 0;  ///< ratio
  std::string suite;
  std::vector<std::string> slow, fast;  ///< parts of the row's label
};

/// Throws UsageError naming file, line and column.
LIMN_API std::vector<Claim> parseClaims(std::string_view toml, const std::string& fileName);
LIMN_API std::vector<Claim> readClaims(const std::filesystem::path& path);

/// Markdown: a table per chapter (the part of `where` before the first dot), with the ratio measured, its
/// interval where the single times are known, and the command that measures it. A claim without its two rows
/// is "not measured"; several rows that fit are an Error naming them, since nobody could say which was meant.
LIMN_API std::string reproductionMarkdown(std::span<const Claim> claims, std::span<const Row> rows);

}  // namespace limn::bench
