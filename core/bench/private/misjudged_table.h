// Declares the kinds of misjudged pixels as data, as kMetrics declares the metrics.
#pragma once

#include <cstddef>

#include "core/bench/row.h"

namespace limn::bench {

struct MisjudgedInfo {
  const char *key, *wholeKey;  ///< in JSON and CSV: the pixels that are wrong, and all that could be
  const char* label;           ///< for people: the share of the first in the second
  const char* head;            ///< of a narrow column
  std::size_t Misjudged::*part;
  std::size_t Misjudged::*whole;
  const char *help, *wholeHelp;
};

inline constexpr MisjudgedInfo kMisjudged[] = {
    {"lit_in_umbra", "umbra", "lit in the umbra", "lit in umbra %", &Misjudged::litInUmbra, &Misjudged::umbra,
     "pixels of the umbra with a visibility above 0.1 (light leaks)",
     "pixels whose reference visibility is below 0.02"},
    {"dark_in_light", "lit", "dark in full light", "dark in light %", &Misjudged::darkInLight,
     &Misjudged::lit, "fully lit pixels with a visibility below 0.9",
     "pixels whose reference visibility is above 0.98"},
};

}  // namespace limn::bench
