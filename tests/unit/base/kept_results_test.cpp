// What is kept of results that take long to make.
#include "core/base/kept_results.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/base/error.h"

namespace limn {
namespace {

/// Texts of their keys' lengths, of which six bytes are kept beside the last one.
class KeptResultsTest : public testing::Test {
 protected:
  std::shared_ptr<const std::string> text(int length) {
    return kept_.of(length, [&] {
      ++made_;
      return std::string(static_cast<std::size_t>(length), 'x');
    });
  }

  KeptResults<int, std::string> kept_{6, [](const std::string& result) { return result.size(); }};
  int made_ = 0;
};

TEST_F(KeptResultsTest, AreMadeOncePerKey) {
  const auto three = text(3), two = text(2);
  EXPECT_EQ(*three, "xxx");
  EXPECT_EQ(text(3), three);
  EXPECT_EQ(text(2), two);
  EXPECT_EQ(made_, 2);
}

TEST_F(KeptResultsTest, DropWhatWasAskedForLongestAgo) {
  const auto three = text(3), two = text(2), one = text(1);
  text(3);  // before these two now
  text(4);  // six bytes beside it
  EXPECT_EQ(made_, 4);
  text(5);  // four and three bytes are more than six
  EXPECT_EQ(made_, 5);
  text(4);
  EXPECT_EQ(made_, 5);
  EXPECT_NE(text(3), three);
  EXPECT_NE(text(1), one);
  EXPECT_EQ(made_, 7);
  EXPECT_EQ(*two, "xx") << "who has it keeps it";
}

/// However large it is, and nothing beside it.
TEST_F(KeptResultsTest, KeepTheLastOneInAnyCase) {
  const auto large = text(100);
  EXPECT_EQ(text(100), large);
  const auto small = text(1);
  EXPECT_EQ(text(1), small);
  EXPECT_NE(text(100), large);
}

TEST_F(KeptResultsTest, KeepNothingOfWhatThrows) {
  int asked = 0;
  for (int i = 0; i < 2; ++i)
    EXPECT_THROW(kept_.of(1,
                          [&]() -> std::string {
                            ++asked;
                            throw Error("nothing to make");
                          }),
                 Error);
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(*text(1), "x");
}

}  // namespace
}  // namespace limn
