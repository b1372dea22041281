#include "core/metering/reading.hpp"

#include <gtest/gtest.h>

namespace recald::metering::reading_test {
namespace {

TEST(Reading, UtilitiesAndValiditiesSurviveTheirNames) {
  for (int i = 0; i < 6; ++i) {
    const auto utility = static_cast<Utility>(i);
    EXPECT_EQ(parse_utility(to_string(utility)).value(), utility);
  }
  for (int i = 0; i < 5; ++i) {
    const auto validity = static_cast<Validity>(i);
    EXPECT_EQ(parse_validity(to_string(validity)).value(), validity);
  }
  EXPECT_EQ(parse_utility("oil").error().code, ErrorCode::invalid_value);
  EXPECT_EQ(parse_validity("good").error().code, ErrorCode::invalid_value);
}

TEST(Reading, ReasonsAreASetWithStableNames) {
  EXPECT_EQ(to_string(Reason::none), "");
  EXPECT_EQ(to_string(Reason::negative | Reason::range), "range|negative");
  EXPECT_EQ(to_string(Reason::timeout | Reason::manual), "timeout|manual");
  EXPECT_EQ(parse_reasons("range|negative").value(), Reason::negative | Reason::range);
  EXPECT_EQ(parse_reasons("").value(), Reason::none);
  EXPECT_NE(parse_reasons("range|odd").error().message.find("'odd'"), std::string::npos);
}

}  // namespace
}  // namespace recald::metering::reading_test
