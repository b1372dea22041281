#include "tests/blind/scoring/intervals.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::blind {
namespace {

struct Published {
  int hits;
  int cases;
  double low_percent;
  double high_percent;
  double rounding;  ///< Half a unit of the last digit printed.
};

// Two-sided 95 % as the plan of the test states them, and the example of R's help page of
// binom.test (Conover 1971, p. 97).
TEST(Intervals, ClopperPearsonMeetsPublishedValues) {
  for (const Published& row :
       {Published{0, 60, 0.0, 6.0, 0.05}, Published{1, 60, 0.0, 8.9, 0.05},
        Published{3, 60, 1.0, 13.9, 0.05}, Published{45, 60, 62, 85, 0.5},
        Published{51, 60, 73, 93, 0.5}, Published{36, 40, 76, 97, 0.5},
        Published{38, 40, 83, 99, 0.5}, Published{2, 20, 1, 32, 0.5},
        Published{12, 20, 36, 81, 0.5}, Published{682, 925, 70.76683, 76.54066, 0.000005}}) {
    SCOPED_TRACE(row.hits * 1000 + row.cases);
    const auto score = share_score(row.hits, row.cases);
    ASSERT_TRUE(score && score->interval);
    EXPECT_NEAR(100.0 * score->interval->low, row.low_percent, row.rounding);
    EXPECT_NEAR(100.0 * score->interval->high, row.high_percent, row.rounding);
  }
}

TEST(Intervals, OneSidedBoundsMeetPublishedValues) {
  EXPECT_NEAR(100.0 * share_score(0, 60)->one_sided->high, 4.9, 0.05);
  EXPECT_NEAR(100.0 * share_score(1, 60)->one_sided->high, 7.7, 0.05);
  EXPECT_NEAR(100.0 * share_score(3, 60)->one_sided->high, 12.4, 0.05);
  EXPECT_LE(share_score(0, 299)->one_sided->high, 0.01);
  EXPECT_GT(share_score(0, 298)->one_sided->high, 0.01);
}

// With no hit the bound solves (1 - p)^n = tail, with hits only p^n = tail.
TEST(Intervals, ClopperPearsonMeetsClosedFormsAtTheEnds) {
  for (const int cases : {1, 2, 7, 60, 1000}) {
    const Interval none = clopper_pearson(0, cases, 0.025);
    EXPECT_EQ(none.low, 0.0);
    EXPECT_NEAR(none.high, 1.0 - std::pow(0.025, 1.0 / cases), 1e-12);
    const Interval all = clopper_pearson(cases, cases, 0.025);
    EXPECT_NEAR(all.low, std::pow(0.025, 1.0 / cases), 1e-12);
    EXPECT_EQ(all.high, 1.0);
  }
}

// What the interval is defined by: at its ends the tail of the binomial holds just 2.5 %.
TEST(Intervals, BinomialTailsAtTheEndsAreTheStatedOnes) {
  constexpr int cases = 20;
  const auto tail_from = [](int from, double p) {
    double sum = 0.0;
    for (int k = from; k <= cases; ++k) {
      sum +=
          std::exp(std::lgamma(cases + 1.0) - std::lgamma(k + 1.0) - std::lgamma(cases - k + 1.0) +
                   k * std::log(p) + (cases - k) * std::log1p(-p));
    }
    return sum;
  };
  for (int hits = 1; hits < cases; ++hits) {
    const Interval interval = clopper_pearson(hits, cases, 0.025);
    EXPECT_NEAR(tail_from(hits, interval.low), 0.025, 1e-9) << hits;
    EXPECT_NEAR(1.0 - tail_from(hits + 1, interval.high), 0.025, 1e-9) << hits;
  }
}

TEST(Intervals, WithoutCasesThereIsNoScore) {
  EXPECT_FALSE(share_score(0, 0));
  EXPECT_FALSE(median_score({}));
  EXPECT_FALSE(mean_score({}));
}

TEST(Intervals, FewCasesHaveAnEstimateButNoResampledInterval) {
  const auto five = median_score({5.0, 1.0, 2.0, 4.0, 3.0});
  ASSERT_TRUE(five);
  EXPECT_EQ(five->value, 3.0);
  EXPECT_FALSE(five->interval);
  EXPECT_FALSE(five->one_sided);
  EXPECT_TRUE(median_score({5.0, 1.0, 2.0, 4.0, 3.0, 6.0})->interval);
}

// The mean of 0 … 99: standard error sqrt((100^2 - 1) / 12 / 100) = 2.887, so 49.5 -+ 5.66. With
// 2000 resamples an end has a standard error of about 0.17.
TEST(Intervals, BootstrapOfAMeanMeetsItsStandardError) {
  std::vector<double> values;
  for (int i = 0; i < 100; ++i) values.push_back(i);
  const auto score = mean_score(values);
  EXPECT_DOUBLE_EQ(score->value, 49.5);
  EXPECT_NEAR(score->interval->low, 49.5 - 1.960 * 2.887, 0.7);
  EXPECT_NEAR(score->interval->high, 49.5 + 1.960 * 2.887, 0.7);
  EXPECT_NEAR(score->one_sided->low, 49.5 - 1.645 * 2.887, 0.7);
  EXPECT_NEAR(score->one_sided->high, 49.5 + 1.645 * 2.887, 0.7);
}

// A median's 95 % interval by order statistics: ranks 40 and 61 of 100 (binomial, p = 1/2).
TEST(Intervals, BootstrapOfAMedianMeetsTheOrderStatistics) {
  std::vector<double> values;
  for (int i = 1; i <= 100; ++i) values.push_back(i);
  const auto score = median_score(values);
  EXPECT_DOUBLE_EQ(score->value, 50.5);
  EXPECT_NEAR(score->interval->low, 40.5, 2.0);
  EXPECT_NEAR(score->interval->high, 60.5, 2.0);
}

TEST(Intervals, SameValuesSameBits) {
  const std::vector<double> values{3.0, 1.0, 4.0, 1.5, 9.0, 2.6, 5.3};
  const auto first = median_score(values);
  const auto second = median_score(values);
  EXPECT_EQ(first->interval->low, second->interval->low);
  EXPECT_EQ(first->interval->high, second->interval->high);
}

}  // namespace
}  // namespace recald::blind
