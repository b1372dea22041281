#include "core/statistics/minimise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace recald {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

// Rosenbrock's valley, its usual beginning.
TEST(Minimise, FollowsABentValley) {
  int calls = 0;
  const auto valley = [&](const VectorXd& x, VectorXd& gradient) {
    ++calls;
    const double across = x(1) - x(0) * x(0);
    gradient.resize(2);
    gradient << -400.0 * x(0) * across - 2.0 * (1.0 - x(0)), 200.0 * across;
    return 100.0 * across * across + (1.0 - x(0)) * (1.0 - x(0));
  };
  const VectorXd lowest = minimise(valley, Vector2d(-1.2, 1.0));
  VectorXd gradient;
  EXPECT_LT(valley(lowest, gradient), 0.01);
  EXPECT_LT(calls, 80);
}

TEST(Minimise, StaysWhereTheFunctionExists) {
  const auto barrier = [](const VectorXd& x, VectorXd& gradient) {
    if (x(0) <= 0.0) return std::numeric_limits<double>::infinity();
    gradient = VectorXd::Constant(1, 1.0 - 0.01 / x(0));
    return x(0) - 0.01 * std::log(x(0));
  };
  EXPECT_NEAR(minimise(barrier, VectorXd::Constant(1, 3.0))(0), 0.01, 0.01);
}

}  // namespace
}  // namespace recald
