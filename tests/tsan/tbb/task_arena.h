// A stand-in of TBB's task_arena: see parallel_for.h.
#pragma once

namespace tbb {

/// Runs what it is given on the calling thread; how many threads loops have is parallel_for's.
class task_arena {
 public:
  static constexpr int automatic = -1;
  explicit task_arena(int) {}
  template <class Body>
  auto execute(const Body& body) {
    return body();
  }
};

}  // namespace tbb
