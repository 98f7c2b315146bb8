// Declares how people name techniques in flags, suites and rows: NAME,NAME, where NAME:TERM+TERM is asked for
// these of its terms alone.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// Names a technique and the terms that it is asked for.
struct NamedTechnique {
  std::string_view name;
  /// Holds the parts that stand after a ':', unchecked and at least one; nothing: all that it answers.
  std::optional<std::vector<std::string_view>> terms;
};

/// Returns the techniques that `text` joins by ',', in its order, as views of it; none for an empty text.
LIMN_API std::vector<NamedTechnique> namedTechniques(std::string_view text);

/// Returns the name of a parameter ("technique.parameter") as it is shown beside `techniques`: without the
/// technique where that is the only one.
LIMN_API std::string_view shortParameter(std::string_view techniques, std::string_view parameter);

}  // namespace limn
