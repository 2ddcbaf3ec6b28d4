// Numbers as text, and ticks.
#include "ui/plot.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ui/widgets.h"

namespace {

TEST(Numbers, AreGroupedByThousands) {
  EXPECT_EQ(ui::grouped(0), "0");
  EXPECT_EQ(ui::grouped(999), "999");
  EXPECT_EQ(ui::grouped(1000), "1,000");
  EXPECT_EQ(ui::grouped(12345678), "12,345,678");
}

TEST(Numbers, BytesHaveTheUnitThatFits) {
  EXPECT_EQ(ui::byte_size(1023), "1023 B");
  EXPECT_EQ(ui::byte_size(1536), "1.5 KiB");
  EXPECT_EQ(ui::byte_size(5u << 20), "5.0 MiB");
  EXPECT_EQ(ui::byte_size(3ull << 30), "3.00 GiB");
}

TEST(Numbers, FourSignificantDigits) {
  EXPECT_EQ(ui::short_number(0.0), "0");
  EXPECT_EQ(ui::short_number(3.14159), "3.142");
  EXPECT_EQ(ui::short_number(123456.0), "123456");
  EXPECT_EQ(ui::short_number(1.5e-7), "1.500e-07");
  EXPECT_EQ(ui::short_number(-2.5e9), "-2.500e+09");
}

TEST(Ticks, AreOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(ui::tick_step(10.0, 10), 1.0);
  EXPECT_DOUBLE_EQ(ui::tick_step(10.0, 6), 2.0);
  EXPECT_DOUBLE_EQ(ui::tick_step(10.0, 3), 5.0);
  EXPECT_DOUBLE_EQ(ui::tick_step(1e6, 4), 5e5);
  EXPECT_DOUBLE_EQ(ui::tick_step(0.03, 5), 0.01);
}

TEST(Ticks, NeverMoreThanAskedFor) {
  for (double length = 0.001; length < 1e6; length *= 1.37) {
    for (int most = 1; most < 12; ++most) {
      EXPECT_LE(length / ui::tick_step(length, most), most + 1e-6) << length << " " << most;
    }
  }
}

TEST(Ticks, AnAxisWithoutLength) {
  EXPECT_EQ(ui::tick_step(0.0, 5), 1.0);
  EXPECT_EQ(ui::tick_step(NAN, 5), 1.0);
}

TEST(Swatch, IsEncodedAndScaledDown) {
  EXPECT_NEAR(ui::swatch({0.214f, 0.0f, 0.0f}).x, 0.5f, 0.01f);
  const ImVec4 bright = ui::swatch({150.0f, 150.0f, 75.0f});
  EXPECT_NEAR(bright.x, 1.0f, 1e-5f);
  EXPECT_NEAR(bright.z, 0.735f, 0.01f);
}

}  // namespace
