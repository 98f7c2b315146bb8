// limn view: the window, which is a program of its own so that this one needs no display library.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "core/base/error.h"

namespace limn::app {
namespace {

int run(const CLI::App& command) {
  const std::string program = programBeside("limn-view").string();
  std::vector<std::string> arguments = command.remaining();
  std::vector<char*> pointers{const_cast<char*>(program.c_str())};
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  execv(program.c_str(), pointers.data());
  throw Error(fmt::format("{} cannot be started: {}", program, std::strerror(errno)));
}

}  // namespace

Action addViewCommand(CLI::App& command) {
  command.prefix_command();
  command.set_help_flag();  // limn-view's own
  return [&command] { return run(command); };
}

}  // namespace limn::app
