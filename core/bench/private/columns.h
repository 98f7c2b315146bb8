// Declares the columns of the tables once: CSV, Markdown, the heads of the report page and docs/bench.md
// follow this list.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/export.h"
#include "core/bench/private/markdown.h"
#include "core/bench/tables.h"

namespace limn::bench {

using Cell = std::function<std::string(const Row&, const Table&)>;

struct Column {
  std::string csv;       ///< head in CSV; "": not there
  std::string markdown;  ///< head in Markdown and on the page; "": not there
  std::string help;      ///< a phrase
  Cell exact = {};       ///< the text in CSV, in full precision; set where `csv` is
  Cell shown = {};       ///< the text in Markdown; set where `markdown` is
  Align align = Align::right;
  bool failed = false;                  ///< failed rows have it too: it does not come from a picture
  bool (*known)(const Row&) = nullptr;  ///< in Markdown only where it is true of a row; null: always
};

/// Declares how a quantity is written that is a column of several tables.
struct Quantity {
  const char* head;
  const char* format;  ///< of fmt
  double unit = 1;     ///< what the head's unit is in the unit of stored values
};
inline constexpr Quantity kFrameTime{"median ms", "{:.3f}"};
inline constexpr Quantity kMemory{"MiB", "{:.1f}", 1 << 20};
/// Returns a stored value, such as a number of bytes, in the unit and to the digits of the quantity.
LIMN_API std::string shownText(const Quantity& quantity, double stored);

/// Returns the head of the column with that key in CSV: as people read it, or the key where only CSV has the
/// column. Asking for another key is a bug and throws std::logic_error.
LIMN_API std::string headOf(std::string_view csv);

/// Returns the columns in the order of the tables; the Markdown tables show some of them, in the same order.
LIMN_API std::span<const Column> columns();

}  // namespace limn::bench
