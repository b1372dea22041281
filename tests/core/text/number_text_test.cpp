#include "core/text/number_text.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <locale>

namespace recald {
namespace {

class DecimalComma : public std::numpunct<char> {
 protected:
  [[nodiscard]] char do_decimal_point() const override { return ','; }
};

TEST(NumberText, ShortAndReadable) {
  EXPECT_EQ(number_text(0.15341), "0.1534");
  EXPECT_EQ(number_text(12.0), "12");
  EXPECT_EQ(number_text(1234567.0), "1.235e+06");
  EXPECT_EQ(number_text(-0.5, 2), "-0.5");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(percent_text(0.153), "15.3 %");
  EXPECT_EQ(signed_percent_text(0.314), "+31 %");
  EXPECT_EQ(signed_percent_text(-0.04), "-4 %");
  EXPECT_EQ(signed_percent_text(-0.004), "-0.4 %");
  EXPECT_EQ(percent_text(1e300).size(), 305u + 2u);  // no buffer is overrun
}

TEST(NumberText, NeverADecimalComma) {
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  EXPECT_EQ(number_text(0.5), "0.5");
  EXPECT_EQ(percent_text(0.125), "12.5 %");
  std::locale::global(before);
}

}  // namespace
}  // namespace recald
