// The flags of a SceneQuestion: one for each field of its table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/question/question_fields.h"

namespace limn::app {
namespace {

CLI::Option* addSize(CLI::App& command, SceneQuestion& question, const std::string& flag, const char* help,
                     QuestionSizeMember member) {
  const auto set = [&question, member, flag](const std::string& text) {
    const auto size = parsePictureSize(text);
    if (!size)
      throw UsageError(
          fmt::format("{} '{}' is not accepted; expected WxH, each from 1 to 16384 pixels", flag, text));
    std::tie(question.*member.width, question.*member.height) = *size;
  };
  return command.add_option_function<std::string>(flag, set, help)
      ->default_str(fmt::format("{}x{}", question.*member.width, question.*member.height));
}

/// Returns what the field says of itself, and of each choice.
std::string helpOf(const QuestionField& field) {
  std::string help = *field.unit ? fmt::format("{}, {}", field.doc, field.unit) : field.doc;
  for (size_t i = 0; i < field.choiceDocs.size(); ++i)
    help += fmt::format("\n{}: {}", field.choices[i], field.choiceDocs[i]);
  return help;
}

CLI::Validator oneOf(const QuestionField& field) {
  const auto problem = [&field](const std::string& text) {
    return std::ranges::find(field.choices, text) == field.choices.end() ? unknownChoice(field, text)
                                                                         : std::string();
  };
  return {problem, fmt::format("{{{}}}", fmt::join(field.choices, ",")), ""};
}

}  // namespace

CLI::Validator realRange(double low, double high) {
  const auto problem = [low, high](const std::string& text) {
    const std::optional<double> value = parseNumber(text);
    return value && *value >= low && *value <= high
               ? std::string()
               : fmt::format("Value {} not in range {} to {}", text, low, high);
  };
  return {problem, fmt::format("FLOAT in [{:g} - {:g}]", low, high)};
}

CLI::Validator wholeRange(int low, int high) {
  const auto problem = [low, high](std::string& text) {
    const std::optional<double> value = parseNumber(text);
    if (!value || *value != std::floor(*value) || *value < low || *value > high)
      return fmt::format("Value {} not in range {} to {}", text, low, high);
    text = fmt::format("{:.0f}", *value);
    return std::string();
  };
  return {problem, fmt::format("INT in [{} - {}]", low, high)};
}

void takeOneEach(CLI::Option* option) {
  option->take_all()->allow_extra_args(false);
}

CLI::Option* addSceneFlag(CLI::App& command, SceneQuestion& question, std::string_view key,
                          const std::string& chosenFlag) {
  const QuestionField& field = questionField(key);
  std::string flag = chosenFlag.empty() ? field.flag : chosenFlag;
  if (*field.otherFlag != 0) flag += std::string(",") + (flag == field.flag ? field.otherFlag : field.flag);
  const std::string help = helpOf(field);
  const auto add = [&](auto member) -> CLI::Option* {
    if constexpr (std::is_same_v<decltype(member), QuestionSizeMember>)
      return addSize(command, question, flag, help.c_str(), member);
    else
      return command.add_option(flag, question.*member, help);
  };
  CLI::Option* option = std::visit(add, field.member);
  switch (field.kind) {
    case QuestionKind::real:
    case QuestionKind::optionalReal:
      option->check(realRange(field.range.low, field.range.high));
      // A value out of the range stands for one that is not given: there is no default to show.
      if (const auto* member = std::get_if<double SceneQuestion::*>(&field.member);
          member && question.**member >= field.range.low && question.**member <= field.range.high)
        option->capture_default_str();
      break;
    case QuestionKind::integer:
      option->transform(wholeRange(static_cast<int>(field.range.low), static_cast<int>(field.range.high)));
      option->capture_default_str();
      break;
    case QuestionKind::choice:
      option->check(oneOf(field));
      option->capture_default_str();
      break;
    case QuestionKind::texts:
      takeOneEach(option);
      break;
    case QuestionKind::text:
    case QuestionKind::coefficient:
    case QuestionKind::size:
      break;
  }
  if (!flag.starts_with('-')) option->required();
  return option;
}

void addSceneFlags(CLI::App& command, SceneQuestion& question) {
  for (const QuestionField& field : questionFields())
    if (field.key != std::string_view("term")) addSceneFlag(command, question, field.key);
}

}  // namespace limn::app
