#include "adapters/report/savings_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/adapters/report/page_text.hpp"

namespace recald::report::savings_page_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

SavingsData sample_savings() {
  SavingsData data{.title = "What measures would save at Depot",
                   .site = {"depot", "Depot", "Europe/Zurich"},
                   .generated_at = "2023-01-01",
                   .headline = "Better lamps: saves 9,360 EUR a year.",
                   .cards = {},
                   .months = {},
                   .months_before = {},
                   .months_after = {},
                   .not_known = {"Weather is that of the calibration months."},
                   .notices = {},
                   .provenance = {.seed = 7}};
  data.cards.push_back(
      {.title = "Better <b>lamps</b>",
       .sentence = "Saves 9,360 EUR a year.",
       .caption = "Better lamps: what it saves",
       .amounts = {{"Electricity", "kWh a year", 25000.0, 31200.0, 38000.0, 0.08, 1.0},
                   {"Heating", "kWh a year", -9000.0, -6000.0, -2000.0, {}, 0.013}},
       .notes = {"The lights' share is taken from the drawings."}});
  return data;
}

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
  SavingsData data = sample_savings();
  using std::chrono::year;
  data.months_before = {"2021-01", "2021-02"};
  data.months_after = {"2022-07"};
  data.months = {{.label = "Chilled water, daily mean",
                  .unit = "kWh/day",
                  .trust = "Band: without the measure.",
                  .months = {{year{2022} / 7, 540.0, 600.0, 660.0, 480.0}},
                  .alarms = {}}};
  const std::string page = own_markup(render_savings(data));
  EXPECT_EQ(occurrences(page, "data-figure="), 1u);
  EXPECT_THAT(page, HasSubstr("Learnt from: 2021-01, 2021-02."));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Jul 2022</th><td class=\"number\">540.0</td>"));
}

}  // namespace
}  // namespace recald::report::savings_page_test
