// The limn program under test, and what every refusal has in common.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/cli/process.h"
#include "tests/support/paths.h"

namespace limn::test {

inline const std::string kLimnBinary = std::string(kBinaryDir) + "/bin/limn";
inline const std::string kCornellBox = std::string(kBinaryDir) + "/assets/cornell_box/cornell_box.glb";

inline Outcome limn(std::vector<std::string> arguments,
                    const std::map<std::string, std::string>& environment = {}, rlim_t fileSizeLimit = 0) {
  arguments.insert(arguments.begin(), kLimnBinary);
  return run(arguments, environment, fileSizeLimit);
}

/// One line on stderr that contains all of `parts`, and the exit status.
inline void expectRefused(const Outcome& outcome, int status, const std::vector<std::string>& parts) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const std::string& part : parts) EXPECT_THAT(outcome.err, testing::HasSubstr(part));
}

/// Names of everything in a folder, sorted.
inline std::vector<std::string> listing(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace limn::test
