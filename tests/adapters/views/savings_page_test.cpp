#include "adapters/views/savings/savings_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/adapters/views/page_text.hpp"
#include "tests/adapters/views/sample_savings.hpp"

namespace recald::views::savings_page_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(SavingsPage, ShowsEachAmountWithItsIntervalAndProbability) {
  const std::string page = own_markup(render_savings(sample_savings()));
  EXPECT_THAT(page, HasSubstr("Better lamps: saves 9,360 EUR a year."));
  EXPECT_THAT(page, HasSubstr("31,200"));
  EXPECT_THAT(page, HasSubstr("25,000"));
  EXPECT_THAT(page, HasSubstr("+8.0\u00a0%"));
  EXPECT_THAT(page, HasSubstr("over 99.9\u00a0%"));
  EXPECT_THAT(page, HasSubstr("−6,000"));
  EXPECT_THAT(page, HasSubstr("1.3\u00a0%"));
  EXPECT_THAT(page, HasSubstr("<li>The lights&#39; share is taken from the drawings.</li>"));
  EXPECT_THAT(page, HasSubstr("Weather is that of the calibration months."));
  EXPECT_THAT(page, Not(HasSubstr("<b>lamps")));
  EXPECT_THAT(page, Not(HasSubstr("id=\"months\"")));
}

TEST(SavingsPage, ShowsMonthsSinceADateBesideWhatWasExpected) {
  const std::string page = own_markup(render_savings(realised_savings()));
  EXPECT_EQ(occurrences(page, "data-figure="), 1u);
  EXPECT_THAT(page, HasSubstr("Learnt from: 2021-01, 2021-02."));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Jul 2022</th><td class=\"number\">540.0</td>"));
}

}  // namespace
}  // namespace recald::views::savings_page_test
