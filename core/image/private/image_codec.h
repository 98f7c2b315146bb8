// Declares what reading and writing picture files by codecs share.
#pragma once

#include <fmt/format.h>

#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"

namespace limn {

/// Begins the names of what limn says of a picture in its file.
inline constexpr const char* kMetadataPrefix = "limn/";

/// Returns what a codec says of its failure, in one line.
inline std::string reasonOf(std::string_view failure) {
  const std::string line = oneLine(failure);
  return line.empty() ? "unreadable or truncated" : line;
}

/// Runs a step of a codec; whatever it throws becomes an Error of one line that names the picture.
template <class Step>
auto guarded(const std::string& name, Step step) {
  try {
    return step();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(fmt::format("{}: not enough memory", name));
  } catch (const std::exception& failure) {
    throw Error(fmt::format("{}: {}", name, reasonOf(failure.what())));
  }
}

}  // namespace limn
