#include "apps/limn/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace limn::app {
namespace {

/// The values that an option's help lists in braces; empty where it takes anything else.
std::vector<std::string> choicesOf(const CLI::Option& option) {
  const std::string shown = option.get_type_name();
  const size_t open = shown.find('{'), close = shown.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(shown.substr(open + 1, close - open - 1), ',');
}

/// A command's words and the choices of its options, with those of its own commands.
struct OptionTable {
  std::vector<std::string> words;
  std::string choices;  ///< branches of a case over the word before

  void add(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
      std::vector<std::string> names;
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      for (const std::string& name : option->get_snames()) names.push_back("-" + name);
      if (names.empty()) continue;
      words.insert(words.end(), names.begin(), names.end());
      if (const auto values = choicesOf(*option); !values.empty())
        choices += fmt::format("        {}) values='{}' ;;\n", fmt::join(names, "|"), fmt::join(values, " "));
    }
    for (const CLI::App* part : command.get_subcommands({})) {
      words.push_back(part->get_name());
      add(*part);
    }
  }
};

}  // namespace

std::string bashCompletion(const CLI::App& program) {
  std::vector<std::string> commands;
  std::string branches;
  for (const CLI::App* command : program.get_subcommands({})) {
    commands.push_back(command->get_name());
    OptionTable table;
    table.add(*command);
    branches += fmt::format("    {})\n      words='{}'\n      case $before in\n{}      esac ;;\n",
                            command->get_name(), fmt::join(table.words, " "), table.choices);
  }
  return fmt::format(R"(# Completes the command line of {0} in bash, from its own tables.
_{0}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words='' values=''
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W '{1} --help --version' -- "$word")
    return
  fi
  case ${{COMP_WORDS[1]}} in
{2}  esac
  if [ -n "$values" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word"; compgen -f -- "$word")
  fi
}}
complete -o filenames -F _{0} {0}
)",
                     program.get_name(), fmt::join(commands, " "), branches);
}

}  // namespace limn::app
