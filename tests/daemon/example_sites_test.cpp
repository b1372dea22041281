// The example sites: that they are read, and, where the measured data are at hand, that the known
// defects of each recording come out as flags and words and not as wrong figures.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "daemon/commands/open_site.hpp"
#include "daemon/site/replay/recording.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/support/data_folders.hpp"

namespace recald::daemon {
namespace {

using ::testing::HasSubstr;

std::filesystem::path example(const std::string& name) {
  return std::filesystem::path{RECALD_SOURCE_DIR} / "daemon/examples" / (name + ".toml");
}

std::filesystem::path data_folder() { return recald::testing::others_data("."); }

metering::Month month(int year, unsigned number) {
  return std::chrono::year{year} / std::chrono::month{number};
}

/// Whether any finding of the meter has the words.
bool says(const MeterRecord& record, std::string_view words) {
  return std::ranges::any_of(record.findings, [&](const metering::DataFinding& finding) {
    return finding.sentence.find(words) != std::string::npos;
  });
}

const metering::MonthlyFigure& figure(const MeterRecord& record, metering::Month wanted) {
  return *std::ranges::find(record.figures, wanted, &metering::MonthlyFigure::month);
}

class RealSite : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(data_folder() / "real")) {
      GTEST_SKIP() << "no measured data at " << data_folder() << "; set RECALD_DATA";
    }
    ::setenv("RECALD_DATA", data_folder().c_str(), 1);
  }

  static Recording record(const std::string& name) {
    const auto site = open_site(example(name));
    EXPECT_TRUE(site.has_value()) << site.error().front();
    VirtualClock clock{metering::Instant{}};
    auto recording = replay_meters(site->config, site->calendar, {}, clock, {});
    EXPECT_TRUE(recording.has_value()) << recording.error().message;
    return std::move(*recording);
  }
};

TEST(ExampleSites, EveryKeyIsKnown) {
  const auto site = load_site(example("every-key"));
  ASSERT_TRUE(site.has_value()) << site.error().front();
  EXPECT_EQ(site->meters.size(), 12u);
  EXPECT_EQ(site->buses.size(), 2u);
  EXPECT_TRUE(site->building->air->economiser_lockout_C.has_value());
}

TEST_F(RealSite, CambridgeB25IsAnotherBuildingFromNovember2016On) {
  const Recording recording = record("cambridge-b25");
  const MeterRecord& electricity = recording.meters[0];
  for (metering::Month m = month(2015, 1); m <= month(2018, 12); m = metering::next_month(m)) {
    EXPECT_EQ(metering::is_different(electricity.level_changes, m), m >= month(2016, 11))
        << metering::to_string(m);
    EXPECT_EQ(is_site_different(recording, m), m >= month(2016, 11)) << metering::to_string(m);
  }
  EXPECT_TRUE(says(electricity, "exactly zero"));  // 23 hours in June 2018
}

TEST_F(RealSite, CambridgeB25GasLosesAMonthAndChangesItsUnit) {
  const Recording recording = record("cambridge-b25");
  const MeterRecord& gas = recording.meters[1];
  EXPECT_EQ(gas.meter.interval, std::chrono::hours{1});
  EXPECT_TRUE(gas.in_file->interval_inferred);
  EXPECT_FALSE(figure(gas, month(2017, 12)).usable);
  EXPECT_TRUE(says(gas, "treated as no data"));
  EXPECT_TRUE(says(gas, "probably a changed unit or multiplier"));
  EXPECT_TRUE(metering::is_different(gas.level_changes, month(2018, 1)));
  EXPECT_FALSE(metering::is_different(gas.level_changes, month(2016, 10)));
}

TEST_F(RealSite, HillsideCorrectionsAreNoPeaks) {
  const Recording recording = record("openeis-hillside");
  const MeterRecord& gas = recording.meters[1];
  EXPECT_TRUE(says(gas, "negative"));
  for (const metering::MonthlyFigure& f : gas.figures) {
    // 16,849 kBtu/h of correction would be 4,938 kW; the boiler's own winter peaks are near 560.
    if (f.peak) {
      EXPECT_LT(f.peak->kW, 700.0) << metering::to_string(f.month);
    }
  }
  EXPECT_FALSE(figure(gas, month(2009, 9)).usable);
}

TEST_F(RealSite, LoadshapeCarriesItsBlankStretches) {
  const Recording recording = record("lbl-loadshape-15min");
  const MeterRecord& electricity = recording.meters[0];
  EXPECT_EQ(electricity.meter.interval, std::chrono::minutes{15});
  EXPECT_EQ(electricity.rows.blanks, 743u);
  EXPECT_GT(figure(electricity, month(2013, 8)).coverage, 0.98);
  EXPECT_LT(figure(electricity, month(2013, 9)).coverage, 0.65);
  EXPECT_TRUE(figure(electricity, month(2013, 9)).peak->could_be_exceeded);
}

// Floor area is unpublished: a wide prior, and the tool has to say what it cannot know.
TEST_F(RealSite, CambridgeB25Calibrates) {
  const auto outcome = testing::run({"calibrate", example("cambridge-b25").string(), "--json",
                                     "--draws", "4000", "--burn-in", "1000", "--chains", "2"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  const auto cvrmse = [&](const char* stage, const char* period) {
    return json[stage][period]["gas_daily_kWh"]["cvrmse"].get<double>();
  };
  EXPECT_LT(cvrmse("forecast", "calibration"), 0.5 * cvrmse("prior_mean", "calibration"));
  EXPECT_LT(cvrmse("forecast", "validation"), 0.5 * cvrmse("prior_mean", "validation"));
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("May 2015 is left out"));
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("not constant over the year"));
  EXPECT_FALSE(json["outputs"][0]["calibrated"].get<bool>());  // electricity is its own profile
}

}  // namespace
}  // namespace recald::daemon
