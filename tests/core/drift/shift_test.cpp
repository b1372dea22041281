#include "core/drift/shift.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/random/rng.hpp"

namespace recald::drift {
namespace {

Eigen::VectorXd normals(Eigen::Index count, double mean, double sd, std::uint64_t seed) {
  Rng rng{seed};
  Eigen::VectorXd draws(count);
  for (double& draw : draws) draw = mean + sd * rng.normal();
  return draws;
}

TEST(Shift, OfNormalsIsTheClosedForm) {
  const Shift shift = shift_between(normals(40'000, 0.0, 1.0, 1), normals(40'000, 3.0, 2.0, 2));
  EXPECT_NEAR(shift.standardised, 3.0 / std::sqrt(5.0), 0.02);
  const double overlap = std::sqrt(2.0 * 2.0 / 5.0) * std::exp(-0.25 * 9.0 / 5.0);
  EXPECT_NEAR(shift.hellinger, std::sqrt(1.0 - overlap), 0.01);
  EXPECT_NEAR(shift.increased, 0.5 * std::erfc(-3.0 / std::sqrt(5.0) / std::sqrt(2.0)), 0.01);
}

TEST(Shift, WassersteinOfAMovedSampleIsTheMove) {
  const Eigen::VectorXd then = normals(777, 5.0, 1.0, 3);
  EXPECT_NEAR(shift_between(then, then.array() + 2.5).wasserstein, 2.5, 1e-12);
  EXPECT_NEAR(shift_between(then.array() + 2.5, then).wasserstein, 2.5, 1e-12);
}

TEST(Shift, NumbersOfDrawsMayDiffer) {
  const Shift shift = shift_between(Eigen::Vector2d{0.0, 1.0}, Eigen::Vector4d{0.0, 0.0, 1.0, 1.0});
  EXPECT_NEAR(shift.wasserstein, 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(shift.increased, 0.5);
}

TEST(Shift, OfNothingIsNothing) {
  const Eigen::VectorXd draws = normals(500, 1.0, 0.3, 4);
  const Shift shift = shift_between(draws, draws);
  EXPECT_EQ(shift.standardised, 0.0);
  EXPECT_EQ(shift.wasserstein, 0.0);
  EXPECT_NEAR(shift.hellinger, 0.0, 1e-7);
}

}  // namespace
}  // namespace recald::drift
