#include "adapters/views/frame/zoomable_chart.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "core/absent.hpp"

namespace recald::views::zoomable_chart_test {
namespace {

using nlohmann::json;
using std::chrono::hours;
using std::chrono::sys_days;
using std::chrono::year;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::int64_t seconds_of(metering::Instant t) { return t.time_since_epoch().count(); }

class ZoomableChart : public ::testing::Test {
 protected:
  std::string written() {
    Html html;
    write_zoomable_chart(html, chart_, {.line = "Mean", .band = "Range"}, finer_, calendar_);
    return html.str();
  }
  json data() {
    const std::string text = written();
    const std::size_t from = text.find("json\">") + 6;
    return json::parse(text.substr(from, text.find("</script>") - from));
  }

  metering::LocalCalendar calendar_ = metering::LocalCalendar::open("America/Chicago").value();
  const metering::Instant start_ = sys_days{year{2024} / 3 / 9} + hours{6};  // midnight there
  TimeChart chart_{.title = "main </script>",
                   .unit = "kW",
                   .span = {start_, start_ + hours{48}},
                   .points = {{start_, 1.0, 2.0, 3.0, start_ + hours{24}},
                              {start_ + hours{24}, kAbsent, kAbsent, kAbsent, start_ + hours{48}}}};
  std::optional<FinerValues> finer_;
};

TEST_F(ZoomableChart, IsTheSvgAndTheSameNumbersBesideIt) {
  EXPECT_THAT(written(), StartsWith("<div class=\"zoomable\"><svg class=\"chart\""));
  EXPECT_THAT(written(), Not(HasSubstr("main </script>")));
  const std::int64_t start = seconds_of(start_);
  EXPECT_EQ(data()["title"], "main </script>");
  EXPECT_EQ(data()["points"],
            json::array({{start, start + 86'400, 1.0, 2.0, 3.0},
                         {start + 86'400, start + 172'800, nullptr, nullptr, nullptr}}));
  EXPECT_TRUE(data()["finer"].is_null());
}

// The clocks go forward at two in the night to 10 March, at 08:00 UTC.
TEST_F(ZoomableChart, HasTheSitesOffsetsToTheSecond) {
  const std::int64_t change = seconds_of(sys_days{year{2024} / 3 / 10} + hours{8});
  EXPECT_EQ(data()["offsets"], json::array({{seconds_of(start_), -6 * 3600}, {change, -5 * 3600}}));
}

TEST_F(ZoomableChart, MayEndWhereTheCalendarEnds) {
  chart_.span.end = metering::kLatestInstant;
  EXPECT_EQ(data()["offsets"].size(), 155u);  // two changes a year, the last in November 2100
}

TEST_F(ZoomableChart, SaysWhereFinerValuesAre) {
  finer_ = {.address = "/there?meter=main",
            .interval = std::chrono::minutes{15},
            .points = 400,
            .factor = 1.8,
            .offset = 32.0};
  EXPECT_EQ(data()["finer"], json({{"address", "/there?meter=main"},
                                   {"interval_s", 900},
                                   {"points", 400},
                                   {"factor", 1.8},
                                   {"offset", 32.0}}));
}

}  // namespace
}  // namespace recald::views::zoomable_chart_test
