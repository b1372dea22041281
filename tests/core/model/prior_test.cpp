#include "core/model/prior.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace recald {
namespace {

using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Closed form, worked by hand: outdoor air of -70/+20 % about 1, and +-100 % about 1.
TEST(TriangularPrior, QuantilesAndMomentsOfWorkedExamples) {
  const Prior skewed{0.3, 1.0, 1.2};
  EXPECT_NEAR(skewed.cumulative(1.0), 0.777778, 5e-7);
  EXPECT_NEAR(skewed.quantile(0.05), 0.477482, 5e-7);
  EXPECT_NEAR(skewed.quantile(0.50), 0.861249, 5e-7);
  EXPECT_NEAR(skewed.quantile(0.90), 1.065836, 5e-7);
  EXPECT_NEAR(skewed.mean(), 0.833333, 5e-7);
  EXPECT_NEAR(std::sqrt(skewed.variance()), 0.192931, 5e-7);

  const Prior symmetric{0.0, 1.0, 2.0};
  EXPECT_NEAR(symmetric.quantile(0.05), 0.316228, 5e-7);
  EXPECT_NEAR(symmetric.quantile(0.50), 1.000000, 5e-7);
  EXPECT_NEAR(symmetric.quantile(0.90), 1.552786, 5e-7);
  EXPECT_NEAR(std::sqrt(symmetric.variance()), 0.408248, 5e-7);
}

// Against Boost's distributions: quantiles of the cut ones through the uncut.
TEST(TruncatedNormalPrior, QuantilesMatchTheUncutNormal) {
  const Prior prior{TruncatedNormalPrior{24.0, 1.5, 22.0, 27.0}};
  const boost::math::normal_distribution<> uncut(24.0, 1.5);
  const double low = cdf(uncut, 22.0);
  const double high = cdf(uncut, 27.0);
  for (int i = 1; i < 100; ++i) {
    const double u = i / 100.0;
    EXPECT_NEAR(prior.quantile(u), quantile(uncut, low + u * (high - low)), 1e-12 * 24.0) << u;
    const double value = 22.0 + 5.0 * u;
    EXPECT_NEAR(prior.density(value), pdf(uncut, value) / (high - low), 1e-12);
  }
}

TEST(LogNormalPrior, QuantilesMatchTheUncutLogNormal) {
  const Prior prior{LogNormalPrior{0.4, 0.7}};
  const boost::math::lognormal_distribution<> uncut(std::log(0.4), 0.7);
  for (int i = 1; i < 100; ++i) {
    const double u = i / 100.0;
    EXPECT_NEAR(prior.quantile(u) / quantile(uncut, u), 1.0, 1e-12) << u;
    EXPECT_NEAR(prior.cumulative(prior.quantile(u)), u, 1e-12);
  }
  EXPECT_NEAR(prior.mean(), boost::math::mean(uncut), 1e-12);
  EXPECT_NEAR(prior.variance(), boost::math::variance(uncut), 1e-12);
  EXPECT_NEAR(prior.mode(), boost::math::mode(uncut), 1e-12);
}

// Beyond eight standard deviations 1 - Phi has no digits left: the tail has to be kept as itself.
TEST(TruncatedNormalPrior, KeepsItsDigitsFarOutInATail) {
  const Prior prior{TruncatedNormalPrior{0.0, 1.0, 6.0, 7.0}};
  EXPECT_NEAR(prior.cumulative(prior.quantile(0.3)), 0.3, 1e-12);
  EXPECT_GT(prior.quantile(0.01), 6.0);
  EXPECT_LT(prior.quantile(0.99), 7.0);
  const Prior mirrored{TruncatedNormalPrior{0.0, 1.0, -7.0, -6.0}};
  EXPECT_NEAR(mirrored.quantile(0.7), -prior.quantile(0.3), 1e-12);
}

struct Named {
  const char* name;
  Prior prior;
  friend void PrintTo(const Named& named, std::ostream* out) { *out << named.name; }
};

class AnyPrior : public ::testing::TestWithParam<Named> {
 protected:
  const Prior& prior() const { return GetParam().prior; }
  double low() const { return std::max(prior().min(), prior().quantile(1e-4)); }
  double high() const { return std::min(prior().max(), prior().quantile(1.0 - 1e-4)); }
};

TEST_P(AnyPrior, QuantileInvertsCumulative) {
  for (int i = 1; i < 1000; ++i) {
    const double u = i / 1000.0;
    const double value = prior().quantile(u);
    EXPECT_GE(value, prior().min());
    EXPECT_LE(value, prior().max());
    EXPECT_NEAR(prior().cumulative(value), u, 1e-12);
  }
}

TEST_P(AnyPrior, DensityIsTheSlopeOfCumulative) {
  const double range = high() - low();
  const double h = 1e-6 * range;
  for (int i = 1; i < 200; ++i) {
    const double value = low() + range * i / 200.0;
    if (std::abs(value - prior().mode()) < 2.0 * h) continue;  // the kink of a triangle
    const double slope = (prior().cumulative(value + h) - prior().cumulative(value - h)) / (2 * h);
    EXPECT_NEAR(prior().density(value), slope, 1e-5 * (1.0 / range + slope));
  }
  if (std::isfinite(prior().min())) {
    EXPECT_EQ(prior().density(prior().min() - h), 0.0);
    EXPECT_EQ(prior().cumulative(prior().min() - h), 0.0);
  }
  if (std::isfinite(prior().max())) {
    EXPECT_EQ(prior().density(prior().max() + h), 0.0);
    EXPECT_EQ(prior().cumulative(prior().max() + h), 1.0);
  }
}

// Mean and variance as integrals over normal scores, by the midpoint rule.
TEST_P(AnyPrior, MomentsMatchQuadrature) {
  constexpr int n = 200'000;
  constexpr double width = 16.0;
  double mass = 0.0;
  double mean = 0.0;
  double square = 0.0;
  for (int i = 0; i < n; ++i) {
    const double score = -8.0 + width * (i + 0.5) / n;
    const double weight = std::exp(-0.5 * score * score);
    const double value = prior().at_score(score).value;
    mass += weight;
    mean += weight * value;
    square += weight * value * value;
  }
  mean /= mass;
  square /= mass;
  const double scale = std::sqrt(prior().variance());
  EXPECT_NEAR(mean, prior().mean(), 1e-8 * scale);
  EXPECT_NEAR(square - mean * mean, prior().variance(), 1e-7 * scale * scale);
}

TEST_P(AnyPrior, ScoreGivesTheQuantileAndItsSlope) {
  const boost::math::normal_distribution<> standard;
  for (double score = -5.0; score <= 5.0; score += 0.0937) {
    const auto [value, derivative] = prior().at_score(score);
    EXPECT_NEAR(value, prior().quantile(cdf(standard, score)), 1e-9 * std::abs(value) + 1e-9);
    constexpr double h = 1e-6;
    const double difference =
        (prior().at_score(score + h).value - prior().at_score(score - h).value) / (2 * h);
    EXPECT_NEAR(derivative, difference, 1e-7 + 1e-6 * std::abs(difference)) << score;
  }
  // Nothing breaks where the normal tail leaves the range of doubles.
  for (const double score : {-60.0, -38.6, 38.6, 60.0}) {
    const auto [value, derivative] = prior().at_score(score);
    EXPECT_TRUE(std::isfinite(value)) << score;
    EXPECT_TRUE(std::isfinite(derivative)) << score;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, AnyPrior,
    ::testing::Values(Named{"skewed", {0.3, 1.0, 1.2}}, Named{"mode_at_low_end", {0.0, 0.0, 2.0}},
                      Named{"mode_at_high_end", {-5.0, 3.0, 3.0}},
                      Named{"set_point", {20.0, 23.5, 28.0}},
                      Named{"uniform", UniformPrior{-1.0, 4.0}},
                      Named{"normal", TruncatedNormalPrior{3.0, 2.0}},
                      Named{"cut_below", TruncatedNormalPrior{1.0, 2.0, 0.0}},
                      Named{"cut_both", TruncatedNormalPrior{24.0, 1.5, 22.0, 25.0}},
                      Named{"log_normal", LogNormalPrior{0.4, 0.5}},
                      Named{"log_normal_cut", LogNormalPrior{0.4, 0.9, 0.1, 1.0}}),
    [](const auto& given) { return given.param.name; });

TEST(Prior, AcceptsAModeAtEitherEnd) {
  EXPECT_TRUE(Prior::make(TriangularPrior{0.0, 0.0, 1.0}).has_value());
  EXPECT_TRUE(Prior::make(TriangularPrior{0.0, 1.0, 1.0}).has_value());
}

TEST(Prior, RefusesNumbersThatMakeNoDistribution) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Prior::Distribution> bad{TriangularPrior{2.0, 1.0, 3.0},
                                             TriangularPrior{0.0, 4.0, 3.0},
                                             TriangularPrior{1.0, 1.0, 1.0},
                                             TriangularPrior{nan, 1.0, 2.0},
                                             TriangularPrior{0.0, 1.0, kInfinity},
                                             UniformPrior{1.0, 1.0},
                                             UniformPrior{0.0, kInfinity},
                                             TruncatedNormalPrior{0.0, 0.0},
                                             TruncatedNormalPrior{0.0, -1.0},
                                             TruncatedNormalPrior{nan, 1.0},
                                             TruncatedNormalPrior{0.0, 1.0, 2.0, 1},
                                             TruncatedNormalPrior{0.0, 1.0, 9.0, 10.0},
                                             LogNormalPrior{0.0, 1.0},
                                             LogNormalPrior{1.0, 0.0},
                                             LogNormalPrior{1.0, 1.0, -1.0},
                                             LogNormalPrior{1.0, 0.1, 5.0, 6.0}};
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const auto prior = Prior::make(bad[i]);
    ASSERT_FALSE(prior.has_value()) << i;
    EXPECT_EQ(prior.error().code, ErrorCode::invalid_value);
  }
  EXPECT_THAT(Prior::make(TriangularPrior{2.0, 1.0, 3.0}).error().message,
              HasSubstr("min = 2, mode = 1, max = 3"));
  EXPECT_THAT(Prior::make(TruncatedNormalPrior{0.0, 1.0, 9.0, 10.0}).error().message,
              HasSubstr("recald cannot draw from it"));
}

TEST(Prior, IsReadByTheNameOfItsDistribution) {
  const auto named = [](const char* name, PriorNumbers numbers) {
    return Prior::named(name, numbers);
  };
  EXPECT_EQ(named("triangular", {1.0, 2.0, 3.0, {}}).value(), (Prior{1.0, 2.0, 3.0}));
  EXPECT_EQ(named("uniform", {1.0, {}, 3.0, {}}).value(), Prior(UniformPrior{1.0, 3.0}));
  EXPECT_EQ(named("truncated_normal", {{}, 2.0, 3.0, 0.5}).value(),
            Prior(TruncatedNormalPrior{2.0, 0.5, -kInfinity, 3.0}));
  EXPECT_EQ(named("log_normal", {{}, 2.0, {}, 0.5}).value(), Prior(LogNormalPrior{2.0, 0.5}));
  for (const char* name : {"triangular", "uniform", "truncated_normal", "log_normal"}) {
    EXPECT_THAT(named(name, {1.0, {}, {}, {}}).error().message, HasSubstr(name));
  }
  EXPECT_THAT(named("beta", {1.0, 2.0, 3.0, {}}).error().message,
              HasSubstr("has the distribution 'beta'"));
}

}  // namespace
}  // namespace recald
