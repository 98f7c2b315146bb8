#include "core/technique/handshake.h"

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <vector>

namespace limn {

const char* compiledInterfaceHash();  // from limn_interface_hash() (cmake/LimnTechnique.cmake)

namespace {

/// The text in an array that another program filled.
template <size_t size>
std::string_view textIn(const char (&room)[size]) {
  return {room, strnlen(room, size)};
}

/// The value of a setting; "undefined" where the preprocessor found none.
std::string_view settingIn(std::string_view abi, std::string_view name) {
  while (!abi.empty()) {
    const size_t end = std::min(abi.find(';'), abi.size());
    const std::string_view setting = abi.substr(0, end);
    const size_t equals = setting.find('=');
    if (setting.substr(0, equals) == name && equals != std::string_view::npos) {
      const std::string_view value = setting.substr(equals + 1);
      return value == name ? "undefined" : value;
    }
    abi.remove_prefix(std::min(end + 1, abi.size()));
  }
  return "undefined";
}

std::vector<std::string> differentSettings(std::string_view theirs, std::string_view ours) {
  std::vector<std::string> different;
  for (std::string_view rest = ours; !rest.empty();) {
    const std::string_view name = rest.substr(0, rest.find('='));
    const std::string_view here = settingIn(ours, name), there = settingIn(theirs, name);
    if (here != there) different.push_back(fmt::format("{} is {} in it and {} in limn", name, there, here));
    rest.remove_prefix(std::min(rest.find(';'), rest.size() - 1) + 1);
  }
  return different;
}

}  // namespace

const char* interfaceHash() {
  return compiledInterfaceHash();
}

std::string mismatch(const Handshake& plugin, const Handshake& limn) {
  if (plugin.interfaceNumber != limn.interfaceNumber)
    return fmt::format("it was built for interface {}, limn has interface {}", plugin.interfaceNumber,
                       limn.interfaceNumber);
  std::vector<std::string> differences;
  const auto compare = [&](const char* what, std::string_view theirs, std::string_view ours) {
    if (theirs != ours)
      differences.push_back(fmt::format("it was built {} {}, limn {} {}", what, theirs, what, ours));
  };
  compare("with compiler", textIn(plugin.compiler), textIn(limn.compiler));
  for (std::string& setting : differentSettings(textIn(plugin.abi), textIn(limn.abi)))
    differences.push_back(std::move(setting));
  compare("from headers", textIn(plugin.headers), textIn(limn.headers));
  return fmt::format("{}", fmt::join(differences, "; "));
}

}  // namespace limn
