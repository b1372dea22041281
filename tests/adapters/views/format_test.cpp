#include "adapters/views/frame/format.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <locale>

namespace recald::views {
namespace {

using std::chrono::month;
using std::chrono::year;

TEST(NumberText, KeepsFourSignificantDigitsAndSeparatesThousands) {
  EXPECT_EQ(number_text(0.0), "0");
  EXPECT_EQ(number_text(0.012345), "0.01235");
  EXPECT_EQ(number_text(1.5), "1.500");
  EXPECT_EQ(number_text(999.94), "999.9");
  EXPECT_EQ(number_text(1000.4), "1,000");
  EXPECT_EQ(number_text(12345.6), "12,346");
  EXPECT_EQ(number_text(-1234567.0), "−1,234,567");
}

TEST(NumberText, ShowsADashForWhatIsNotANumber) {
  EXPECT_EQ(number_text(NAN), "–");
  EXPECT_EQ(number_text(INFINITY), "–");
  EXPECT_EQ(number_text(std::optional<double>{}), "–");
  EXPECT_EQ(percent_text(NAN), "–");
  EXPECT_EQ(signed_percent_text(NAN), "–");
  EXPECT_EQ(count_text(NAN), "–");
}

TEST(CountText, IsWhole) {
  EXPECT_EQ(count_text(7), "7");
  EXPECT_EQ(count_text(4776), "4,776");
  EXPECT_EQ(count_text(-12), "−12");
}

TEST(PercentText, NamesSignsWhereAsked) {
  EXPECT_EQ(percent_text(0.1534), "15.3\u00a0%");
  EXPECT_EQ(percent_text(0.6, 0), "60\u00a0%");
  EXPECT_EQ(signed_percent_text(0.02), "+2.0\u00a0%");
  EXPECT_EQ(signed_percent_text(-0.0211), "−2.1\u00a0%");
  EXPECT_EQ(signed_percent_text(0.0), "0.0\u00a0%");
}

TEST(ProbabilityText, NeverClaimsCertainty) {
  EXPECT_EQ(probability_text(0.1534), "15.3\u00a0%");
  EXPECT_EQ(probability_text(1.0), "over 99.9\u00a0%");
  EXPECT_EQ(probability_text(0.0), "under 0.1\u00a0%");
  EXPECT_EQ(probability_text(std::nan("")), "–");
}

TEST(CalendarText, NamesPartsOfTheWeek) {
  EXPECT_EQ(part_of_week_text(0), "Sun 00–04 h");
  EXPECT_EQ(part_of_week_text(8), "Mon 08–12 h");
  EXPECT_EQ(part_of_week_text(41), "Sat 20–24 h");
}

TEST(CalendarText, NamesMonthsAndDays) {
  EXPECT_EQ(month_text(metering::Month{year{2021}, month{3}}), "Mar 2021");
  EXPECT_EQ(month_key(metering::Month{year{2021}, month{3}}), "2021-03");
  EXPECT_EQ(day_key(metering::Day{year{2020}, month{2}, std::chrono::day{29}}), "2020-02-29");
  EXPECT_EQ(month_name(12), "Dec");
}

TEST(ContractionSentence, SaysWhatTheDataDid) {
  EXPECT_EQ(contraction_sentence(0.6), "The data narrowed this by 60\u00a0% of its variance.");
  EXPECT_EQ(contraction_sentence(0.02), contraction_sentence(-0.03));
  EXPECT_NE(contraction_sentence(0.02).find("say nothing"), std::string::npos);
  EXPECT_NE(contraction_sentence(0.2).find("say little"), std::string::npos);
  EXPECT_NE(contraction_sentence(-0.5).find("wider than its prior"), std::string::npos);
  EXPECT_NE(contraction_sentence(NAN).find("not known"), std::string::npos);
}

class DecimalComma : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(NumberText, DoesNotListenToTheLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale(), new DecimalComma));
  EXPECT_EQ(number_text(12345.6), "12,346");
  EXPECT_EQ(number_text(1.5), "1.500");
  std::locale::global(before);
}

TEST(LocalText, IsTheClockOnTheWallAndUtcWithoutAPlace) {
  const metering::Instant t =
      std::chrono::sys_days{std::chrono::year{2021} / 7 / 1} + std::chrono::minutes{95};
  EXPECT_EQ(local_text(t, metering::LocalCalendar::open("America/New_York").value()),
            "2021-06-30 21:35");
  EXPECT_EQ(local_text(t, std::nullopt), "2021-07-01 01:35");
}

}  // namespace
}  // namespace recald::views
