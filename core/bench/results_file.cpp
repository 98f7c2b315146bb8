#include "core/bench/results_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/private/comparison.h"

namespace limn::bench {

namespace {

/// For each key the last row, in the order of their first appearance. A failure replaces a good row only
/// where it records that something else was measured than then, or a limit that the good row does not keep:
/// an old answer would hide it.
void remember(std::vector<Row>& rows, std::map<std::string, std::size_t>& position, Row row) {
  const auto [known, isNew] = position.emplace(row.key, rows.size());
  if (isNew) {
    rows.push_back(std::move(row));
    return;
  }
  Row& before = rows[known->second];
  if (row.failure.empty() || !before.failure.empty() || before.error.masked_share > row.what.maxMaskedShare ||
      (!row.provenance.program.empty() && !staleness(before.provenance, row.provenance).empty()))
    before = std::move(row);
}

/// Hands every whole line's row to `take`; gives the bytes of whole lines. What follows them is torn: every
/// finished row ends in a line's end.
template <class Take>
std::uint64_t parseRows(const std::filesystem::path& path, Take take) {
  int line = 0;
  return readLines(path, [&](const std::string& text) {
    ++line;
    try {
      take(rowFromJson(text));
    } catch (const Error& error) {
      throw Error(fmt::format("{}:{}: {}", path.string(), line, error.what()));
    }
  });
}

}  // namespace

std::vector<Row> readRows(const std::filesystem::path& path) {
  std::vector<Row> rows;
  std::map<std::string, std::size_t> position;
  std::size_t lines = 0;
  parseRows(path, [&](Row row) {
    row.line = ++lines;
    remember(rows, position, std::move(row));
  });
  return rows;
}

std::vector<Row> readRows(std::span<const std::filesystem::path> paths) {
  std::vector<Row> rows;
  std::size_t lines = 0;
  for (const std::filesystem::path& path : paths) {
    std::vector<Row> later = readRows(path);
    std::map<std::string, const Row*> measuredAgain;
    const std::size_t before = lines;
    for (Row& row : later) {
      row.line += before;
      lines = std::max(lines, row.line);
      if (row.failure.empty()) measuredAgain.emplace(row.key, &row);
    }
    // Rows of another machine stay: both sides of a comparison are of one.
    std::erase_if(rows, [&](const Row& row) {
      const auto again = measuredAgain.find(row.key);
      return again != measuredAgain.end() && sameMachine(row, *again->second);
    });
    std::ranges::move(later, std::back_inserter(rows));
  }
  return rows;
}

ResultsFile::ResultsFile(std::filesystem::path path) : path_(std::move(path)) {
  readExisting();
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) throw Error(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
}

ResultsFile::~ResultsFile() {
  if (file_ >= 0) ::close(file_);
}

void ResultsFile::readExisting() {
  if (!std::filesystem::exists(path_)) return;
  const std::uint64_t whole = parseRows(path_, [this](Row row) { add(std::move(row)); });
  if (whole < std::filesystem::file_size(path_)) std::filesystem::resize_file(path_, whole);
}

void ResultsFile::append(const Row& row) {
  const std::string line = toJson(row) + "\n";
  const off_t before = ::lseek(file_, 0, SEEK_END);
  std::size_t written = 0;
  int error = 0;
  while (written < line.size() && error == 0) {
    const ssize_t count = ::write(file_, line.data() + written, line.size() - written);
    if (count >= 0) {
      written += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  if (error == 0 && ::fsync(file_) != 0 && errno != EINVAL) error = errno;
  if (error != 0) {
    const bool restored = ::ftruncate(file_, before) == 0;
    throw Error(fmt::format("{}: cannot be written: {}{}", path_.string(), std::strerror(error),
                            restored ? "" : " (its last line is torn)"));
  }
  add(row);
}

bool ResultsFile::contains(const std::string& key) const {
  const Row* row = find(key);
  return row && row->failure.empty();
}

const Row* ResultsFile::find(const std::string& key) const {
  const auto found = position_.find(key);
  return found == position_.end() ? nullptr : &rows_[found->second];
}

void ResultsFile::add(Row row) {
  row.line = ++lines_;
  remember(rows_, position_, std::move(row));
}

std::vector<Row> ResultsFile::rows() const {
  return rows_;
}

}  // namespace limn::bench
