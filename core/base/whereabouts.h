// Records what the program is doing, for the line that it writes when it crashes.
#pragma once

#include <cstddef>

#include "core/base/export.h"

namespace limn {

/// Records, while it lives, that the program is in pass `pass` of `technique`, or elsewhere in the technique
/// where `pass` is null. The innermost object counts. To be used only on the thread that calls OpenGL, one at
/// a time. The texts must outlive the object.
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

/// Writes "Segmentation fault" for signal SIGSEGV (for other signals, their description), followed by ", in
/// pass P of T" or ", in technique T" where that is known, to `to` (`size` > 0 bytes; ends in a NUL). May be
/// called by signal handlers.
LIMN_API void describeCrash(int signal, char* to, std::size_t size) noexcept;

/// Installs handlers with which a crash (SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL) writes "PROGRAM: crashed:
/// ..." to what is stderr at the time of this call, before it ends the process as usual. Keeps handlers that
/// others (sanitizers, debuggers) installed. `program` must be a literal.
LIMN_API void leaveWordsAtCrash(const char* program);

/// Does the same, but writes the line into `to` (`size` > 0 bytes, which must stay valid).
LIMN_API void leaveWordsAtCrash(char* to, std::size_t size);

}  // namespace limn
