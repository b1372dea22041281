#include "tests/blind/population/case_range.hpp"

#include <gtest/gtest.h>

namespace recald::blind {
namespace {

TEST(CaseRange, OneAFewOrAll) {
  EXPECT_EQ(case_range_of("", 200).value().size(), 200u);
  EXPECT_EQ(case_range_of("200", 200).value().first, 200u);
  const CaseRange few = case_range_of("3-17", 200).value();
  EXPECT_EQ(few.first, 3u);
  EXPECT_EQ(few.last, 17u);
  EXPECT_EQ(few.size(), 15u);
}

TEST(CaseRange, NothingThatThePopulationLacks) {
  for (const char* text : {"0", "201", "17-3", "3-201", "3-", "-3", "a", "3,4", "3-4 5"}) {
    EXPECT_FALSE(case_range_of(text, 200).has_value()) << text;
  }
}

}  // namespace
}  // namespace recald::blind
