// How deep JSON of others nests.
#include "core/base/json_depth.h"

#include <gtest/gtest.h>

#include <string>

namespace limn {
namespace {

TEST(JsonDepth, CountsWhatIsOpenAtOnce) {
  const std::string most(kMaxJsonDepth, '['), closed(kMaxJsonDepth, ']');
  EXPECT_FALSE(isTooDeepJson(most + closed));
  EXPECT_FALSE(isTooDeepJson("[" + most.substr(1) + closed.substr(1) + ",{}]"));
  EXPECT_TRUE(isTooDeepJson(most + "[" + closed + "]"));
  EXPECT_TRUE(isTooDeepJson(most + "{")) << "a text that ends early";
}

TEST(JsonDepth, BracketsInStringsDoNotCount) {
  const std::string brackets(1000, '[');
  EXPECT_FALSE(isTooDeepJson("{\"" + brackets + "\": \"" + brackets + "\"}"));
  EXPECT_FALSE(isTooDeepJson("[\"a\\\"" + brackets + "\\\\\"]")) << "a quote that ends no string";
  EXPECT_TRUE(isTooDeepJson("[\"a\\\\\"," + brackets)) << "one that does";
}

}  // namespace
}  // namespace limn
