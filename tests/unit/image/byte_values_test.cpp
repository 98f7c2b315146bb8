// Linear values of bytes: IEC 61966-2-1 in double precision, and shares of 255.
#include "core/image/byte_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace limn {
namespace {

TEST(ByteValues, AreDecodedFromSrgbOrSharesOf255) {
  for (std::size_t i = 0; i < 256; ++i) {
    const double share = static_cast<double>(i) / 255;
    const double decoded = share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
    EXPECT_FLOAT_EQ(byteValues(false)[i], static_cast<float>(share)) << i;
    // The base has five roundings of 6e-8, its constants' included, which the power of 2.4 multiplies.
    EXPECT_NEAR(byteValues(true)[i], decoded, 1e-6 * decoded) << i;
  }
  for (const bool srgb : {false, true}) {
    EXPECT_EQ(byteValues(srgb)[0], 0.f);
    EXPECT_EQ(byteValues(srgb)[255], 1.f);
  }
}

}  // namespace
}  // namespace limn
