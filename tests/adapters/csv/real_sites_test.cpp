/// Recorded sites through ingestion to monthly figures. The measurements are other people's and are
/// not part of the project: the tests look for them and are skipped without them. Expected figures
/// were computed by a separate script that knows nothing of this code: sums and maxima over the
/// local month, gaps filled by the mean of the same wall-clock time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "adapters/csv/readings_csv.hpp"
#include "adapters/csv/weather_csv.hpp"
#include "core/metering/months/level_change.hpp"
#include "core/metering/months/month_closer.hpp"
#include "tests/support/data_folders.hpp"

namespace recald::real_sites_test {
namespace {

using metering::LevelChange;
using metering::LevelChangeKind;
using metering::Meter;
using metering::Month;
using metering::MonthlyFigure;
using metering::Reason;
using metering::Utility;
using std::chrono::hours;
using std::chrono::seconds;

std::filesystem::path site_folder(const std::string& site) {
  return testing::others_data("real") / site;
}

Month month(const std::string& text) { return *metering::parse_month(text); }

struct Site {
  std::map<std::string, std::vector<MonthlyFigure>> figures;
  std::map<std::string, Utility> utilities;
  csv::ReadingsReport report;

  [[nodiscard]] const MonthlyFigure& at(const std::string& meter, const std::string& when) const {
    for (const MonthlyFigure& figure : figures.at(meter)) {
      if (figure.month == month(when)) return figure;
    }
    throw std::out_of_range{when};
  }
  [[nodiscard]] std::vector<LevelChange> changes(const std::string& meter) const {
    return find_level_changes(meter, figures.at(meter),
                              metering::level_change_options(utilities.at(meter)));
  }
};

Meter meter(std::string id, Utility utility, std::optional<seconds> zero_run_max) {
  Meter made;
  made.id = std::move(id);
  made.utility = utility;
  made.zero_run_max = zero_run_max;
  return made;
}

Site ingest(const std::filesystem::path& folder, const char* zone,
            const std::vector<Meter>& meters) {
  Site site;
  csv::ReadingsOptions options;
  for (const Meter& m : meters) {
    options.meters.push_back({});
    options.meters.back().name = m.id;
    options.meters.back().utility = m.utility;
    site.utilities[m.id] = m.utility;
  }
  metering::MonthCloser closer{
      *metering::LocalCalendar::open(zone), meters, {}, [&](metering::ClosedMonth&& closed) {
        site.figures[meters[closed.meter].id].push_back(closed.figure);
      }};
  csv::ReadingsSink sink;
  sink.on_meter = [&](const csv::MeterInFile& shown) {
    closer.set_grid(shown.meter, shown.interval, shown.phase);
  };
  sink.on_reading = [&](const metering::Reading& reading) { closer.add(reading); };
  auto report = csv::read_readings(folder / "meters.csv", options, sink);
  EXPECT_TRUE(report.has_value()) << report.error().message;
  closer.finish();
  site.report = std::move(*report);
  return site;
}

#define SKIP_WITHOUT(folder)                                                        \
  if (!std::filesystem::exists((folder) / "meters.csv")) {                          \
    GTEST_SKIP() << (folder) << " is not here; set RECALD_DATA to the data folder"; \
  }

Site cambridge_b25(const std::filesystem::path& folder) {
  return ingest(folder, "Europe/London",
                {meter("electricity", Utility::electricity, hours{2}),
                 meter("gas", Utility::gas, hours{48})});
}

TEST(RealSites, CambridgeB25MonthlyFigures) {
  const auto folder = site_folder("cambridge-b25");
  SKIP_WITHOUT(folder);
  const Site site = cambridge_b25(folder);
  EXPECT_EQ(site.report.readings, 70'128u);
  EXPECT_EQ(site.report.issues.total, 0u);
  EXPECT_EQ(site.report.meters.at(0).shown.interval, hours{1});

  const MonthlyFigure& march = site.at("electricity", "2016-03");
  EXPECT_EQ(march.slots, 743);
  EXPECT_NEAR(march.daily_average_kWh, 95981.4 / 31.0, 1e-6);
  EXPECT_NEAR(march.peak->kW, 193.6, 1e-9);
  EXPECT_EQ(metering::to_string(march.peak->start), "2016-03-02T12:00:00Z");
  EXPECT_FALSE(march.peak->could_be_exceeded);
  EXPECT_NEAR(site.at("electricity", "2015-10").daily_average_kWh, 75798.9 / 31.0, 1e-6);
  EXPECT_EQ(site.at("electricity", "2015-10").slots, 745);
  EXPECT_NEAR(site.at("gas", "2016-01").daily_average_kWh, 208850.0 / 31.0, 1e-6);
}

// 23 hours of zeros that mean no data are estimated; five weeks of zeros make two months unusable.
TEST(RealSites, CambridgeB25ZerosThatMeanNoData) {
  const auto folder = site_folder("cambridge-b25");
  SKIP_WITHOUT(folder);
  const Site site = cambridge_b25(folder);
  const MonthlyFigure& june = site.at("electricity", "2018-06");
  EXPECT_NEAR(june.daily_average_kWh, 1528.807586, 1e-5);
  EXPECT_NEAR(june.daily_average_variance_kWh2, 40.28690539, 1e-6);
  EXPECT_EQ(june.slots_by_validity[static_cast<std::size_t>(metering::Validity::suspect)], 23);
  EXPECT_TRUE(has(june.reasons, Reason::zero_run));
  EXPECT_TRUE(june.usable);
  for (const char* when : {"2017-11", "2017-12"}) {
    const MonthlyFigure& gas = site.at("gas", when);
    EXPECT_FALSE(gas.usable);
    EXPECT_NE(gas.unusable_because.find("zero_run"), std::string::npos) << gas.unusable_because;
  }
  EXPECT_TRUE(site.at("gas", "2018-01").usable);
}

TEST(RealSites, CambridgeB25IsDifferentFromNovember2016On) {
  const auto folder = site_folder("cambridge-b25");
  SKIP_WITHOUT(folder);
  const Site site = cambridge_b25(folder);
  const auto electricity = site.changes("electricity");
  ASSERT_EQ(electricity.size(), 1u);
  EXPECT_EQ(electricity[0].since, month("2016-11"));
  EXPECT_NEAR(electricity[0].ratio, 1.198, 0.002);
  for (Month at = month("2016-11"); at <= month("2018-12"); at = metering::next_month(at)) {
    EXPECT_TRUE(is_different(electricity, at));
  }
  EXPECT_FALSE(is_different(electricity, month("2016-10")));

  const auto gas = site.changes("gas");
  ASSERT_EQ(gas.size(), 2u);
  EXPECT_EQ(gas[0].kind, LevelChangeKind::level);
  EXPECT_EQ(gas[1].kind, LevelChangeKind::scale);
  EXPECT_EQ(gas[1].since, month("2018-01"));
  EXPECT_NEAR(1.0 / gas[1].factor, 31.0, 8.0);
}

// Not the building the rule was made on: its gas changes unit in June 2018, its electricity falls
// from 2019 on, and two good years before are left in peace.
TEST(RealSites, CambridgeB40ChangesAreFoundWhereTheyAre) {
  const auto folder = site_folder("cambridge-b40");
  SKIP_WITHOUT(folder);
  const Site site = ingest(folder, "Europe/London",
                           {meter("electricity", Utility::electricity, hours{2}),
                            meter("gas", Utility::gas, hours{48})});
  const auto gas = site.changes("gas");
  ASSERT_EQ(gas.size(), 1u);
  EXPECT_EQ(gas[0].kind, LevelChangeKind::scale);
  EXPECT_EQ(gas[0].since, month("2018-06"));
  const auto electricity = site.changes("electricity");
  ASSERT_EQ(electricity.size(), 1u);
  EXPECT_EQ(electricity[0].since, month("2019-09"));
  EXPECT_FALSE(site.at("gas", "2018-05").usable);  // three weeks of zeros
}

TEST(RealSites, HillsideCorrectionsNeverBecomePeaks) {
  const auto folder = site_folder("openeis-hillside");
  SKIP_WITHOUT(folder);
  const Site site = ingest(folder, "America/Los_Angeles",
                           {meter("electricity", Utility::electricity, hours{2}),
                            meter("boiler_gas", Utility::gas, {})});
  EXPECT_EQ(site.report.issues.total, 0u);
  EXPECT_NEAR(site.at("electricity", "2010-03").daily_average_kWh, 106605.47 / 31.0, 1e-6);
  const MonthlyFigure& november = site.at("electricity", "2010-11");
  EXPECT_EQ(november.slots, 721);  // the repeated hour was lost in the export
  EXPECT_NEAR(november.daily_average_kWh, 3558.7332, 1e-4);
  EXPECT_NEAR(november.daily_average_variance_kWh2, 0.02739629, 1e-7);
  EXPECT_NEAR(site.at("boiler_gas", "2010-02").daily_average_kWh, 3984.508337, 1e-5);
  EXPECT_NEAR(site.at("boiler_gas", "2011-12").daily_average_kWh, 2907.470657, 1e-5);
  EXPECT_NEAR(site.at("boiler_gas", "2011-12").daily_average_variance_kWh2, 3.66667072, 1e-6);

  int negatives = 0;
  for (const MonthlyFigure& figure : site.figures.at("boiler_gas")) {
    // 16 of 33,900 hours lie below −300 kBtu/h; the largest believed hour of any winter is 603 kW,
    // those of the corrections reach 4,938 kW.
    if (figure.peak) {
      EXPECT_LT(figure.peak->kW, 650.0) << metering::to_string(figure.month);
    }
    if (has(figure.reasons, Reason::negative)) ++negatives;
  }
  EXPECT_EQ(negatives, 5);  // November of each winter and December 2011
  EXPECT_TRUE(has(site.at("boiler_gas", "2012-11").reasons, Reason::range));
  EXPECT_TRUE(site.changes("electricity").empty());
  EXPECT_TRUE(site.changes("boiler_gas").empty());
}

TEST(RealSites, LoadshapeQuarterHoursCarryTheirGaps) {
  const auto folder = site_folder("lbl-loadshape-15min");
  SKIP_WITHOUT(folder);
  const Site site =
      ingest(folder, "America/Los_Angeles", {meter("electricity", Utility::electricity, hours{2})});
  EXPECT_EQ(site.report.meters.at(0).shown.interval, seconds{900});
  EXPECT_EQ(site.report.meters.at(0).blanks, 743u);
  const MonthlyFigure& august = site.at("electricity", "2013-08");
  EXPECT_NEAR(august.daily_average_kWh, 169.368099, 1e-6);
  EXPECT_NEAR(august.daily_average_variance_kWh2, 0.91318008, 1e-7);
  EXPECT_NEAR(august.coverage, 2944.0 / 2976.0, 1e-12);
  const MonthlyFigure& september = site.at("electricity", "2013-09");
  EXPECT_NEAR(september.daily_average_kWh, 182.016862, 1e-6);
  EXPECT_NEAR(september.coverage, 1785.0 / 2880.0, 1e-12);
  EXPECT_TRUE(september.peak->could_be_exceeded);
  // Gaps of days: independent slots would claim 1.38 (kWh/day)², whole days say far more.
  EXPECT_GT(september.daily_average_variance_kWh2, 20.0);
}

TEST(RealSites, CambridgeWeatherReportsItsGaps) {
  const auto folder = site_folder("cambridge-b25");
  SKIP_WITHOUT(folder);
  const auto csv = csv::read_weather(folder / "weather.csv", {});
  ASSERT_TRUE(csv.has_value()) << csv.error().message;
  EXPECT_EQ(csv->rows, 34'276u);
  EXPECT_EQ(csv->ignored_columns, (std::vector<std::string>{"dew_point_C", "msl_pressure_hPa"}));
  const auto filled =
      weather::fill_gaps(csv->series, *metering::LocalCalendar::open("Europe/London"));
  ASSERT_EQ(filled.coverage.size(), 48u);
  const auto& july = filled.coverage.at(18);  // the station was silent from 18 July 2016
  EXPECT_EQ(july.month, month("2016-07"));
  EXPECT_LT(july.measured[0], 0.6);
  EXPECT_GT(july.typical[0], 0.4);
  for (const auto& hour : filled.series.hours) EXPECT_FALSE(std::isnan(hour.dry_bulb_C));
}

// The Met Office reads its stations at the hour and sums the sunshine of the hour before.
TEST(RealSites, CambridgeWeatherShowsThatItIsReadAtTheHour) {
  for (const char* site : {"cambridge-b25", "cambridge-b40"}) {
    const auto folder = site_folder(site);
    SKIP_WITHOUT(folder);
    const auto csv = csv::read_weather(folder / "weather.csv", {.stamps = csv::Stamps::end});
    ASSERT_TRUE(csv.has_value()) << csv.error().message;
    EXPECT_EQ(csv->values,
              (weather::ValuesTaken{weather::RecordedValues::instant, weather::KnownBy::inferred}));
  }
}

}  // namespace
}  // namespace recald::real_sites_test
