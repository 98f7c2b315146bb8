// Declares each field of SceneQuestion once, as a row of a table. The row determines its flag with help,
// range and default, its key in bench suites, its place in the JSON of a row, the words of labels and of
// reference keys, and what the viewer saves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/export.h"
#include "core/base/parameters.h"
#include "core/question/scene_question.h"

namespace limn {

enum class QuestionKind : std::uint8_t {
  text,
  texts,  ///< a repeatable flag, a list in suites
  real,
  optionalReal,  ///< unset: the scene's value
  integer,
  choice,
  coefficient,  ///< one number, or three with commas: a text; in suites also a number
  size          ///< WIDTHxHEIGHT
};

/// Says where a field stands in the JSON of a row, and in which part of a label.
enum class QuestionGroup : std::uint8_t {
  subject,      ///< beside the case's other keys; always written
  environment,  ///< the object "environment"; always written
  medium,       ///< the object "medium"; written where it is not the default
  changes       ///< the object "changes"; written where it is not the default
};
/// Returns the key of the group's object; empty for the subject.
LIMN_API const char* name(QuestionGroup group);

/// Says for whom values are written.
enum class QuestionWording : std::uint8_t {
  key,   ///< for the keys of references and rows: whole values
  label  ///< for people: files without their folders, and words in place of empty texts
};

/// Says what an open scene has to do again when a field changes.
enum class QuestionEffect : std::uint8_t {
  view,    ///< the same scene with another camera, size, term or choice of light
  time,    ///< the scene is moved
  lights,  ///< the scene's lights are set again
  scene    ///< the scene is opened again
};

struct QuestionSizeMember {
  int SceneQuestion::*width;
  int SceneQuestion::*height;
};

using QuestionMember = std::variant<std::string SceneQuestion::*, std::vector<std::string> SceneQuestion::*,
                                    double SceneQuestion::*, std::optional<double> SceneQuestion::*,
                                    int SceneQuestion::*, QuestionSizeMember>;

struct QuestionField {
  const char* key;   ///< in suites and in JSON, unless suiteKey or rowKey says otherwise
  const char* flag;  ///< on the command line
  QuestionKind kind;
  QuestionMember member;
  const char* doc;
  QuestionGroup group = QuestionGroup::changes;
  QuestionEffect effect = QuestionEffect::scene;
  const char* otherFlag = "";  ///< also accepted on the command line; empty: none
  ParameterRange range{0, 0};  ///< of numbers; coefficients: of a number in a suite
  const char* unit = "";
  std::span<const char* const> choices = {};
  std::span<const char* const> choiceDocs = {};  ///< meaning of each choice; empty: see `doc`
  const char* suiteKey = nullptr;
  const char* rowKey = nullptr;
  const char* label = nullptr;  ///< words before the value in a label; null: the key
  /// Place among the values that stand at the beginning of every key and label; 0: named where it is not the
  /// default.
  int place = 0;
  const char* unset = "";      ///< what labels say in such a place where the text is empty
  bool file = false;           ///< a path, of which labels show the last part alone
  bool swept = false;          ///< a suite may list several values
  bool sweepsDefault = false;  ///< the list may hold the default even if it lies below the range
  bool addedLater = false;     ///< rows of earlier versions lack it
  /// Says whether the field determines what techniques get in place of the environment. The reference of all
  /// light together uses the environment itself; that of one light depends on the field.
  bool approximates = false;

