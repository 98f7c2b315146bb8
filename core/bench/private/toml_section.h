// Reads a TOML table, with errors that name file, line and column.
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <string>
#include <vector>

#include "core/question/question_fields.h"

namespace limn::bench {

/// The most values of a list. A suite may have no more cases, and each size, camera or light gives at least
/// one.
inline constexpr std::size_t kMostListed = 100'000;

/// Throws UsageError "FILE:LINE:COLUMN: message".
[[noreturn]] void failAt(const std::string& file, const toml::source_region& where,
                         const std::string& message);

/// Holds a TOML table whose keys must all be known; values that are read must have the right type and lie in
/// their range.
class TomlSection {
 public:
  /// Takes `name`, which error messages call the table.
  TomlSection(const std::string& file, const toml::table& table, std::string name,
              const std::vector<const char*>& keys);

  const std::string& file() const { return file_; }
  const toml::node* find(const char* key) const { return table_.get(key); }
  const toml::node& require(const char* key) const;
  [[noreturn]] void fail(const toml::node& node, const std::string& message) const;

  std::string text(const toml::node& node, const char* key) const;
  std::string text(const char* key, const std::string& otherwise) const;
  int integer(const char* key, int otherwise, int low, int high) const;
  double real(const char* key, double otherwise, double low, double high) const;
  bool boolean(const char* key, bool otherwise) const;
  /// Returns the list that the node is, of 1 to kMostListed values; null where it is none.
  const toml::array* list(const toml::node& node, const char* key) const;
  /// Returns the numbers of a key that holds one number or a list.
  std::vector<double> reals(const char* key, double otherwise, double low, double high) const;
  /// Returns the texts of a key that holds one text or a list.
  std::vector<std::string> texts(const char* key, std::vector<std::string> otherwise) const;
  /// Returns one of the field's choices; `otherwise` where its key is missing.
  std::string choice(const QuestionField& field, const std::string& otherwise) const;
  /// Returns the tables of an array of tables, which must exist.
  std::vector<const toml::table*> tables(const char* key) const;

 private:
  std::string file_;
  const toml::table& table_;
  std::string name_;
};

}  // namespace limn::bench
