// Reads CSV, for tests of what is written.
#pragma once

#include <string>
#include <vector>

namespace limn::bench::test {

/// The records of a file as RFC 4180 reads it.
inline std::vector<std::vector<std::string>> csvRecords(const std::string& text) {
  std::vector<std::vector<std::string>> records(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      records.back().back() += text[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      records.back().emplace_back();
    } else if (!quoted && text.compare(i, 2, "\r\n") == 0) {
      records.push_back({""});
      ++i;
    } else {
      records.back().back() += c;
    }
  }
  records.pop_back();
  return records;
}

}  // namespace limn::bench::test
