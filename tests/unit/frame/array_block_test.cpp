// Which block an array is read from.
#include "core/frame/array_block.h"

#include <gtest/gtest.h>

namespace limn::frame {
namespace {

struct Element {
  float numbers[8];
};
constexpr int kMost = 512;  // elements, 16384 bytes: what every device with OpenGL 4.5 takes

std::map<std::string, std::string> definesOf(int count, Access expected) {
  gpu::Limits limits;
  limits.maxUniformBlockBytes = kMost * static_cast<int>(sizeof(Element));
  std::map<std::string, std::string> defines{{"OTHER", "1"}};
  EXPECT_EQ(arrayBlock<Element>(limits, count, "ELEMENT_COUNT", defines), expected) << count;
  EXPECT_EQ(defines["OTHER"], "1");
  defines.erase("OTHER");
  return defines;
}

TEST(ArrayBlock, IsAUniformBlockUpToTheDevicesLimit) {
  const std::map<std::string, std::string> few{{"ELEMENT_COUNT", "128"}}, most{{"ELEMENT_COUNT", "512"}};
  EXPECT_EQ(definesOf(1, Access::uniformBuffer), few);
  EXPECT_EQ(definesOf(128, Access::uniformBuffer), few);
  EXPECT_EQ(definesOf(257, Access::uniformBuffer), most);
  EXPECT_EQ(definesOf(kMost, Access::uniformBuffer), most);
}

TEST(ArrayBlock, StatesALengthThatHoldsTheArrayAndFitsItsBuffer) {
  for (int count = 1; count <= kMost; ++count) {
    const auto stated =
        static_cast<size_t>(std::stoi(definesOf(count, Access::uniformBuffer)["ELEMENT_COUNT"]));
    ASSERT_GE(stated, static_cast<size_t>(count));
    ASSERT_LE(stated * sizeof(Element), gpu::blockRoom(static_cast<size_t>(count) * sizeof(Element)))
        << count;
  }
}

TEST(ArrayBlock, IsAStorageBlockBeyondItWhichStatesNoLength) {
  EXPECT_TRUE(definesOf(kMost + 1, Access::storageLoad).empty());
}

}  // namespace
}  // namespace limn::frame
