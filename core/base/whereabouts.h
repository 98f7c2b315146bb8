// What the program is in the middle of, for the line it leaves behind when it crashes.
#pragma once

#include <cstddef>

#include "core/base/export.h"

namespace limn {

/// While one lives, the program is said to be in pass `pass` of `technique`, or, where `pass` is null,
/// elsewhere in the technique. The innermost one counts. For the thread that talks to OpenGL: one at a time.
/// The texts outlive it.
class LIMN_API Whereabouts {
 public:
  Whereabouts(const char* technique, const char* pass);
  ~Whereabouts();
  Whereabouts(const Whereabouts&) = delete;
  Whereabouts& operator=(const Whereabouts&) = delete;

 private:
  const char* formerTechnique_;
  const char* formerPass_;
};

/// Writes "Segmentation fault" for signal SIGSEGV, and ", in pass P of T" or ", in technique T" where that is
/// known, to `to`
/// (`size` > 0 bytes; ends in a NUL). Signal handlers may call it.
LIMN_API void describeCrash(int signal, char* to, std::size_t size) noexcept;

/// From now on a crash (SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL) writes "PROGRAM: crashed: ..." to what is
/// stderr now, before it ends the process as ever. Handlers of others (sanitizers, debuggers) stay. `program`
/// is a literal.
LIMN_API void leaveWordsAtCrash(const char* program);

/// The same with the line written into `to` (`size` > 0 bytes, which stay) instead.
LIMN_API void leaveWordsAtCrash(char* to, std::size_t size);

}  // namespace limn
