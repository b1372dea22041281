#include "core/drift/watch/calibration_check.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "core/random/rng.hpp"

namespace recald::drift {
namespace {

/// u_t = r u_(t-1) + sqrt(1 - r^2) e_t, then scaled and moved.
std::vector<double> stream(Rng& rng, int count, double lag_one, double mean, double sd) {
  std::vector<double> u;
  double last = rng.normal();
  for (int i = 0; i < count; ++i) {
    u.push_back(mean + sd * last);
    last = lag_one * last + std::sqrt(1.0 - lag_one * lag_one) * rng.normal();
  }
  return u;
}

double share_refused(double lag_one, double mean, double sd, int count = 36) {
  Rng rng{21};
  int refused = 0;
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    refused += check_calibration(stream(rng, count, lag_one, mean, sd))->pvalue < 0.05 ? 1 : 0;
  }
  return static_cast<double>(refused) / kRuns;
}

TEST(CalibrationCheck, RefusesTrueForecastsAsOftenAsStated) {
  EXPECT_NEAR(share_refused(0.0, 0.0, 1.0, 120), 0.05, 0.02);
  EXPECT_LT(share_refused(0.0, 0.0, 1.0, 24), 0.09);
}

TEST(CalibrationCheck, SeesBiasSpreadAndMemory) {
  EXPECT_GT(share_refused(0.0, 0.8, 1.0), 0.9);
  EXPECT_GT(share_refused(0.0, 0.0, 1.6), 0.9);
  EXPECT_GT(share_refused(0.0, 0.0, 0.5), 0.9);
  EXPECT_GT(share_refused(0.7, 0.0, 1.0), 0.9);
}

TEST(CalibrationCheck, SaysWhatItSaw) {
  Rng rng{22};
  const auto check = check_calibration(stream(rng, 4000, 0.5, 0.3, 1.2));
  ASSERT_TRUE(check.has_value());
  EXPECT_NEAR(check->mean, 0.3, 0.15);
  EXPECT_NEAR(check->sd, 1.2, 0.06);
  EXPECT_NEAR(check->lag_one, 0.5, 0.05);
}

TEST(CalibrationCheck, NeedsEightMonths) {
  const std::vector<double> few(7, 0.1);
  const auto check = check_calibration(few);
  ASSERT_FALSE(check.has_value());
  EXPECT_EQ(check.error().code, ErrorCode::not_enough_data);
  EXPECT_TRUE(check_calibration(std::vector<double>(8, 0.0)).has_value());
}

}  // namespace
}  // namespace recald::drift
