#include "core/bench/private/question_toml.h"

#include <fmt/format.h>

#include <span>

#include "core/question/question_fields.h"

namespace limn::bench {
namespace {

/// A field and the questions that have its values; of each, only that field counts.
struct Sweep {
  const QuestionField* field;
  std::vector<SceneQuestion> values;
};

/// A number, or a text of three.
std::string parseCoefficient(const TomlSection& scene, const QuestionField& field) {
  const toml::node* node = scene.find(field.key);
  if (node == nullptr || node->is_string()) return scene.text(field.key, "");
  return fmt::format("{}", scene.real(field.key, 0, field.range.low, field.range.high));
}

/// Reads the one value that the scene has.
void parseField(const TomlSection& scene, const QuestionField& field, SceneQuestion& question) {
  const auto into = [&](auto member) {
    using Member = decltype(member);
    if constexpr (std::is_same_v<Member, std::string SceneQuestion::*>)
      question.*member = field.kind == QuestionKind::choice        ? scene.choice(field, question.*member)
                         : field.kind == QuestionKind::coefficient ? parseCoefficient(scene, field)
                                                                   : scene.text(field.key, question.*member);
    else if constexpr (std::is_same_v<Member, std::vector<std::string> SceneQuestion::*>)
      question.*member = scene.texts(field.key, {});
    else if constexpr (std::is_same_v<Member, double SceneQuestion::*>)
      question.*member = scene.real(field.key, question.*member, field.range.low, field.range.high);
    else if constexpr (std::is_same_v<Member, std::optional<double> SceneQuestion::*>) {
      if (scene.find(field.key) != nullptr)
        question.*member = scene.real(field.key, 0, field.range.low, field.range.high);
    } else if constexpr (std::is_same_v<Member, int SceneQuestion::*>)
      question.*member = scene.integer(field.key, question.*member, static_cast<int>(field.range.low),
                                       static_cast<int>(field.range.high));
  };
  std::visit(into, field.member);
}

/// Reads the values that the scene lists.
Sweep parseSweep(const TomlSection& scene, const QuestionField& field) {
  Sweep sweep{&field, {}};
  const auto into = [&](auto member) {
    using Member = decltype(member);
    if constexpr (std::is_same_v<Member, std::string SceneQuestion::*>) {
      for (const std::string& text : scene.texts(keyInSuite(field), {}))
        sweep.values.emplace_back().*member = text;
    } else if constexpr (std::is_same_v<Member, double SceneQuestion::*> ||
                         std::is_same_v<Member, std::optional<double> SceneQuestion::*>) {
      const double low = field.sweepsDefault ? 0 : field.range.low;
      for (const double number : scene.reals(keyInSuite(field), 0, low, field.range.high))
        sweep.values.emplace_back().*member = number;
    }
  };
  std::visit(into, field.member);
  return sweep;
}

void checkTogether(const TomlSection& scene, const SceneQuestion& question) {
  if (question.eye.empty() != question.target.empty())
    scene.fail(*scene.find(question.eye.empty() ? "target" : "eye"), "'eye' and 'target' belong together");
}

void combine(const SceneQuestion& question, std::span<const Sweep> sweeps,
             const std::function<void(const SceneQuestion&)>& ask) {
  if (sweeps.empty()) return ask(question);
  SceneQuestion next = question;
  for (const SceneQuestion& value : sweeps.front().values) {
    copyField(*sweeps.front().field, next, value);
    combine(next, sweeps.subspan(1), ask);
  }
}

}  // namespace

std::vector<const char*> questionKeys() {
  std::vector<const char*> keys;
  for (const QuestionField& field : questionFields())
    if (field.kind != QuestionKind::size) keys.push_back(keyInSuite(field));
  return keys;
}

std::pair<int, int> parseSize(const TomlSection& section, const toml::node& node, const char* key) {
  const std::string text = section.text(node, key);
  const auto size = parsePictureSize(text);
  if (!size)
    section.fail(node, fmt::format("size '{}': WIDTHxHEIGHT with 1..16384 pixels is accepted", text));
  return *size;
}

std::vector<std::pair<int, int>> parseSizes(const TomlSection& suite) {
  const char* key = keyInSuite(questionField("size"));
  const toml::node& node = suite.require(key);
  const toml::array* elements = suite.list(node, key);
  if (elements == nullptr) return {parseSize(suite, node, key)};
  std::vector<std::pair<int, int>> sizes;
  for (const toml::node& element : *elements) sizes.push_back(parseSize(suite, element, key));
  return sizes;
}

std::string readTerm(const TomlSection& section, const std::string& otherwise) {
  return section.choice(questionField("term"), otherwise);
}

void forEachQuestion(const TomlSection& scene, const std::vector<std::pair<int, int>>& sizes,
                     const std::string& term, const std::function<void(const SceneQuestion&)>& ask) {
  SceneQuestion question;
  question.term = term;
  scene.require(questionFields().front().key);
  std::vector<Sweep> sweeps;
  for (const QuestionField& field : questionFields()) {
    if (field.kind == QuestionKind::size) {
      Sweep sweep{&field, {}};
      for (const auto& [width, height] : sizes) {
        sweep.values.emplace_back().width = width;
        sweep.values.back().height = height;
      }
      sweeps.push_back(std::move(sweep));
    } else if (!field.swept) {
      parseField(scene, field, question);
    } else if (scene.find(keyInSuite(field)) != nullptr) {
      sweeps.push_back(parseSweep(scene, field));
    }
  }
  checkTogether(scene, question);
  combine(question, sweeps, ask);
}

}  // namespace limn::bench
