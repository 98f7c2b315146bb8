// Limits the memory of a test, so that what takes too much of it fails there and not on the machine that runs
// it.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace limn::test {

/// A limit of addresses that is in force while it lives, above those that are in use. Sanitized programs,
/// whose shadow memory takes terabytes of addresses, cannot have one.
class AddressLimit {
 public:
  explicit AddressLimit(rlim_t more) {
    getrlimit(RLIMIT_AS, &before_);
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + more, before_.rlim_max};
    setrlimit(RLIMIT_AS, &limit);
  }
  ~AddressLimit() { setrlimit(RLIMIT_AS, &before_); }
  AddressLimit(const AddressLimit&) = delete;
  AddressLimit& operator=(const AddressLimit&) = delete;

 private:
  rlimit before_{};
};

}  // namespace limn::test
