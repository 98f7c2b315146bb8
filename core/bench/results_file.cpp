#include "core/bench/results_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "core/base/file.h"

namespace limn::bench {

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
  const std::string text = readTextFile(path_);
  std::size_t begin = 0;
  for (int line = 1; begin < text.size(); ++line) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;  // torn: every finished row ends in a line's end
    try {
      remember(rowFromJson(text.substr(begin, end - begin)));
    } catch (const Error& error) {
      throw Error(fmt::format("{}:{}: {}", path_.string(), line, error.what()));
    }
    begin = end + 1;
  }
  if (begin < text.size()) std::filesystem::resize_file(path_, begin);
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
  remember(row);
}

void ResultsFile::remember(Row row) {
  if (row.failure.empty()) finished_.insert(row.key);
  const auto [known, isNew] = position_.emplace(row.key, rows_.size());
  if (isNew) {
    rows_.push_back(std::move(row));
  } else {
    rows_[known->second] = std::move(row);
  }
}

std::vector<Row> ResultsFile::rows() const {
  return rows_;
}

}  // namespace limn::bench
