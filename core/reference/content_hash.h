// Names for requests: hashes of everything that determines the picture.
#pragma once

#include <string>

#include "core/reference/reference.h"

namespace limn::reference {

/// As contentHash, but without the number of samples and the noise target: unfinished work may be taken up by
/// a request that wants more of it.
std::string workHash(const Request& request);

}  // namespace limn::reference
