#include "core/design/latin_hypercube.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace recald::design::latin_hypercube_test {
namespace {

std::vector<Parameter> parameters() {
  return {{"set_point", "degC", {20.0, 23.5, 28.0}},
          {"outdoor_air", "-", {0.3, 1.0, 1.2}},
          {"occupancy", "person/m2", {0.0, 0.05, 0.1}},
          {"leakage", "cm2/m2", {0.26, 0.26, 4.94}}};
}

TEST(LatinHypercube, EveryStratumOfEveryPriorHoldsOnePoint) {
  for (const int runs : {2, 7, 200}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(seed);
      Rng rng(seed);
      const Eigen::MatrixXd design = latin_hypercube(parameters(), runs, rng, 5);
      ASSERT_EQ(design.rows(), runs);
      ASSERT_EQ(design.cols(), 4);
      for (Eigen::Index j = 0; j < 4; ++j) {
        std::vector<int> hits(static_cast<std::size_t>(runs), 0);
        for (Eigen::Index i = 0; i < runs; ++i) {
          const double u = parameters()[static_cast<std::size_t>(j)].prior.cumulative(design(i, j));
          ++hits[static_cast<std::size_t>(std::min(u * runs, runs - 1.0))];
        }
        EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), runs) << "column " << j;
      }
    }
  }
}

TEST(LatinHypercube, SameSeedSameBytesOtherSeedOthers) {
  const auto design = [](std::uint64_t seed) {
    Rng rng(seed);
    return latin_hypercube(parameters(), 50, rng);
  };
  EXPECT_TRUE(design(1) == design(1));
  EXPECT_FALSE(design(1) == design(2));
}

TEST(LatinHypercube, ChoosingAmongFiftyLowersTheCorrelation) {
  double plain = 0.0;
  double chosen = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng a(seed);
    Rng b(seed);
    plain += largest_correlation(latin_hypercube(parameters(), 200, a, 1)) / 20.0;
    chosen += largest_correlation(latin_hypercube(parameters(), 200, b)) / 20.0;
  }
  EXPECT_LT(chosen, 0.5 * plain);
  EXPECT_LT(chosen, 0.06);  // a single pair of 200 independent draws has sd 0.07
}

TEST(LatinHypercube, MeansAreThoseOfThePriors) {
  Rng rng(3);
  const Eigen::MatrixXd design = latin_hypercube(parameters(), 200, rng);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const Prior prior = parameters()[static_cast<std::size_t>(j)].prior;
    // Stratified: the error of the mean is of order 1/n, not 1/sqrt(n).
    EXPECT_NEAR(design.col(j).mean(), prior.mean(), 0.01 * std::sqrt(prior.variance()));
  }
}

TEST(WideHypercube, IsInTurnFromThePriorsAndEvenBetweenTheirEnds) {
  Rng rng(3);
  const Eigen::MatrixXd design = wide_hypercube(parameters(), 400, rng);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const Prior prior = parameters()[static_cast<std::size_t>(j)].prior;
    const auto sd_of = [&](Eigen::Index first) {
      const Eigen::ArrayXd values = design.col(j)(Eigen::seq(first, Eigen::last, 2)).array();
      return std::sqrt((values - values.mean()).square().mean());
    };
    EXPECT_NEAR(sd_of(0), std::sqrt(prior.variance()), 0.01 * std::sqrt(prior.variance()));
    const double range = prior.max() - prior.min();
    EXPECT_NEAR(sd_of(1), range / std::sqrt(12.0), 0.01 * range);
    EXPECT_GE(design.col(j).minCoeff(), prior.min());
    EXPECT_LE(design.col(j).maxCoeff(), prior.max());
  }
}

TEST(WideHypercube, ALargerOneBeginsAsASmallerOne) {
  Rng some(3);
  Rng more(3);
  const Eigen::MatrixXd first = wide_hypercube(parameters(), kWideBlock, some);
  const Eigen::MatrixXd design = wide_hypercube(parameters(), kWideBlock + 50, more);
  EXPECT_EQ(design.topRows(kWideBlock), first);
  EXPECT_EQ(design.rows(), kWideBlock + 50);
}

// A bell whose bounds are far away, and one that begins at 0, where no chiller is.
TEST(WideHypercube, StaysWhereAPriorWithTailsHasWeight) {
  const std::vector<Parameter> tails{
      {"narrow", "-", Prior{TruncatedNormalPrior{5.0, 0.1, 0.0, 100.0}}},
      {"cop", "-", Prior{LogNormalPrior{4.0, 0.2}}}};
  Rng rng(3);
  const Eigen::MatrixXd design = wide_hypercube(tails, 100, rng);
  EXPECT_NEAR(design.col(0)(Eigen::seq(1, Eigen::last, 2)).minCoeff(), 5.0 - 0.309, 0.02);
  EXPECT_NEAR(design.col(0)(Eigen::seq(1, Eigen::last, 2)).maxCoeff(), 5.0 + 0.309, 0.02);
  EXPECT_GT(design.col(1).minCoeff(), 2.0);
}

TEST(Corners, EachParameterStandsAtAnEndOfItsPrior) {
  std::vector<Parameter> all = parameters();
  all.push_back({"open", "-", Prior{TruncatedNormalPrior{5.0, 1.0}}});
  Rng rng{3};
  const Eigen::MatrixXd design = corners(all, 40, rng);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const Prior& prior = all[static_cast<std::size_t>(j)].prior;
    const auto lower = (design.col(j).array() == prior.min()).count();
    EXPECT_EQ(lower + (design.col(j).array() == prior.max()).count(), 40);
    EXPECT_GT(lower, 5);
    EXPECT_LT(lower, 35);
  }
  EXPECT_NEAR(design.col(4).maxCoeff(), 5.0 + 3.09, 0.01);
  EXPECT_NEAR(design.col(4).minCoeff(), 5.0 - 3.09, 0.01);
}

TEST(LargestCorrelation, OfKnownColumns) {
  Eigen::MatrixXd design(4, 3);
  design << 1, 1, 1,  //
      2, 4, -1,       //
      3, 3, -1,       //
      4, 2, 1;
  // Centred columns (-1.5 -.5 .5 1.5), (-1.5 1.5 .5 -.5), (1 -1 -1 1): products 1, 0, -4.
  EXPECT_NEAR(largest_correlation(design), 4.0 / std::sqrt(5.0 * 4.0), 1e-15);
  EXPECT_EQ(largest_correlation(design.leftCols(1)), 0.0);
}

}  // namespace
}  // namespace recald::design::latin_hypercube_test