  /// Returns the field with another value of one of its members.
  template <class T>
  constexpr QuestionField with(T QuestionField::*what, T value) const {
    QuestionField field = *this;
    field.*what = value;
    return field;
  }
  constexpr QuestionField in(QuestionGroup other) const { return with(&QuestionField::group, other); }
  constexpr QuestionField changing(QuestionEffect what) const { return with(&QuestionField::effect, what); }
  constexpr QuestionField alsoGivenBy(const char* flagToo) const {
    return with(&QuestionField::otherFlag, flagToo);
  }
  constexpr QuestionField within(ParameterRange accepted, const char* of) const {
    return with(&QuestionField::range, accepted).with(&QuestionField::unit, of);
  }
  constexpr QuestionField oneOf(std::span<const char* const> names) const {
    return with(&QuestionField::choices, names);
  }
  constexpr QuestionField meaning(std::span<const char* const> docs) const {
    return with(&QuestionField::choiceDocs, docs);
  }
  /// Returns the field with several values allowed in a suite, under the key `other`.
  constexpr QuestionField sweptAs(const char* other) const {
    return with(&QuestionField::suiteKey, other).with(&QuestionField::swept, true);
  }
  constexpr QuestionField orDefault() const { return with(&QuestionField::sweepsDefault, true); }
  constexpr QuestionField storedAs(const char* other) const { return with(&QuestionField::rowKey, other); }
  /// Returns the field with a place at the beginning of keys, after `prefix`, and of labels, which say
  /// `otherwise` where its text is empty.
  constexpr QuestionField placed(int where, const char* prefix = "", const char* otherwise = "") const {
    return with(&QuestionField::place, where).labelled(prefix).with(&QuestionField::unset, otherwise);
  }
  constexpr QuestionField ofFile() const { return with(&QuestionField::file, true); }
  constexpr QuestionField labelled(const char* words) const { return with(&QuestionField::label, words); }
  constexpr QuestionField later() const { return with(&QuestionField::addedLater, true); }
  constexpr QuestionField approximating() const { return with(&QuestionField::approximates, true); }
};

/// Returns all fields, in the order of help texts and labels.
LIMN_API std::span<const QuestionField> questionFields();
/// Returns the field of that key; asking for another is a bug and throws std::logic_error.
LIMN_API const QuestionField& questionField(std::string_view key);

/// Returns a message that `text` is not a choice of the field, with the nearest choices and all choices.
LIMN_API std::string unknownChoice(const QuestionField& field, std::string_view text);

/// Returns the field's key in a suite.
LIMN_API const char* keyInSuite(const QuestionField& field);
/// Returns the field's key in its group's object of a row.
LIMN_API const char* keyInRow(const QuestionField& field);

/// Calls visit(value, standard) with a reference to the field's value and with its default, and returns what
/// visit() returns. A size is a pair of ints.
template <class Visit>
decltype(auto) visitField(const QuestionField& field, const SceneQuestion& question, Visit visit) {
  static const SceneQuestion standard;
  return std::visit(
      [&](auto member) {
        if constexpr (std::is_same_v<decltype(member), QuestionSizeMember>)
          return visit(std::pair(question.*member.width, question.*member.height),
                       std::pair(standard.*member.width, standard.*member.height));
        else
          return visit(question.*member, standard.*member);
      },
      field.member);
}

/// Says whether the field has its default value.
LIMN_API bool isDefault(const QuestionField& field, const SceneQuestion& question);
/// Copies the field's value from `from` to `to`.
LIMN_API void copyField(const QuestionField& field, SceneQuestion& to, const SceneQuestion& from);
/// Copies the values of all fields with that effect from `from` to `to`.
LIMN_API void copyFields(QuestionEffect effect, SceneQuestion& to, const SceneQuestion& from);
/// Says whether all fields with that effect are equal.
LIMN_API bool sameFields(QuestionEffect effect, const SceneQuestion& a, const SceneQuestion& b);

/// Returns the value as command-line texts: one text, several for a list, none for an empty text or an unset
/// value.
LIMN_API std::vector<std::string> printed(const QuestionField& field, const SceneQuestion& question);
/// Returns the width and height of "WIDTHxHEIGHT", or nothing when the text is not accepted.
LIMN_API std::optional<std::pair<int, int>> parsePictureSize(std::string_view text);

/// Returns the values that every key and label begins with, such as "balls/main/key/t1.5/direct/33x25".
/// Labels lack the time.
LIMN_API std::string subjectText(const SceneQuestion& question, QuestionWording wording);
/// Returns a line that lists the group's other values that are not the default; empty when there are none.
/// What approximates the environment is left to describeEnvironmentLights().
LIMN_API std::string describe(const SceneQuestion& question, QuestionGroup group,
                              QuestionWording wording = QuestionWording::key);
/// Returns a line that says which lights stand for the environment; empty when none do.
LIMN_API std::string describeEnvironmentLights(const SceneQuestion& question);
/// Returns a text that is equal for equal questions only: every field that is not the default.
LIMN_API std::string questionText(const SceneQuestion& question);

}  // namespace limn
