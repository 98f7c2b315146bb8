// Declares how text is quoted as a word for a POSIX shell.
#pragma once

#include <string>
#include <string_view>

#include "core/base/export.h"

namespace limn {

/// Returns the word that a shell reads as `text`: unchanged where it contains no special characters,
/// otherwise quoted. The result is always printable ASCII on one line: other bytes, including line breaks and
/// control characters, are written as octal escapes in $'...' (POSIX.1-2024; bash, zsh, ksh), so that no name
/// can look like another command.
LIMN_API std::string shellQuoted(std::string_view text);

}  // namespace limn
