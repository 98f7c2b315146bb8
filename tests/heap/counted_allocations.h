// Heap allocations of the calling thread; the program they are linked into has its operator new replaced.
#pragma once

#include <cstdint>

namespace limn::test {

/// Counts from construction on.
class CountedAllocations {
 public:
  CountedAllocations();
  ~CountedAllocations();
  CountedAllocations(const CountedAllocations&) = delete;
  CountedAllocations& operator=(const CountedAllocations&) = delete;
  int64_t count() const;
};

}  // namespace limn::test
