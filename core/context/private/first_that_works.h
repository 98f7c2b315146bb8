// Declares how a back end chooses among devices that it has not been told.
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace limn {

/// Returns what `make` makes of the first candidate that works; the others are not tried. A candidate that is
/// not there gives an empty result, one that does not suffice an Error. When none works, throws the error of
/// the first that does not suffice, or returns an empty result when none is there. `passOver` is told each
/// candidate that does not work, with its error, or with nothing where it is not there.
template <class Candidate, class Make, class PassOver>
auto firstThatWorks(const std::vector<Candidate>& candidates, const Make& make, const PassOver& passOver)
    -> decltype(make(candidates.front())) {
  std::exception_ptr first;
  for (const Candidate& candidate : candidates) {
    try {
      if (auto made = make(candidate)) return made;
      passOver(candidate, std::string());
    } catch (const Error& error) {
      if (!first) first = std::current_exception();
      passOver(candidate, std::string(error.what()));
    }
  }
  if (first) std::rethrow_exception(first);
  return {};
}

}  // namespace limn
