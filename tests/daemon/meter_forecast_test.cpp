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

using Json = nlohmann::json;
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
  [[nodiscard]] Json calibrated(const std::string& out) const {
    const Outcome outcome = run({"calibrate", path("site.toml"), "--out", path(out)});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("a regression of the meter's days on temperature"));
    return Json::parse(read_text(folder_ / out / "calibration.json"));
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
  const Json result = calibrated("out");
  EXPECT_EQ(result["model"], "change_point");
  EXPECT_THAT(result["parameters"], SizeIs(0));
  EXPECT_THAT(result["predictions"], SizeIs(2 * 12));
  for (const char* output : {"electricity_daily_kWh", "district_heat_daily_kWh"}) {
    const Json& unseen = result["forecast"]["validation"][output];
    EXPECT_EQ(unseen["months"], 3) << output;
    EXPECT_LT(unseen["cvrmse"], 0.05) << output;
    EXPECT_LT(std::abs(unseen["nmbe_sim_minus_meas"].get<double>()), 0.05) << output;
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "months.csv"));
}

TEST_F(MeterForecast, ATemperatureIsEnough) {
  const Json before = calibrated("before");
  keep_temperature_alone();
  const Json after = calibrated("after");
  EXPECT_EQ(before["forecast"], after["forecast"]);
  EXPECT_EQ(before["predictions"], after["predictions"]);
}

TEST_F(MeterForecast, OptionsOfAModelAreRefused) {
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--model", "epc"},
                                                  {"--discrepancy", "seed"},
                                                  {"--prior-sensitivity"}}) {
    std::vector<std::string> words{"calibrate", path("site.toml")};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = run(words);
    EXPECT_NE(outcome.exit_code, 0) << options.front();
    EXPECT_THAT(outcome.err, HasSubstr("has no [[model]], so --model, --discrepancy"))
        << options[0];
  }
}

TEST_F(MeterForecast, WithoutAPeriodEachMeterHasItsOwnMonths) {
  // The heat meter came in May.
  std::istringstream all{read_text(folder_ / "readings.csv")};
  std::string kept;
  for (std::string line; std::getline(all, line);) {
    if (line.find(",heat,") == std::string::npos || line >= "2021-05") kept += line + "\n";
  }
  write_text(folder_ / "readings.csv", kept);
  write_text(folder_ / "site.toml", std::string{recald::testing::kSampleMeters} +
                                        "[weather]\nfile = \"weather.csv\"\nvalues = \"mean\"\n");
  const Json result = calibrated("out");
  EXPECT_EQ(result["months"][0]["month"], "2021-01");
  EXPECT_THAT(result["months"], SizeIs(12));
  EXPECT_EQ(result["forecast"]["three_months_left_out"]["electricity_daily_kWh"]["months"], 12);
  EXPECT_EQ(result["forecast"]["three_months_left_out"]["district_heat_daily_kWh"]["months"], 8);
}

/// A model of which electricity alone is metered, and parameters that do not move it.
class UntoldModel : public MeterForecast {
 protected:
  UntoldModel() {
    write_text(folder_ / "site.toml",
               recald::testing::edited(
                   recald::testing::edited(recald::testing::sample_site(),
                                           R"(outputs = ["electricity", "district_heat"])",
                                           R"(outputs = ["electricity"])"),
                   "weights = { district_heat = 0.8 }\n", ""));
  }
  const std::string why_ =
      "The model is not calibrated: its parameters need at least 4 monthly figures of meters that "
      "they move, and there are 0. Electricity is not fitted. The calibration parameters move it "
      "by ";
};

TEST_F(UntoldModel, IsNotCalibratedAndMetersAreForecast) {
  const Outcome outcome = run({"calibrate", path("site.toml"), "--out", path("out")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(why_));
  const Json result = Json::parse(read_text(folder_ / "out" / "calibration.json"));
  EXPECT_EQ(result["status"], "forecast");
  EXPECT_THAT(result["not_calibrated_because"].get<std::string>(), HasSubstr(why_));
  EXPECT_LT(result["forecast"]["validation"]["electricity_daily_kWh"]["cvrmse"], 0.05);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "report.html"));
}

TEST_F(UntoldModel, HasThePageOfItsMeters) {
  const Outcome outcome = run({"report", path("site.toml"), "--out", path("page.html")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string page = read_text(folder_ / "page.html");
  EXPECT_THAT(page, HasSubstr("<h1>Meters of Tram depot</h1>"));
  EXPECT_THAT(page, HasSubstr(why_));
  EXPECT_THAT(page, HasSubstr("data-figure=\"temperature\""));
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
