#include "core/model/parameter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace recald {
namespace {

using testing::HasSubstr;

// Closed form, worked by hand: outdoor air of -70/+20 % about 1, and +-100 % about 1.
TEST(TriangularPrior, QuantilesAndMomentsOfWorkedExamples) {
  const TriangularPrior skewed{0.3, 1.0, 1.2};
  EXPECT_NEAR(skewed.cumulative(1.0), 0.777778, 5e-7);
  EXPECT_NEAR(skewed.quantile(0.05), 0.477482, 5e-7);
  EXPECT_NEAR(skewed.quantile(0.50), 0.861249, 5e-7);
  EXPECT_NEAR(skewed.quantile(0.90), 1.065836, 5e-7);
  EXPECT_NEAR(skewed.mean(), 0.833333, 5e-7);
  EXPECT_NEAR(std::sqrt(skewed.variance()), 0.192931, 5e-7);

  const TriangularPrior symmetric{0.0, 1.0, 2.0};
  EXPECT_NEAR(symmetric.quantile(0.05), 0.316228, 5e-7);
  EXPECT_NEAR(symmetric.quantile(0.50), 1.000000, 5e-7);
  EXPECT_NEAR(symmetric.quantile(0.90), 1.552786, 5e-7);
  EXPECT_NEAR(std::sqrt(symmetric.variance()), 0.408248, 5e-7);
}

class AnyTriangle : public testing::TestWithParam<TriangularPrior> {};

TEST_P(AnyTriangle, QuantileInvertsCumulative) {
  const TriangularPrior prior = GetParam();
  for (int i = 0; i <= 1000; ++i) {
    const double u = i / 1000.0;
    const double value = prior.quantile(u);
    EXPECT_GE(value, prior.min);
    EXPECT_LE(value, prior.max);
    EXPECT_NEAR(prior.cumulative(value), u, 1e-12);
  }
}

TEST_P(AnyTriangle, DensityIsTheSlopeOfCumulative) {
  const TriangularPrior prior = GetParam();
  const double range = prior.max - prior.min;
  const double h = 1e-6 * range;
  for (int i = 1; i < 200; ++i) {
    const double value = prior.min + range * i / 200.0;
    if (std::abs(value - prior.mode) < 2.0 * h) continue;  // the kink
    const double slope = (prior.cumulative(value + h) - prior.cumulative(value - h)) / (2.0 * h);
    EXPECT_NEAR(slope * range, prior.density(value) * range, 1e-8);
  }
  EXPECT_EQ(prior.density(prior.min - h), 0.0);
  EXPECT_EQ(prior.density(prior.max + h), 0.0);
  EXPECT_EQ(prior.cumulative(prior.min - h), 0.0);
  EXPECT_EQ(prior.cumulative(prior.max + h), 1.0);
}

// Mean and variance as integrals of the quantile function, by the midpoint rule.
TEST_P(AnyTriangle, MomentsMatchQuadrature) {
  const TriangularPrior prior = GetParam();
  constexpr int n = 200'000;
  double mean = 0.0;
  double square = 0.0;
  for (int i = 0; i < n; ++i) {
    const double value = prior.quantile((i + 0.5) / n);
    mean += value / n;
    square += value * value / n;
  }
  const double range = prior.max - prior.min;
  EXPECT_NEAR(mean, prior.mean(), 1e-6 * range);
  EXPECT_NEAR(square - mean * mean, prior.variance(), 1e-6 * range * range);
}

INSTANTIATE_TEST_SUITE_P(Shapes, AnyTriangle,
                         testing::Values(TriangularPrior{0.3, 1.0, 1.2},
                                         TriangularPrior{0.0, 0.0, 2.0},   // mode at the low end
                                         TriangularPrior{-5.0, 3.0, 3.0},  // at the high end
                                         TriangularPrior{20.0, 23.5, 28.0}));

TEST(TriangularPrior, AcceptsAModeAtEitherEnd) {
  EXPECT_TRUE(TriangularPrior::make(0.0, 0.0, 1.0).has_value());
  EXPECT_TRUE(TriangularPrior::make(0.0, 1.0, 1.0).has_value());
}

TEST(TriangularPrior, RefusesNumbersOutOfOrder) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const TriangularPrior bad[] = {{2.0, 1.0, 3.0}, {0.0, 4.0, 3.0}, {1.0, 1.0, 1.0},
                                 {3.0, 2.0, 1.0}, {nan, 1.0, 2.0}, {0.0, 1.0, inf}};
  for (const auto& [min, mode, max] : bad) {
    const auto prior = TriangularPrior::make(min, mode, max);
    ASSERT_FALSE(prior.has_value()) << min << ' ' << mode << ' ' << max;
    EXPECT_EQ(prior.error().code, ErrorCode::invalid_value);
  }
  EXPECT_THAT(TriangularPrior::make(2.0, 1.0, 3.0).error().message,
              HasSubstr("min = 2, mode = 1, max = 3"));
}

TEST(Parameter, ValuesAreDescribedWithTheirUnits) {
  const std::vector<Parameter> parameters{{"set_point", "degC", {20.0, 23.5, 28.0}},
                                          {"leakage", "", {0.0, 1.0, 2.0}}};
  const std::vector<double> values{23.25, 0.5};
  EXPECT_EQ(describe(parameters, values), "set_point = 23.25 degC, leakage = 0.5");
}

}  // namespace
}  // namespace recald
