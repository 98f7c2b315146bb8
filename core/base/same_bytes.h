// Compares what is about to be uploaded with what was.
#pragma once

#include <cstring>
#include <type_traits>
#include <vector>

namespace limn {

/// Returns whether both hold as many values with the same bytes, so that -0 differs from 0, and NaN does not
/// from itself.
template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  static_assert(std::is_trivially_copyable_v<T>);
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace limn
