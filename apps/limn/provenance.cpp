#include "apps/limn/provenance.h"

#include <fstream>

#include "core/base/shell.h"
#include "core/image/signature.h"

namespace limn::app {

std::string commandLine() {
  std::ifstream arguments("/proc/self/cmdline", std::ios::binary);
  std::string line = "limn", argument;
  std::getline(arguments, argument, '\0');  // where the program lies
  while (std::getline(arguments, argument, '\0')) line += " " + shellQuoted(argument);
  return line;
}

void sign(Image& picture) {
  limn::sign(picture, commandLine());
}

}  // namespace limn::app
