#include "core/assessment/common_errors.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/core/calibration/toy_models.hpp"

namespace recald::assessment {
namespace {

/// One meter's daily averages, then its peaks, of two months: both grow with the heat in the zone.
calibration::FunctionModel model_of(double zone_heat_share) {
  return {1, 2, 2, [=](std::span<const double> theta, std::span<double> values) {
            const double daily = theta[0] * (1.0 + zone_heat_share);
            values[0] = daily;
            values[1] = 2.0 * daily;
            values[2] = 10.0;
            values[3] = 20.0;
          }};
}

TEST(CommonErrors, AreOfTheHeatShareAndOfEachMetersPeaks) {
  model::Building building;
  building.use.zone_heat_share = 0.8;
  const ModelFactory make = [](const model::Building& of) {
    return model_of(of.use.zone_heat_share).clone();
  };
  auto model = model_of(0.8);
  const std::vector<OutputCalibration> outputs{
      {.name = "gas_daily_kWh", .meter_id = "gas", .unit = "kWh/day"},
      {.name = "gas_peak_kW", .meter_id = "gas", .unit = "kW"}};

  const auto errors = common_errors(building, make, outputs, model, std::vector<double>{100.0});

  ASSERT_EQ(errors.size(), 2U);
  // 15 % less of a share of 0.8 are 0.12 of 100.
  EXPECT_TRUE(errors[0].isApprox(Eigen::Vector4d(12.0, 24.0, 0.0, 0.0), 1e-12));
  EXPECT_TRUE(errors[1].isApprox(Eigen::Vector4d(0.0, 0.0, 0.8, 1.6), 1e-12));
}

TEST(CommonErrors, GainByUseIsThatOfDoubledLightsAndPlugs) {
  model::ElectricLoads loads;
  loads.month_factor.fill(0.5);
  const double more = more_use(loads).month_factor.front();
  EXPECT_DOUBLE_EQ(more, 0.55);
  const auto on = [](double factor) {
    return calibration::FunctionModel{1, 1, 2,
                                      [=](std::span<const double> theta, std::span<double> values) {
                                        values[0] = theta[0] + 40.0 * factor;
                                        values[1] = theta[0] - 6.0 * factor;
                                      }};
  };
  auto base = on(0.5);
  auto with_more = on(more);

  const auto gain = gain_by_use(base, with_more, std::vector<double>{7.0});

  EXPECT_NEAR(gain[0], 20.0, 1e-9);
  EXPECT_NEAR(gain[1], -3.0, 1e-9);
}

}  // namespace
}  // namespace recald::assessment
