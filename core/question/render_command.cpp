#include "core/question/render_command.h"

#include "core/base/shell.h"
#include "core/question/question_fields.h"

namespace limn {

std::string commandOption(const char* option, const std::string& value) {
  return value.empty() ? std::string() : std::string(" ") + option + " " + shellQuoted(value);
}

std::vector<std::string> questionFlags(const SceneQuestion& question) {
  std::vector<std::string> flags;
  for (const QuestionField& field : questionFields().subspan(1))
    if (!isDefault(field, question))
      for (const std::string& value : printed(field, question))
        if (!value.empty()) flags.insert(flags.end(), {field.flag, value});
  return flags;
}

std::string renderCommand(const SceneQuestion& question, const std::string& techniques,
                          std::span<const std::pair<std::string, std::string>> settings) {
  std::string line = "limn render " + shellQuoted(question.scene) + commandOption("--technique", techniques);
  for (const auto& [name, value] : settings) line += commandOption("--set", name + "=" + value);
  for (const std::string& word : questionFlags(question)) line += " " + shellQuoted(word);
  return line;
}

}  // namespace limn
