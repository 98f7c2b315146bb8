// Texts as words of a POSIX shell.
#pragma once

#include <string>
#include <string_view>

#include "core/base/export.h"

namespace limn {

/// The word that a shell reads as `text`: as it is where nothing in it means more, else between quotes. The
/// result is printable ASCII on one line, whatever the text: other bytes, line breaks and control characters
/// among them, are written as octal escapes in $'...' (POSIX.1-2024; bash, zsh, ksh), so that no name can
/// pretend to be another command.
LIMN_API std::string shellQuoted(std::string_view text);

}  // namespace limn
