// How tests say that a suite is refused.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "core/bench/suite.h"

namespace limn::bench::test {

/// Expects that the text of a suite, the file s.toml, is refused in one line that holds `message`.
inline void expectUsageError(const std::string& text, const std::string& message) {
  try {
    parseSuite(text, "s.toml");
    ADD_FAILURE() << "no error; expected " << message;
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

}  // namespace limn::bench::test
