#include "core/savings/measure.hpp"

#include <gtest/gtest.h>

namespace recald::savings::measure_test {
namespace {

TEST(Measure, ChangesSetScaleAndAdd) {
  EXPECT_DOUBLE_EQ(model::changed(ChangeKind::set, 24.0, 25.5), 25.5);
  EXPECT_DOUBLE_EQ(model::changed(ChangeKind::scale, 5.0, 0.7), 3.5);
  EXPECT_DOUBLE_EQ(model::changed(ChangeKind::add, 24.0, -1.5), 22.5);
}

TEST(Measure, WhatIsAchievedIsANumberOrTriangular) {
  EXPECT_DOUBLE_EQ((Achieved{0.6, 0.6, 0.6}.quantile(0.1)), 0.6);
  const Achieved uncertain{0.5, 0.6, 0.9};
  EXPECT_DOUBLE_EQ(uncertain.quantile(0.25), 0.6);  // a quarter of the mass lies below the mode
  EXPECT_GT(uncertain.quantile(0.9), 0.75);
}

}  // namespace
}  // namespace recald::savings::measure_test
