// Makes tables of error and time: one per question, renderer, machine, driver and mode, never mixed.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/bench/row.h"

namespace limn::bench {

/// Holds rows that may be compared: same scene, camera, light, term, time, size, mode (dynamic or static),
/// reference, renderer, machine and driver, each setting once. Rows that do not say their machine or driver
/// stand with the question's first that fits.
struct Table {
  std::string title;     ///< for people, with as much as tells it from the others
  std::string fileName;  ///< of the CSV, unique among the tables of one makeTables
  std::vector<Row> rows;
  NewestProvenance newest = {};  ///< of its rows
};

/// Returns what a case's reference was asked for: "against 256 spp", "against 1 % noise or 1024 spp, bounces
/// 2"; bounces and interfaces where its term has them.
LIMN_API std::string referenceText(const Case& c);

/// Returns whether the row was measured with another version of the program, of the scene or of a technique
/// than the table's newest row, or the newest of that technique.
LIMN_API bool isOutdated(const Row& row, const Table& table);

/// Returns the rows as tables, grouped by scene first; failed rows are kept and shown as failed. Of rows of
/// one setting that were measured with several efforts, the newest program's stands there, and of these the
/// good one of several turns, or else of most frames. Row::line says which is newer.
LIMN_API std::vector<Table> makeTables(std::span<const Row> rows);

/// Returns errors, frame time (median, quartiles, number of frames) and memory. Rows on the Pareto front of
/// RMSE and time carry a star; an RMSE below three times the reference's noise is shown as that bound
/// ("<0.001"). The column "reference ms" is referenceTime(). What all rows have alike is said once in a line
/// above them instead of in a column. Outdated rows have a mark that a line below explains.
LIMN_API std::string toMarkdown(const Table& table);
/// Returns all columns in full precision, with a header line (RFC 4180). Texts are written unchanged: a
/// spreadsheet may take one that begins with =, +, - or @ for a formula; import such columns as text.
LIMN_API std::string toCsv(const Table& table);

/// Returns the pictures that were kept, the reference's first, three in a line with error and time below;
/// outdated rows have a mark that a line below explains. Returns "" if there are none.
LIMN_API std::string picturesMarkdown(const Table& table);

/// Writes tables.md, one CSV per table and, where pictures were kept, pictures.md into `folder`. Removes the
/// CSVs that were written for the titles of an earlier tables.md and that no table has any more, and an
/// earlier pictures.md where no row has a picture any more.
LIMN_API void writeTables(std::span<const Row> rows, const std::filesystem::path& folder);

}  // namespace limn::bench
