/// The generated models in EnergyPlus itself, over three days. Skipped where there is none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "simulators/energyplus/hidden_truth.hpp"
#include "simulators/energyplus/run_readings.hpp"
#include "simulators/energyplus/weather_files.hpp"
#include "tests/support/installed_energyplus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::simulators::energyplus::models_in_energyplus_test {
namespace {

using recald::testing::TemporaryFolder;
using recald::testing::write_text;

class ModelsInEnergyPlus : public ::testing::Test {
 protected:
  void SetUp() override {
    program_ = recald::testing::installed_energyplus(RECALD_ENERGYPLUS_ENVIRONMENT);
    if (program_.empty()) GTEST_SKIP() << "there is no EnergyPlus; set RECALD_ENERGYPLUS";
    const auto calendar = metering::LocalCalendar::open("America/New_York").value();
    const Place place{33.65, -84.43, 308.0};
    const auto hours = simulate_hours(hot_humid_climate(place), 2021, 1, 1, calendar);
    write_text(folder_ / "2021.epw", epw_text(hours, 2021, place, calendar, {}));
  }

  /// kWh by meter of three days of a month, in the order of `district_meters`.
  std::array<double, 3> run(Json model, int month) {
    auto& period = model["RunPeriod"]["Year"];
    period["begin_month"] = month;
    period["end_month"] = month;
    period["begin_day_of_month"] = 5;
    period["end_day_of_month"] = 7;
    for (const RunMeter& meter : district_meters()) {
      model["Output:Meter"][meter.id] = {{"key_name", meter.reported},
                                         {"reporting_frequency", "Timestep"}};
    }
    model["Output:SQLite"]["results"]["option_type"] = "Simple";
    write_text(folder_ / "in.epJSON", model.dump());
    const std::string command = "cd " + folder_.path().string() + " && " + program_.string() +
                                " --weather 2021.epw --output-directory . in.epJSON >log 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::ostringstream said;
    said << std::ifstream(folder_ / "eplusout.err").rdbuf();
    EXPECT_EQ(said.str().find("** Severe"), std::string::npos) << said.str();
    return sums();
  }

  std::array<double, 3> sums() {
    const auto text = readings_csv({.runs = {folder_ / "eplusout.sql"},
                                    .meters = district_meters(),
                                    .standard_offset = std::chrono::hours{-5},
                                    .noise_share = 0.0,
                                    .lost_share = 0.0});
    EXPECT_TRUE(text.has_value()) << text.error().message;
    std::array<double, 3> sum_kWh{};
    std::istringstream rows(text.value_or(""));
    std::size_t count = 0;
    for (std::string row; std::getline(rows, row);) {
      if (count++ == 0) continue;
      const std::string value = row.substr(row.find(',', row.find(',') + 1) + 1);
      sum_kWh[(count - 2) % 3] += std::stod(value);
    }
    EXPECT_EQ(count, 1u + 3u * 3u * 96u);
    return sum_kWh;
  }

  TemporaryFolder folder_;
  std::filesystem::path program_;
};

TEST_F(ModelsInEnergyPlus, TheLaboratoryHasItsMetersInSummerAndWinter) {
  const auto [electricity, cooling, heat] = run(laboratory_model({}), 7);
  EXPECT_GT(electricity, 5000.0);
  EXPECT_GT(cooling, 5000.0);
  EXPECT_GT(heat, 100.0) << "the laboratories reheat all year";
  const auto winter = run(laboratory_model({}), 1);
  EXPECT_LT(winter[1], cooling);
  EXPECT_GT(winter[2], heat);
}

TEST_F(ModelsInEnergyPlus, TheLaboratorysTrueParametersMoveEachMeter) {
  const auto drawn = run(laboratory_model({}), 7);
  LaboratoryParameters less_air;
  less_air.laboratory_outdoor_m3_s = {4.0, 4.0};
  EXPECT_LT(run(laboratory_model(less_air), 7)[1], 0.9 * drawn[1]);
  const auto truth = run(laboratory_model(laboratory_truth(1).parameters), 7);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    EXPECT_GT(std::abs(truth[i] - drawn[i]), 0.005 * drawn[i]) << i;
  }
}

TEST_F(ModelsInEnergyPlus, TheSmallOfficeHasItsMetersAndMoreLightIsMoreElectricity) {
  const auto summer = run(small_office_model({}), 7);
  EXPECT_GT(summer[1], 10.0);
  SmallOfficeParameters brighter;
  brighter.lighting_W_m2 *= 2.0;
  const auto bright = run(small_office_model(brighter), 7);
  EXPECT_GT(bright[0], 1.2 * summer[0]);
  EXPECT_GT(bright[1], summer[1]);
  EXPECT_GT(run(small_office_model({}), 1)[2], 10.0);
}

}  // namespace
}  // namespace recald::simulators::energyplus::models_in_energyplus_test
