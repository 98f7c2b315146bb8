// Texts from elsewhere (names of scenes, techniques and files, messages of failures) in Markdown.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn::bench {

/// The text so that a reader of GitHub-flavoured Markdown (and CommonMark) sees its characters and nothing
/// else: no cell, markup, link or HTML begins in it. Line breaks and tabs become spaces, other control
/// characters their pictures (U+2400 and on), bytes that are not UTF-8 U+FFFD. An address of electronic mail
/// may still be shown as a link, which GitHub makes of the shown text.
LIMN_API std::string markdownText(std::string_view text);

/// A line of a table, each cell as markdownText(): "| a | b |\n".
LIMN_API std::string markdownRow(const std::vector<std::string>& cells);

/// A picture without a text, "![](file)"; "" where the path is absolute or leaves the folder it is relative
/// to.
LIMN_API std::string markdownPicture(const std::string& file);

}  // namespace limn::bench
