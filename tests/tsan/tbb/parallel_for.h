// What limn uses of TBB's loops, on threads that ThreadSanitizer sees: Debian's libtbb is built without it,
// so that each task handed from thread to thread would look like a race, and hiding those would hide limn's
// own. Builds with LIMN_SANITIZE=thread find this folder before TBB's.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb {

/// Calls `body(i)` for each i of [first, last) on three threads, in no order, and returns when all have
/// returned. Throws one of the exceptions that they ended with.
template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  std::atomic<Index> next = first;
  std::exception_ptr failure;
  std::mutex mutex;  // of failure
  const auto work = [&] {
    try {
      for (Index i = next++; i < last; i = next++) body(i);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      failure = std::current_exception();
      next = last;
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 0; i < 2; ++i) others.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tbb
