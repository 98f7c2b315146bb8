// Writes tables and pictures as Markdown; whatever their cells hold is escaped (core/bench/markdown_text.h).
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/base/export.h"
#include "core/bench/markdown_text.h"

namespace limn::bench {

/// Returns the text of which markdownText() made `markdown`, but for what that replaced by another character.
LIMN_API std::string textOfMarkdown(std::string_view markdown);

enum class Align { left, right, centre };

struct MarkdownHead {
  std::string text;  ///< Markdown, written unchanged
  Align align = Align::right;
};

/// Returns the two lines that begin a table: its heads, and the alignment of its columns.
LIMN_API std::string markdownHead(const std::vector<MarkdownHead>& heads);

/// Returns a line of a table, each cell as markdownText(): "| a | b |\n".
LIMN_API std::string markdownRow(const std::vector<std::string>& cells);

/// Declares a column of a table with one line for each result: its head and its cells.
template <class Result>
struct MarkdownColumn {
  MarkdownHead head;
  std::function<std::string(const Result&)> cell;
};

/// Returns the lines that begin a table of these columns.
template <class Result>
std::string markdownHead(const std::vector<MarkdownColumn<Result>>& columns) {
  std::vector<MarkdownHead> heads;
  heads.reserve(columns.size());
  for (const MarkdownColumn<Result>& column : columns) heads.push_back(column.head);
  return markdownHead(heads);
}

/// Returns the line of a table of these columns for one result.
template <class Result>
std::string markdownRow(const std::vector<MarkdownColumn<Result>>& columns, const Result& result) {
  std::vector<std::string> cells;
  cells.reserve(columns.size());
  for (const MarkdownColumn<Result>& column : columns) cells.push_back(column.cell(result));
  return markdownRow(cells);
}

/// Returns the table of these columns with a line for each result.
template <class Result>
std::string markdownTable(const std::vector<MarkdownColumn<Result>>& columns,
                          std::span<const std::type_identity_t<Result>> results) {
  std::string text = markdownHead(columns);
  for (const Result& result : results) text += markdownRow(columns, result);
  return text;
}

/// Returns a picture without alternative text, "![](file)"; "" where the path is absolute or leaves the
/// folder that it is relative to.
LIMN_API std::string markdownPicture(const std::string& file);

}  // namespace limn::bench
