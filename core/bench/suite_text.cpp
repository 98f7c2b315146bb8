#include "core/bench/suite_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "core/question/question_fields.h"
#include "core/question/technique_names.h"

namespace limn::bench {
namespace {

/// The field's value as a suite has it.
std::string tomlValue(const QuestionField& field, const SceneQuestion& question) {
  std::vector<std::string> values = printed(field, question);
  switch (field.kind) {
    case QuestionKind::real:
    case QuestionKind::optionalReal:
    case QuestionKind::integer:
      return values.front();
    case QuestionKind::text:
    case QuestionKind::choice:
    case QuestionKind::coefficient:
    case QuestionKind::size:
      return tomlText(values.front());
    case QuestionKind::texts:
      break;
  }
  for (std::string& value : values) value = tomlText(value);
  return fmt::format("[{}]", fmt::join(values, ", "));
}

}  // namespace

std::string tomlText(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      result += c;
  }
  return result + "\"";
}

std::string subjectToml(const SceneQuestion& question) {
  return fmt::format("sizes = [{}]\nterm = {}\n", tomlValue(questionField("size"), question),
                     tomlText(question.term));
}

std::string sceneToml(const SceneQuestion& question) {
  std::string text = "[[scenes]]\n";
  for (const QuestionField& field : questionFields())
    if (!isDefault(field, question) && field.kind != QuestionKind::size &&
        field.key != std::string_view("term"))
      text += fmt::format("{} = {}\n", keyInSuite(field), tomlValue(field, question));
  return text;
}

std::string techniqueToml(const std::string& technique,
                          std::span<const std::pair<std::string, std::string>> parameters) {
  std::string text = fmt::format("[[techniques]]\ntechnique = {}\n", tomlText(technique));
  std::vector<std::string> values;
  for (const auto& [name, value] : parameters) {
    const std::string key(shortParameter(technique, name));
    values.push_back(fmt::format("{} = [{}]", key == name ? tomlText(name) : key, tomlText(value)));
  }
  if (!values.empty()) text += fmt::format("parameters = {{{}}}\n", fmt::join(values, ", "));
  return text;
}

}  // namespace limn::bench
