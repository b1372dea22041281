#include "core/drift/month_hindcast.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace recald::drift {
namespace {

// Errors of the same size both ways; with fewer nobody knows.
TEST(HindcastBand, IsStudentsOfTheNextError) {
  const std::vector<double> errors{-0.1, 0.1, -0.1, 0.1, -0.1, 0.1};
  EXPECT_FALSE(band_of_errors(std::span{errors}.first(5)).has_value());
  const auto band = band_of_errors(errors);
  ASSERT_TRUE(band.has_value());
  EXPECT_NEAR(band->middle, 0.0, 1e-12);
  // t(0.95, 5) = 2.015, sd = 0.1095, sqrt(1 + 1/6) = 1.080
  EXPECT_NEAR(band->high, 2.0150 * 0.109545 * 1.080123, 1e-4);
  EXPECT_NEAR(band->low, -band->high, 1e-12);
  EXPECT_NEAR(forecast_scale_kW(20.0, 20.0), 20.0, 1e-12);
  EXPECT_NEAR(forecast_scale_kW(80.0, 20.0), 40.0, 1e-12);
  EXPECT_NEAR(forecast_scale_kW(-1.0, 20.0), std::sqrt(4.0 * 20.0), 1e-12);
}

}  // namespace
}  // namespace recald::drift
