// A TOML table read with complaints that name file, line and column.
#pragma once

#include <toml++/toml.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace limn::bench {

/// Throws UsageError "FILE:LINE:COLUMN: message".
[[noreturn]] void failAt(const std::string& file, const toml::source_region& where,
                         const std::string& message);

/// A TOML table whose keys must all be known; what is read must be of its type and in its range.
class TomlSection {
 public:
  /// `name` is what complaints call the table.
  TomlSection(const std::string& file, const toml::table& table, std::string name,
              std::initializer_list<const char*> keys);

  const std::string& file() const { return file_; }
  const toml::node* find(const char* key) const { return table_.get(key); }
  const toml::node& require(const char* key) const;
  [[noreturn]] void fail(const toml::node& node, const std::string& message) const;

  std::string text(const toml::node& node, const char* key) const;
  std::string text(const char* key, const std::string& otherwise) const;
  int integer(const char* key, int otherwise, int low, int high) const;
  double real(const char* key, double otherwise, double low, double high) const;
  bool boolean(const char* key, bool otherwise) const;
  /// One number or a list of them.
  std::vector<double> reals(const char* key, double otherwise, double low, double high) const;
  /// One text or a list of them.
  std::vector<std::string> texts(const char* key, std::vector<std::string> otherwise) const;
  /// One of `known`, the first where the key is missing.
  std::string choice(const char* key, std::initializer_list<const char*> known) const;
  /// The tables of an array of tables, which must be there.
  std::vector<const toml::table*> tables(const char* key) const;

 private:
  std::string file_;
  const toml::table& table_;
  std::string name_;
};

}  // namespace limn::bench
