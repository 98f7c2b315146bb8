// A stand-in of TBB's enumerable_thread_specific: see parallel_for.h.
#pragma once

#include <map>
#include <mutex>
#include <thread>

namespace tbb {

/// A value for each thread that asked for one.
template <class T>
class enumerable_thread_specific {
 public:
  T& local() {
    const std::scoped_lock lock(mutex_);
    return values_[std::this_thread::get_id()];
  }
  /// Calls for the values themselves only when no thread is at work on them.
  auto begin() { return Iterator{values_.begin()}; }
  auto end() { return Iterator{values_.end()}; }

 private:
  using Values = std::map<std::thread::id, T>;
  struct Iterator {
    typename Values::iterator at;
    T& operator*() const { return at->second; }
    Iterator& operator++() {
      ++at;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return at != other.at; }
  };
  std::mutex mutex_;
  Values values_;
};

}  // namespace tbb
