#include "adapters/doe/design_month.hpp"

#include <gtest/gtest.h>

namespace recald::doe {
namespace {

TEST(DesignMonth, IsACalendarMonthOrANumber) {
  EXPECT_EQ(DesignMonth::parse("2016-03")->text(), "2016-03");
  EXPECT_TRUE(DesignMonth::parse("2016-12")->is_calendar());
  EXPECT_EQ(DesignMonth::parse("2016-12")->text(), "2016-12");
  EXPECT_EQ(DesignMonth::parse("03")->text(), "3");
  EXPECT_FALSE(DesignMonth::parse("24")->is_calendar());
  for (const char* text : {"", "2016-13", "2016-3", "-1", "1.5", "March", "10000"}) {
    EXPECT_FALSE(DesignMonth::parse(text)) << text;
  }
  EXPECT_EQ(DesignMonth::parse("2016-13").error().message,
            "month '2016-13' is neither YYYY-MM nor a number from 0 to 9999");
}

TEST(DesignMonth, IsOrderedByTime) {
  EXPECT_LT(*DesignMonth::parse("2016-12"), *DesignMonth::parse("2017-01"));
  EXPECT_LT(*DesignMonth::parse("9"), *DesignMonth::parse("10"));
  EXPECT_NE(*DesignMonth::parse("1"), *DesignMonth::parse("2016-01"));
}

}  // namespace
}  // namespace recald::doe
