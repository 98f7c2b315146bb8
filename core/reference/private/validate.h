// Checks requests, before anything is traced.
#pragma once

#include "core/reference/reference.h"

namespace limn::reference {

/// Throws UsageError unless the term accepts what the request asks of its light: samples, bounces, paths,
/// models, interfaces and lights. Camera and picture are left to render().
void checkLight(const Request& request);

}  // namespace limn::reference
