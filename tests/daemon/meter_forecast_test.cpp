/// `recald calibrate` on a site that has meters and a temperature, and no model.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/daemon/command_line.hpp"
#include "tests/daemon/depot_year.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::meter_forecast_test {
namespace {

using nlohmann::json;
using recald::daemon::testing::Outcome;
using recald::daemon::testing::run;
using recald::testing::read_text;
using recald::testing::write_text;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::string_view kWeatherAndPeriod = R"(
[weather]
file = "weather.csv"
values = "mean"

[period]
calibration = { from = "2021-01", to = "2021-09" }
validation = { from = "2021-10", to = "2021-12" }
)";

class MeterForecast : public ::testing::Test {
 protected:
  MeterForecast() {
    recald::testing::write_depot_year(
        folder_ / "", std::string{recald::testing::kSampleMeters} + std::string{kWeatherAndPeriod});
  }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }
  [[nodiscard]] json calibrated(const std::string& out) const {
    const Outcome outcome = run({"calibrate", path("site.toml"), "--out", path(out)});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("a regression of the meter's days on temperature"));
    return json::parse(read_text(folder_ / out / "calibration.json"));
  }
  /// Only the first two columns of the weather are left.
  void keep_temperature_alone() const {
    std::istringstream all{read_text(folder_ / "weather.csv")};
    std::string kept;
    for (std::string line; std::getline(all, line);) {
      kept += line.substr(0, line.find(',', line.find(',') + 1)) + "\n";
    }
    write_text(folder_ / "weather.csv", kept);
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(MeterForecast, EveryMeterIsForecastFromItsDays) {
  const json result = calibrated("out");
  EXPECT_EQ(result["model"], "change_point");
  EXPECT_THAT(result["parameters"], SizeIs(0));
  EXPECT_THAT(result["predictions"], SizeIs(2 * 12));
  for (const char* output : {"electricity_daily_kWh", "district_heat_daily_kWh"}) {
    const json& unseen = result["forecast"]["validation"][output];
    EXPECT_EQ(unseen["months"], 3) << output;
    EXPECT_EQ(unseen, result["yardstick"]["validation"][output]);
    EXPECT_LT(unseen["cvrmse"], 0.05) << output;
    EXPECT_LT(std::abs(unseen["nmbe_sim_minus_meas"].get<double>()), 0.05) << output;
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "months.csv"));
}

TEST_F(MeterForecast, ATemperatureIsEnough) {
  const json before = calibrated("before");
  keep_temperature_alone();
  const json after = calibrated("after");
  EXPECT_EQ(before["forecast"], after["forecast"]);
  EXPECT_EQ(before["predictions"], after["predictions"]);
}

TEST_F(MeterForecast, WithoutATemperatureItSaysWhichMonthsLackIt) {
  write_text(folder_ / "weather.csv",
             "timestamp,dry_bulb_C\n2019-01-01T00:00:00Z,4.0\n2019-01-01T01:00:00Z,3.9\n");
  const Outcome outcome = run({"calibrate", path("site.toml")});
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("the weather has no temperature in any month from 2021-01"));
}

}  // namespace
}  // namespace recald::daemon::meter_forecast_test
