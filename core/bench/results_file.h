// Reads and writes results.jsonl: rows are added one by one and survive an interruption at any moment.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/bench/row.h"

namespace limn::bench {

/// Returns the rows of a file: for each key the one that ResultsFile::find() gives, in the order of their
/// first appearance. The file is not changed. A torn last line is skipped. Throws Error naming file and line
/// for a broken line elsewhere.
LIMN_API std::vector<Row> readRows(const std::filesystem::path& path);

/// Returns the rows of several files, of which later ones are newer: Row::line goes on from file to file. Of
/// a key that several hold on one machine the last good row counts.
LIMN_API std::vector<Row> readRows(std::span<const std::filesystem::path> paths);

class LIMN_API ResultsFile {
 public:
  /// Opens or creates the file and reads its rows. A torn last line (the writer was interrupted) is cut off.
  /// Throws Error naming file and line for a broken line elsewhere.
  explicit ResultsFile(std::filesystem::path path);
  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  /// Returns whether there is a successful row of that key; failed ones are to be tried again.
  bool contains(const std::string& key) const;
  /// Returns the row of that key, null if there is none: the last one, but a failure replaces a good row only
  /// where it records another provenance, or a largest masked share that the good row exceeds.
  const Row* find(const std::string& key) const;
  /// Writes one whole line and flushes it to the disk. Throws Error if that fails; the file then still ends
  /// in a whole line.
  void append(const Row& row);
  /// Returns all rows, for each key the one that find() gives, in the order of their first appearance.
  std::vector<Row> rows() const;

 private:
  void readExisting();
  void add(Row row);

  std::filesystem::path path_;
  int file_ = -1;
  std::size_t lines_ = 0;
  std::vector<Row> rows_;
  std::map<std::string, std::size_t> position_;  ///< of a key in rows_
};

}  // namespace limn::bench
