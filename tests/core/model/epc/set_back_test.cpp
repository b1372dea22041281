#include "core/model/epc/set_back.hpp"

#include <gtest/gtest.h>

namespace recald::model::epc::set_back_test {
namespace {

// A night: 21 °C let go, held at 16 °C, free temperature 3 °C, τ = 30 h, 12 h long.
TEST(SetBack, WorkedNight) {
  EXPECT_NEAR(mean_drift_temperature_C(21.0, 16.0, 3.0, 30.0, 12.0), 17.923772, 1e-6);
}

/// Steps through the same night in seconds.
double stepped_mean_C(double start_C, double limit_C, double free_C, double tau_h,
                      double length_h) {
  const double step_h = 1.0 / 3600.0;
  double zone_C = start_C;
  double sum = 0.0;
  double steps = 0.0;
  for (double t = 0.0; t < length_h; t += step_h) {
    sum += zone_C;
    steps += 1.0;
    zone_C += (free_C - zone_C) * step_h / tau_h;
    const bool past = start_C > limit_C ? zone_C < limit_C : zone_C > limit_C;
    if (past && (limit_C - start_C) * (free_C - start_C) > 0.0) zone_C = limit_C;
  }
  return sum / steps;
}

TEST(SetBack, AgreesWithSmallSteps) {
  struct Case {
    double start_C, limit_C, free_C, tau_h, length_h;
  };
  for (const Case& c :
       {Case{21, 16, 3, 30, 12}, Case{21, 16, 19, 30, 60}, Case{24, 28, 35, 20, 62},
        Case{24, 28, 26, 20, 12}, Case{21, 16, 23, 40, 12}, Case{24, 30, 12, 40, 12}}) {
    SCOPED_TRACE(::testing::Message() << c.start_C << " -> " << c.free_C);
    EXPECT_NEAR(mean_drift_temperature_C(c.start_C, c.limit_C, c.free_C, c.tau_h, c.length_h),
                stepped_mean_C(c.start_C, c.limit_C, c.free_C, c.tau_h, c.length_h), 2e-3);
  }
}

TEST(SetBack, LimitAtTheStartHoldsTheStart) {
  EXPECT_NEAR(mean_drift_temperature_C(21.0, 21.0, 3.0, 30.0, 12.0), 21.0, 1e-12);
}

}  // namespace
}  // namespace recald::model::epc::set_back_test
