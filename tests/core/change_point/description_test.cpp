#include <gtest/gtest.h>

#include "core/change_point/regression.hpp"
#include "core/display/unit.hpp"
#include "tests/core/change_point/simulated_meter.hpp"

namespace recald::change_point::description_test {
namespace {

TEST(DescribeRegression, SaysBaseLoadsAndSlopes) {
  Regression regression{};
  regression.base_kWh = {12345.6, 80.04, 80.04};
  regression.base_number = {0, 1, 1};
  regression.curves = {curve_5p()};
  EXPECT_EQ(describe(regression),
            "5-parameter: 12300 kWh/day on workdays, 80 on Saturdays and Sundays and holidays; 30 "
            "kWh/day more per K below 8 °C; 40 kWh/day more per K above 16 °C.");
}

TEST(DescribeRegression, SaysWhereConsumptionFalls) {
  Regression regression{};
  regression.base_kWh = {1000.0, 1000.0, 1000.0};
  regression.curves = {curve_4p()};
  EXPECT_EQ(describe(regression),
            "4-parameter: 1000 kWh/day; 30 kWh/day more per K below 12 °C; 8 kWh/day less per "
            "K above 12 °C.");
}

TEST(DescribeRegression, HasASentenceForEachCurve) {
  Regression regression{};
  regression.base_kWh = {0.3456, 0.0, -2.0};
  regression.base_number = {0, 1, 2};
  regression.curves = {curve_3p_cooling(), Curve{}};
  regression.curve_of = {0, 1, 1};
  EXPECT_EQ(describe(regression),
            "3-parameter cooling: 0.346 kWh/day on workdays; 40 kWh/day more per K above 12 "
            "°C. No temperature: 0 kWh/day on Saturdays, -2 on Sundays and holidays.");
}

TEST(DescribeRegression, SpeaksIpWhereAsked) {
  Regression regression{};
  regression.base_kWh = {351.6853, 351.6853, 351.6853};
  regression.curves = {curve_4p()};
  const auto ip = display::UnitSystem::ip;
  EXPECT_EQ(describe(regression, display::meter_units(ip, metering::Utility::chilled_water),
                     display::unit_of(ip, "degC")),
            "4-parameter: 100 ton-hours/day; 4.74 ton-hours/day more per °F below 53.6 °F; 1.26 "
            "ton-hours/day less per °F above 53.6 °F.");
}

}  // namespace
}  // namespace recald::change_point::description_test
