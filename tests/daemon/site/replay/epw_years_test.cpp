/// [weather] with a list of EPW files, each a recorded year of its own.
#include <gmock/gmock.h>

#include <cstdio>

#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/site_weather.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::epw_years_test {
namespace {

using metering::LocalCalendar;
using metering::MonthRange;
using ::testing::HasSubstr;

/// A year whose dry bulb is its last two digits.
std::string epw_of(int year, bool is_typical = false) {
  std::string text =
      "LOCATION,Somewhere,ST,Land,X,123456,40.0,-105.2,0.0,100.0\nDESIGN CONDITIONS,0\n"
      "TYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\nHOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\n"
      "COMMENTS 1,\nCOMMENTS 2,\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n";
  const std::chrono::sys_days begin{std::chrono::year{year} / 1 / 1};
  for (auto date = begin; date < std::chrono::sys_days{std::chrono::year{year + 1} / 1 / 1};
       date += std::chrono::days{1}) {
    const std::chrono::year_month_day parts{date};
    const auto month = static_cast<unsigned>(parts.month());
    for (int hour = 1; hour <= 24; ++hour) {
      char row[256];
      std::snprintf(row, sizeof row,
                    "%d,%u,%u,%d,0,?9,%d.0,1.0,50,82300,9999,9999,300,100,200,50,0,0,0,0,270,3.5,"
                    "0,0,16,77777,9,999999999,5,0.0,0,88,0,0,0\n",
                    is_typical ? year - static_cast<int>(month) : year, month,
                    static_cast<unsigned>(parts.day()), hour, year % 100);
      text += row;
    }
  }
  return text;
}

class EpwYears : public ::testing::Test {
 protected:
  Result<SiteWeather> load(const std::string& list) {
    const auto site = parse_site(
        "[site]\nid = \"a\"\ntimezone = \"Etc/UTC\"\nlatitude_deg = 40.0\nlongitude_deg = -105.2\n"
        "[[meter]]\nid = \"m\"\nutility = \"gas\"\nfile = \"r.csv\"\n[weather]\nformat = \"epw\"\n"
        "file = " +
            list + "\n",
        folder_ / "site.toml");
    EXPECT_TRUE(site.has_value()) << site.error().front();
    const MonthRange months{std::chrono::year{2021} / 6, std::chrono::year{2023} / 6};
    return load_weather(*site, *LocalCalendar::open("Etc/UTC"), months);
  }

  void write(const std::string& name, const std::string& text) {
    recald::testing::write_text(folder_ / name, text);
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(EpwYears, FollowEachOtherInWhateverOrderTheyAreListed) {
  for (const int year : {2021, 2022, 2023}) write(std::to_string(year) + ".epw", epw_of(year));
  const auto weather = load("[\"2022.epw\", \"2023.epw\", \"2021.epw\"]");
  ASSERT_TRUE(weather.has_value()) << weather.error().message;
  for (const int year : {2021, 2022, 2023}) {
    const metering::Instant july = std::chrono::sys_days{std::chrono::year{year} / 7 / 1};
    const weather::WeatherHour* hour = weather->filled.series.find(july);
    ASSERT_NE(hour, nullptr) << year;
    EXPECT_DOUBLE_EQ(hour->dry_bulb_C, year % 100);
  }
}

TEST_F(EpwYears, OneTwiceOrATypicalOneIsASentence) {
  write("a.epw", epw_of(2021));
  write("b.epw", epw_of(2021));
  write("typical.epw", epw_of(2022, true));
  EXPECT_EQ(load("[\"a.epw\", \"b.epw\"]").error().message,
            "a.epw and b.epw are of the same year; list one of them");
  EXPECT_EQ(load("[\"a.epw\", \"typical.epw\"]").error().message,
            "typical.epw is a typical year; only recorded years may be listed");
}

TEST(EpwYearsConfig, OnlyEpwFilesMayBeAList) {
  const auto site = parse_site(
      "[site]\nid = \"a\"\ntimezone = \"Etc/UTC\"\n[[meter]]\nid = \"m\"\nutility = \"gas\"\n"
      "file = \"r.csv\"\n[weather]\nfile = [\"a.csv\", \"b.csv\"]\n",
      "/nowhere/site.toml");
  ASSERT_FALSE(site.has_value());
  EXPECT_THAT(site.error().front(), HasSubstr("site.toml:9: [weather] 'file' lists several files"));
}

}  // namespace
}  // namespace recald::daemon::epw_years_test
