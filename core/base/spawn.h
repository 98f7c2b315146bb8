// Declares how limn starts other programs: by posix_spawn, since a process with threads and OpenGL contexts
// may do almost nothing between fork and exec.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// Holds the file descriptors of a program's standard files; -1: /dev/null.
struct StandardFiles {
  int in = -1, out = -1, err = -1;
};

/// Says whether SIGINT (from the keyboard, too), SIGTERM, SIGHUP and SIGQUIT reach a program.
enum class Interrupts : bool { blocked, reach };

/// Starts a program, which is a path or, without '/', the name of one in the folders of PATH, with these
/// arguments after its name. No shell reads them. The program inherits no other file and handles signals as
/// by default. Returns its process, to be given to awaitProgram() or endProgram(). Throws Error if it cannot
/// be started.
LIMN_API pid_t startProgram(const std::string& program, const std::vector<std::string>& arguments,
                            const StandardFiles& files, Interrupts interrupts = Interrupts::blocked);

/// Holds a program that writes into a pipe.
struct PipedProgram {
  pid_t process = 0;
  int output = -1;  ///< the pipe's other end, to be read and closed; it ends when the program does
};

/// Does what startProgram() does, with a pipe as the standard file `piped`. A program whose pipe was closed
/// ends when it writes (SIGPIPE).
LIMN_API PipedProgram startPiped(const std::string& program, const std::vector<std::string>& arguments,
                                 StandardFiles files, int StandardFiles::*piped,
                                 Interrupts interrupts = Interrupts::blocked);

/// Returns whether startProgram() finds a program of that name in the folders of PATH.
LIMN_API bool programExists(const std::string& name);

struct ProgramOutput {
  std::string text;     ///< what it printed on standard output, without the last line's end
  std::string failure;  ///< as awaitProgram() says it
};

/// Runs a program, as startProgram() does, to its end. What it says on standard error goes to limn's where
/// `talks`, nowhere otherwise. Where `stopped` is given, it is asked several times a second, and the program
/// is ended once it returns true. Throws Error if the program cannot be started.
LIMN_API ProgramOutput programOutput(const std::string& program, const std::vector<std::string>& arguments,
                                     bool talks = false, const std::function<bool()>& stopped = {});

/// Waits until the program has ended and says how it failed: "it ended with status 1", "it crashed:
/// Segmentation fault", "it takes too long" for a program that ended itself by a limit of time. Returns ""
/// after exit status 0.
LIMN_API std::string awaitProgram(pid_t process);

/// Ends the program, if it has not ended, and does what awaitProgram() does.
LIMN_API std::string endProgram(pid_t process);

}  // namespace limn
