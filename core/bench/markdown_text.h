// Writes a text from another source (the name of a scene, a technique or a file, a message) as Markdown.
#pragma once

#include <string>
#include <string_view>

#include "core/base/export.h"

namespace limn::bench {

/// Returns the text escaped so that a reader of GitHub-flavoured Markdown (and CommonMark) sees its
/// characters and nothing else: no cell, markup, link or HTML begins in it. Line breaks and tabs become
/// spaces, other control characters their pictures (U+2400 and on), bytes that are not UTF-8 U+FFFD. GitHub
/// may still turn an e-mail address in the shown text into a link.
LIMN_API std::string markdownText(std::string_view text);

}  // namespace limn::bench
