// Names requests by hashes of everything that determines the picture.
#pragma once

#include <string>

#include "core/reference/reference.h"

namespace limn::reference {

/// Returns a hash like contentHash, but without the number of samples and the noise target: a request that
/// wants more of the same work may continue unfinished work.
std::string workHash(const Request& request);

}  // namespace limn::reference
