// A value for each field of SceneQuestion that is not its default.
#pragma once

#include "core/question/question_fields.h"

namespace limn::test {

/// Gives the field a value in its range.
inline void setSample(const QuestionField& field, SceneQuestion& question) {
  const double inside = field.range.low + 0.75 * (field.range.high - field.range.low);
  const auto set = [&](auto member) {
    using Member = decltype(member);
    if constexpr (std::is_same_v<Member, QuestionSizeMember>) {
      question.*member.width = 33;
      question.*member.height = 25;
    } else if constexpr (std::is_same_v<Member, std::string SceneQuestion::*>) {
      question.*member = field.kind == QuestionKind::choice        ? field.choices.back()
                         : field.kind == QuestionKind::coefficient ? "0.1,0.2,0.3"
                                                                   : "a \"name\"";
    } else if constexpr (std::is_same_v<Member, std::vector<std::string> SceneQuestion::*>) {
      question.*member = {"a.size=1,2", "b.intensity=3"};
    } else if constexpr (std::is_same_v<Member, int SceneQuestion::*>) {
      question.*member = static_cast<int>(inside);
    } else {
      question.*member = inside;
    }
  };
  std::visit(set, field.member);
}

/// The default question of a scene, but for the field and what it cannot do without.
inline SceneQuestion sampleQuestion(const QuestionField& field) {
  SceneQuestion question;
  question.scene = "balls";
  const std::string key = field.key;
  if (key == "eye") question.target = "0,0,0";
  if (key == "target") question.eye = "0,1,3";
  if (key == "environment_lights") question.environment = "sky";
  setSample(field, question);
  return question;
}

}  // namespace limn::test
