/// Keys of a [[meter]] that is read from an export.
#include "daemon/site/config/table_config.hpp"

#include <gmock/gmock.h>

#include "daemon/site/config/site_config.hpp"

namespace recald::daemon::table_config_test {
namespace {

using table::Container;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

tl::expected<SiteConfig, Problems> parse(const std::string& keys) {
  return parse_site(
      "[site]\nid = \"a\"\ntimezone = \"Europe/Berlin\"\n[[meter]]\nid = \"m\"\n"
      "utility = \"gas\"\n" +
          keys,
      "/nowhere/site.toml");
}

std::optional<TableConfig> table_of(const std::string& keys) {
  const auto site = parse(keys);
  EXPECT_TRUE(site.has_value()) << site.error().front();
  return site ? site->meters.front().table : std::nullopt;
}

TEST(TableConfig, AFileWithoutFurtherKeysIsOurOwn) {
  EXPECT_FALSE(table_of("file = \"readings.csv\"\n").has_value());
  EXPECT_FALSE(table_of("file = \"feed.xml\"\nformat = \"readings\"\n").has_value());
}

TEST(TableConfig, TheFormatFollowsFromTheNameOrTheKeys) {
  const std::string columns = "time_column = \"t\"\ncolumn = \"v\"\nunit = \"kWh\"\n";
  EXPECT_EQ(table_of("file = \"a.csv\"\n" + columns)->shape.container, Container::text);
  EXPECT_EQ(table_of("file = \"a.XLSX\"\n" + columns)->shape.container, Container::xlsx);
  EXPECT_EQ(table_of("file = \"a.xml\"\n")->shape.container, Container::green_button);
  EXPECT_EQ(table_of("file = \"a.txt\"\nformat = \"green_button\"\n")->column, "value");
}

TEST(TableConfig, EveryKeyArrives) {
  const auto config = table_of(
      "file = \"a.csv\"\nseparator = \"tab\"\ndecimal = \",\"\ntime_column = \"Day\"\n"
      "clock_column = \"Hour\"\ntime_format = \"mm/dd/yyyy\"\ntimezone = \"Etc/GMT-1\"\n"
      "column = \"Use\"\nmeter_column = \"Point\"\nunit_column = \"Unit\"\n");
  ASSERT_TRUE(config.has_value());
  EXPECT_EQ(config->shape, (table::TableShape{.separator = '\t',
                                              .decimal = ',',
                                              .time_column = "Day",
                                              .clock_column = "Hour",
                                              .time_format = table::TimeFormat::month_first,
                                              .timezone = "Etc/GMT-1",
                                              .meter_column = "Point",
                                              .unit_column = "Unit"}));
  EXPECT_EQ(config->column, "Use");
}

TEST(TableConfig, AClockColumnCountsByTheMetersInterval) {
  const std::string rest =
      "file = \"a.csv\"\ntime_column = \"t\"\ncolumn = \"v\"\nunit = \"kWh\"\n";
  const auto numbered = table_of(
      rest + "clock_column = \"h\"\nclock_format = \"interval_number\"\ninterval = \"15m\"\n");
  ASSERT_TRUE(numbered.has_value());
  EXPECT_EQ(numbered->shape.clock_format, table::ClockFormat::interval_number);
  EXPECT_EQ(numbered->shape.interval, std::chrono::minutes{15});
  EXPECT_EQ(
      table_of(rest + "clock_column = \"h\"\nclock_format = \"hour_ending\"\n")->shape.interval,
      std::chrono::hours{1});
  EXPECT_EQ(table_of(rest + "clock_column = \"h\"\ninterval = \"15m\"\n")->shape.interval,
            std::chrono::seconds{0});
  EXPECT_THAT(parse(rest + "clock_format = \"hour_ending\"\n").error(),
              ElementsAre(HasSubstr("says what a 'clock_column' counts")));
  EXPECT_THAT(
      parse(rest + "clock_column = \"h\"\nclock_format = \"hour_ending\"\nstamps = \"end\"\n")
          .error(),
      ElementsAre(HasSubstr("stands for its whole interval")));
}

TEST(TableConfig, WhatIsMissingOrTwiceIsSaid) {
  EXPECT_THAT(parse("file = \"a.csv\"\ndecimal = \",\"\n").error(),
              ElementsAre(HasSubstr("'time_column' is missing"), HasSubstr("'column' is missing"),
                          HasSubstr("'unit' is missing: what the values are in")));
  EXPECT_THAT(parse("file = \"a.csv\"\ntime_column = \"t\"\ncolumn = \"v\"\nunit = \"kWh\"\n"
                    "unit_column = \"u\"\n")
                  .error(),
              ElementsAre(HasSubstr("'unit' and 'unit_column' are both there")));
}

TEST(TableConfig, AUnitIsCheckedWithTheMeter) {
  const std::string gas = "file = \"a.csv\"\ntime_column = \"t\"\ncolumn = \"v\"\nunit = \"CCF\"\n";
  EXPECT_THAT(parse(gas).error(), ElementsAre(HasSubstr("give gas_kWh_per_m3")));
  EXPECT_TRUE(parse(gas + "gas_kWh_per_m3 = 10.4\n").has_value());
  EXPECT_THAT(
      parse("file = \"a.csv\"\ntime_column = \"t\"\ncolumn = \"v\"\nunit = \"lb\"\n").error(),
      ElementsAre(HasSubstr("only a steam meter may have it")));
}

}  // namespace
}  // namespace recald::daemon::table_config_test
