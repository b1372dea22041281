#include "simulators/effects/slow_value.hpp"

#include <gtest/gtest.h>

namespace recald::simulators::slow_value_test {
namespace {

TEST(SlowValue, StartsAtItsFirstTarget) {
  SlowValue value(3600.0);
  EXPECT_DOUBLE_EQ(value.follow(20.0, 300.0), 20.0);
}

// After one time constant 1 - 1/e = 0.632 121 of the way is done, however it was cut into steps.
TEST(SlowValue, FollowsByItsTimeConstantAtAnyStep) {
  for (const double step_s : {300.0, 900.0, 3600.0}) {
    SCOPED_TRACE(step_s);
    SlowValue value(3600.0);
    value.follow(0.0, step_s);
    for (double done_s = 0.0; done_s < 3600.0; done_s += step_s) value.follow(10.0, step_s);
    EXPECT_NEAR(value.value(), 6.321206, 1e-6);
  }
}

TEST(Hysteresis, KeepsItsStateBetweenTheLimits) {
  Hysteresis fan(20.0, 22.0);
  EXPECT_FALSE(fan.update(21.0));
  EXPECT_TRUE(fan.update(22.5));
  EXPECT_TRUE(fan.update(20.5));
  EXPECT_FALSE(fan.update(19.9));
  EXPECT_FALSE(fan.update(21.9));
}

TEST(Ramp, RisesOrFallsBetweenItsEnds) {
  EXPECT_DOUBLE_EQ(ramp(4.0, 5.0, 7.0), 0.0);
  EXPECT_DOUBLE_EQ(ramp(5.5, 5.0, 7.0), 0.25);
  EXPECT_DOUBLE_EQ(ramp(8.0, 5.0, 7.0), 1.0);
  EXPECT_DOUBLE_EQ(ramp(5.5, 7.0, 5.0), 0.75);
  EXPECT_DOUBLE_EQ(ramp(4.0, 7.0, 5.0), 1.0);
}

}  // namespace
}  // namespace recald::simulators::slow_value_test
