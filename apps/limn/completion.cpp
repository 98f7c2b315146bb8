#include "apps/limn/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
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
  explicit OptionTable(const CLI::App& command) { add(command); }

  std::vector<std::string> words;
  std::string choices;  ///< branches of a case over the word before

  /// Sets `words` and `values` in the script.
  std::string script() const {
    return fmt::format("words='{}'\n  case $before in\n{}  esac", fmt::join(words, " "), choices);
  }

 private:
  void add(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_group().empty()) continue;  // not in the help
      std::vector<std::string> names;
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      for (const std::string& name : option->get_snames()) names.push_back("-" + name);
      if (names.empty()) continue;
      words.insert(words.end(), names.begin(), names.end());
      if (const auto values = choicesOf(*option); !values.empty())
        choices += fmt::format("    {}) values='{}' ;;\n", fmt::join(names, "|"), fmt::join(values, " "));
    }
    for (const CLI::App* part : command.get_subcommands({})) {
      words.push_back(part->get_name());
      add(*part);
    }
  }
};

/// The shell function that completes a program.
std::string functionOf(std::string program) {
  std::ranges::replace(program, '-', '_');
  return "_" + program;
}

/// Completes the words behind a command that hands them to a program of its own, as that program does.
std::string handOver(const std::string& program) {
  return fmt::format(R"(type {0} > /dev/null 2>&1 || source <({1} --completion 2> /dev/null)
  COMP_WORDS=({1} "${{COMP_WORDS[@]:2}}")
  COMP_CWORD=$((COMP_CWORD - 1))
  type {0} > /dev/null 2>&1 && {0}
  return)",
                     functionOf(program), program);
}

/// Chooses by the first word among the program's commands.
std::string commandScript(const CLI::App& program) {
  std::vector<std::string> commands;
  std::string branches;
  for (const CLI::App* command : program.get_subcommands({})) {
    commands.push_back(command->get_name());
    branches +=
        fmt::format("  {})\n  {} ;;\n", command->get_name(),
                    command->get_prefix_command() ? handOver(program.get_name() + "-" + command->get_name())
                                                  : OptionTable(*command).script());
  }
  return fmt::format(R"(if [ "$COMP_CWORD" -eq 1 ]; then
    values='{} --help --version'
  else
  case ${{COMP_WORDS[1]}} in
{}  esac
  fi)",
                     fmt::join(commands, " "), branches);
}

}  // namespace

std::string bashCompletion(const CLI::App& program) {
  return fmt::format(
      R"(# Completes the command line of {0} in bash, and in zsh with bashcompinit, from its own tables.
{1}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words='' values='' line
  # Of --option=value bash makes three words.
  if [ "$word" = '=' ]; then word=''; elif [ "$before" = '=' ]; then before=${{COMP_WORDS[COMP_CWORD-2]}}; fi
  COMPREPLY=()
  {2}
  while IFS= read -r line; do COMPREPLY+=("$line"); done < <(
    if [ -n "$values" ]; then compgen -W "$values" -- "$word"; else compgen -W "$words" -- "$word"; compgen -f -- "$word"; fi)
}}
complete -o filenames -F {1} {0}
)",
      program.get_name(), functionOf(program.get_name()),
      program.get_subcommands({}).empty() ? OptionTable(program).script() : commandScript(program));
}

void addCompletionFlag(CLI::App& program) {
  program
      .add_flag_callback("--completion",
                         [&program] {
                           std::fputs(bashCompletion(program).c_str(), stdout);
                           throw CLI::Success();
                         })
      ->group("");
}

}  // namespace limn::app
