// Declares a store of what takes long to make.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <list>
#include <memory>
#include <mutex>
#include <utility>

namespace limn {

/// Keeps what was made for the keys that were asked for last: the last one in any case, and those before it
/// as long as they take no more than `most` bytes together. Threads may ask at once; two that ask for the
/// same new key may both make what belongs to it.
template <class Key, class Result>
class KeptResults {
 public:
  using Bytes = std::size_t (*)(const Result&);

  /// Takes the function that returns the memory of a result.
  KeptResults(std::size_t most, Bytes bytes) : most_(most), bytes_(bytes) {}

  /// Returns what make() returned for an equal key, and asks it where nothing is kept. What it throws is
  /// passed on, and nothing is kept then.
  template <class Make>
  std::shared_ptr<const Result> of(const Key& key, const Make& make) {
    if (auto found = find(key)) return found;
    auto made = std::make_shared<const Result>(make());
    const std::lock_guard lock(mutex_);
    kept_.emplace_front(key, made);
    std::size_t sum = 0;
    const auto dropped = std::find_if(std::next(kept_.begin()), kept_.end(), [&](const Kept& kept) {
      sum += bytes_(*kept.second);
      return sum > most_;
    });
    kept_.erase(dropped, kept_.end());
    return made;
  }

 private:
  using Kept = std::pair<Key, std::shared_ptr<const Result>>;

  std::shared_ptr<const Result> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(kept_, key, &Kept::first);
    if (found == kept_.end()) return nullptr;
    kept_.splice(kept_.begin(), kept_, found);
    return found->second;
  }

  std::size_t most_;
  Bytes bytes_;
  std::mutex mutex_;
  std::list<Kept> kept_;  ///< the one that was asked for last first
};

}  // namespace limn
