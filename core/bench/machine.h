// Names the machine that rows are measured on.
#pragma once

#include <string>

#include "core/base/export.h"

namespace limn::bench {

/// Returns processor, hardware threads and operating system: "AMD EPYC 7B13, 2 threads, Linux x86_64". The
/// text names neither the host nor its user.
LIMN_API std::string machineName();

}  // namespace limn::bench
