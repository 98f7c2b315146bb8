// The machine that rows are measured on.
#pragma once

#include <string>

#include "core/base/export.h"

namespace limn::bench {

/// Processor, hardware threads, operating system: "AMD EPYC 7B13, 2 threads, Linux x86_64". No name of
/// the host or its user.
LIMN_API std::string machineName();

}  // namespace limn::bench
