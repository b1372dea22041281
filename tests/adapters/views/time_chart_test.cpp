#include "adapters/views/frame/time_chart.hpp"

#include <gmock/gmock.h>

#include "core/absent.hpp"

namespace recald::views {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::sys_days;
using std::chrono::year;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const metering::LocalCalendar& chicago() {
  static const auto calendar = metering::LocalCalendar::open("America/Chicago").value();
  return calendar;
}

std::vector<std::string> labels(metering::Instant begin, std::chrono::seconds length) {
  std::vector<std::string> all;
  for (const TimeTick& tick : time_ticks({begin, begin + length}, chicago())) {
    all.push_back(tick.label);
  }
  return all;
}

TEST(TimeChart, ValueTicksAreRoundAndHoldAllValues) {
  EXPECT_THAT(value_ticks(0.0, 61.2), ElementsAre(0.0, 20.0, 40.0, 60.0, 80.0));
  EXPECT_THAT(value_ticks(0.0, 4.0), ElementsAre(0.0, 1.0, 2.0, 3.0, 4.0));
  EXPECT_THAT(value_ticks(-3.0, 5.0), ElementsAre(-4.0, -2.0, 0.0, 2.0, 4.0, 6.0));
  EXPECT_THAT(value_ticks(0.0, 0.0), ElementsAre(0.0, 0.5, 1.0));
}

TEST(TimeChart, TimeTicksAreRoundLocalTimes) {
  const metering::Instant midnight = sys_days{year{2024} / 3 / 9} + hours{6};
  EXPECT_THAT(labels(midnight, hours{24}), ElementsAre("9 Mar", "06:00", "12:00", "18:00"));
  // The clock goes on in the night from the 9th to the 10th.
  EXPECT_THAT(labels(midnight, days{3}),
              ElementsAre("9 Mar", "12:00", "10 Mar", "12:00", "11 Mar", "12:00", "12 Mar"));
  EXPECT_THAT(labels(midnight, days{30}),
              ElementsAre("9 Mar", "16 Mar", "23 Mar", "30 Mar", "6 Apr"));
  EXPECT_THAT(labels(midnight, days{365}),
              ElementsAre("Apr 2024", "Jul 2024", "Oct 2024", "Jan 2025"));
  EXPECT_THAT(labels(midnight, days{3650}), ElementsAre("2025", "2027", "2029", "2031", "2033"));
}

TEST(TimeChart, TheLineHasAGapWhereNothingIsKnown) {
  const metering::Instant start = sys_days{year{2024} / 3 / 9};
  const auto at = [&](int hour) { return start + hours{hour}; };
  TimeChart chart{.title = "a < b", .unit = "kW", .span = {at(0), at(4)}, .points = {}};
  for (int hour = 0; hour < 4; ++hour) {
    const double kW = hour == 1 ? kAbsent : 10.0 * hour;
    chart.points.push_back({at(hour), kW, kW, kW, at(hour + 1)});
  }
  Html html;
  write_chart(html, chart, chicago());
  EXPECT_THAT(html.str(), HasSubstr("<title>a &lt; b</title>"));
  EXPECT_THAT(html.str(), HasSubstr("class=\"chart-line\" d=\"M0 1000H500M1000 333H1500V0H2000\""));
  EXPECT_THAT(html.str(), Not(HasSubstr("nan")));
  EXPECT_THAT(html.str(), HasSubstr("class=\"chart-band\" d=\"\""));  // as thin as the line
}

TEST(TimeChart, OfNothingIsAnEmptyOne) {
  Html html;
  const metering::Instant now = sys_days{year{2024} / 3 / 9};
  write_chart(html, {.title = "t", .unit = "kW", .span = {now, now}, .points = {}}, chicago());
  EXPECT_THAT(html.str(), HasSubstr("class=\"chart-line\" d=\"\""));
  EXPECT_THAT(html.str(), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace recald::views
