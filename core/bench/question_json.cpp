#include "core/bench/private/question_json.h"

#include <fmt/format.h>

#include "core/question/question_fields.h"

namespace limn::bench {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json asJson(const T& value) {
  return value;
}
Json asJson(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}
Json asJson(const std::pair<int, int>& size) {
  return {size.first, size.second};
}

void read(const Json& json, SceneQuestion& question, const QuestionField& field) {
  const auto into = [&](auto member) {
    using Member = decltype(member);
    if constexpr (std::is_same_v<Member, QuestionSizeMember>) {
      question.*member.width = json.at(0).get<int>();
      question.*member.height = json.at(1).get<int>();
    } else if constexpr (std::is_same_v<Member, std::optional<double> SceneQuestion::*>) {
      question.*member = json.get<double>();
    } else if constexpr (std::is_same_v<Member, std::string SceneQuestion::*>) {
      // Rows of earlier versions have coefficients as numbers.
      const bool number = field.kind == QuestionKind::coefficient && json.is_number();
      question.*member = number ? fmt::format("{}", json.get<double>()) : json.get<std::string>();
    } else {
      json.get_to(question.*member);
    }
  };
  std::visit(into, field.member);
}

bool writtenAlways(QuestionGroup group) {
  return group == QuestionGroup::subject || group == QuestionGroup::environment;
}

}  // namespace

void addQuestion(Json& json, const SceneQuestion& question) {
  for (const QuestionField& field : questionFields()) {
    const bool beside = field.group == QuestionGroup::subject;
    Json& object = beside ? json : json[name(field.group)];
    if (object.is_null()) object = Json::object();
    if (writtenAlways(field.group) || !isDefault(field, question))
      object[keyInRow(field)] =
          visitField(field, question, [](const auto& value, const auto&) { return asJson(value); });
  }
}

SceneQuestion questionFromJson(const Json& json) {
  SceneQuestion question;
  for (const QuestionField& field : questionFields()) {
    const char* key = keyInRow(field);
    const bool beside = field.group == QuestionGroup::subject;
    const auto object = json.find(name(field.group));
    if (!beside && object == json.end()) continue;  // rows of earlier versions lack it
    const Json& values = beside ? json : *object;
    const bool always = writtenAlways(field.group) && !field.addedLater;
    if (always || values.contains(key)) read(values.at(key), question, field);
  }
  return question;
}

}  // namespace limn::bench
