#include "core/model/hourly/hourly_model.hpp"

#include <gtest/gtest.h>

#include "tests/support/allocations.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::model::hourly::hourly_model_test {
namespace {

using testing::sample_building;
using testing::sample_drivers;

const std::vector<MeterMap>& meters() {
  static const std::vector<MeterMap> maps = {*default_meter_map(metering::Utility::electricity),
                                             *default_meter_map(metering::Utility::chilled_water)};
  return maps;
}

HourlyModel make_model(std::shared_ptr<const Drivers> drivers,
                       std::vector<std::shared_ptr<const Alteration>> alterations = {}) {
  return {sample_building(),
          {*find_parameter("outdoor_airflow"), *find_parameter("cooling_setpoint")},
          meters(),
          {{1, OutputKind::daily_kWh}, {1, OutputKind::peak_kW}, {0, OutputKind::daily_kWh}},
          std::move(drivers),
          {.steps_per_hour = 4},
          std::move(alterations)};
}

struct OneMoreKilowatt final : Alteration {
  void record(std::span<const DriverHour>, int, std::span<double> power_kW) const override {
    for (double& power : power_kW) power += 1.0;
  }
};

TEST(HourlyModel, GivesDailyAveragesAndPeaksOfLocalMonths) {
  const Building building = sample_building();
  const auto drivers = std::make_shared<const Drivers>(sample_drivers(building, 4));
  HourlyModel model = make_model(drivers);
  ASSERT_EQ(model.month_count(), 4);
  std::vector<double> outputs(12);
  const double theta[] = {building.air->outdoor_air_m3_s, building.set_points.cooling_occupied_C};
  model.evaluate(theta, outputs);

  Hourly hourly{drivers, {.steps_per_hour = 4}};
  Eigen::ArrayXXd power_kW(hourly.step_count(), 2);
  hourly.run(building, {}, meters(), power_kW);
  // March 2021 has 31 days and 743 hours; January and February go before.
  const auto march_kW = power_kW.middleRows(4 * (744 + 672), 4 * 743);
  EXPECT_NEAR(outputs[2], march_kW.col(1).sum() / 4.0 / 31.0, 1e-9);
  EXPECT_DOUBLE_EQ(outputs[4 + 2], march_kW.col(1).maxCoeff());
  EXPECT_NEAR(outputs[8 + 2], march_kW.col(0).sum() / 4.0 / 31.0, 1e-9);
}

TEST(HourlyModel, LightsAndPlugsFollowTheirParameters) {
  const Building building = sample_building();
  MeterMap lights;
  lights[EndUse::lighting] = 1.0;
  MeterMap plugs;
  plugs[EndUse::plugs] = 1.0;
  HourlyModel model{
      building,
      {*find_parameter("lighting_use"), *find_parameter("plug_use")},
      {lights, plugs, meters()[1]},
      {{0, OutputKind::daily_kWh}, {1, OutputKind::daily_kWh}, {2, OutputKind::daily_kWh}},
      std::make_shared<const Drivers>(sample_drivers(building, 1))};
  const std::vector<double> before = recald::evaluate(model, std::array{1.0, 1.0});
  const std::vector<double> after = recald::evaluate(model, std::array{0.6, 0.5});
  EXPECT_NEAR(after[0], 0.6 * before[0], 1e-9 * before[0]);
  EXPECT_NEAR(after[1], 0.5 * before[1], 1e-9 * before[1]);
  EXPECT_LT(after[2], before[2]);
}

TEST(HourlyModel, CarriesItsAlterationsIntoClones) {
  const auto drivers = std::make_shared<const Drivers>(sample_drivers(sample_building(), 2));
  HourlyModel plain = make_model(drivers);
  std::unique_ptr<MonthlyModel> copy;
  {
    const HourlyModel altered = make_model(drivers, {std::make_shared<OneMoreKilowatt>()});
    copy = altered.clone();
  }
  const double theta[] = {7.0, 23.0};
  std::vector<double> before(6);
  std::vector<double> after(6);
  plain.evaluate(theta, before);
  copy->evaluate(theta, after);
  EXPECT_NEAR(after[2] - before[2], 1.0, 1e-9);
  EXPECT_NEAR(after[1] - before[1], 24.0, 1e-6);
}

TEST(HourlyModel, RespondsToItsParametersAndDoesNotAllocate) {
  const auto drivers = std::make_shared<const Drivers>(sample_drivers(sample_building(), 2));
  HourlyModel model = make_model(drivers);
  std::vector<double> cool(6);
  std::vector<double> warm(6);
  const double low[] = {6.0, 23.0};
  const double high[] = {6.0, 26.0};
  model.evaluate(low, cool);
  const long before = testing::allocation_count();
  model.evaluate(high, warm);
  EXPECT_EQ(testing::allocation_count(), before);
  EXPECT_LT(warm[0], cool[0]);
  model.evaluate(low, warm);
  EXPECT_EQ(warm, cool);
}

}  // namespace
}  // namespace recald::model::hourly::hourly_model_test
