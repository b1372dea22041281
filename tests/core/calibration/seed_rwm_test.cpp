#include "core/calibration/seed_rwm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/calibration/diagnostics.hpp"

namespace recald::calibration {
namespace {

using testing::HasSubstr;

class FunctionTarget final : public Target {
 public:
  using Function = std::function<Result<double>(const Eigen::VectorXd&)>;

  FunctionTarget(Eigen::Index dimension, double spread, Function function)
      : dimension_(dimension), spread_(spread), function_(std::move(function)) {}

  [[nodiscard]] Eigen::Index dimension() const override { return dimension_; }
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& point) override {
    ++evaluations;
    return function_(point);
  }
  [[nodiscard]] Eigen::VectorXd draw_start(Rng& rng) const override {
    Eigen::VectorXd start(dimension_);
    for (double& x : start) x = spread_ * rng.normal();
    return start;
  }

  int evaluations = 0;

 private:
  Eigen::Index dimension_;
  double spread_;
  Function function_;
};

/// A normal whose axes differ tenfold and are correlated.
struct SkewNormal {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd mean;

  explicit SkewNormal(Eigen::Index d) : covariance(d, d), mean(d) {
    for (Eigen::Index i = 0; i < d; ++i) {
      mean(i) = static_cast<double>(i);
      for (Eigen::Index j = 0; j < d; ++j) {
        covariance(i, j) = std::pow(3.0, (i % 3) - 1) * std::pow(3.0, (j % 3) - 1) *
                           std::pow(0.7, std::abs(static_cast<double>(i - j)));
      }
    }
  }

  [[nodiscard]] FunctionTarget target() const {
    return {mean.size(), 10.0,
            [precision = covariance.inverse().eval(), m = mean](const Eigen::VectorXd& x) {
              return -0.5 * (x - m).dot(precision * (x - m));
            }};
  }
};

TEST(SeedRwm, FindsTheMomentsOfACorrelatedNormal) {
  const SkewNormal normal(8);
  constexpr int chains = 4;
  std::vector<Chain> run;
  for (int k = 0; k < chains; ++k) {
    FunctionTarget target = normal.target();
    Rng rng(11, static_cast<std::uint64_t>(k));
    run.push_back(seed_rwm(target, {}, rng).value());
    EXPECT_GT(run.back().acceptance_rate, 0.15);
    EXPECT_LT(run.back().acceptance_rate, 0.40);
  }
  for (Eigen::Index j = 0; j < 8; ++j) {
    SCOPED_TRACE(j);
    Eigen::MatrixXd draws(run[0].draws.rows(), chains);
    for (int k = 0; k < chains; ++k) draws.col(k) = run[static_cast<std::size_t>(k)].draws.col(j);
    const Diagnostics d = diagnose(draws);
    EXPECT_LT(d.rhat, 1.01);
    EXPECT_GT(d.ess_bulk, 1000.0);
    EXPECT_NEAR(draws.mean(), normal.mean(j), 4.0 * d.mcse);
    // Standard error of a normal's variance from ESS draws: variance * sqrt(2 / ESS).
    const double variance = (draws.array() - draws.mean()).square().mean();
    EXPECT_NEAR(variance / normal.covariance(j, j), 1.0, 4.0 * std::sqrt(2.0 / d.ess_bulk));
  }
}

// A density with a hard end: exponential on x > 0. Mean 1, and never a draw below the end.
TEST(SeedRwm, RespectsRegionsOfZeroDensity) {
  FunctionTarget target(1, 3.0, [](const Eigen::VectorXd& x) {
    return x(0) > 0.0 ? -x(0) : -std::numeric_limits<double>::infinity();
  });
  Rng rng(12);
  const Chain chain = seed_rwm(target, {60'000, 3'000}, rng).value();
  EXPECT_GT(chain.draws.minCoeff(), 0.0);
  const Diagnostics d = diagnose(chain.draws);
  EXPECT_NEAR(chain.draws.mean(), 1.0, 4.0 * d.mcse);
}

TEST(SeedRwm, OneIterationIsOneProposal) {
  FunctionTarget target = SkewNormal(3).target();
  Rng rng(13);
  const Chain chain = seed_rwm(target, {500, 100}, rng).value();
  EXPECT_EQ(target.evaluations, 501);  // and the start
  EXPECT_EQ(chain.draws.rows(), 400);
  EXPECT_EQ(chain.log_density.size(), 400);
}

TEST(SeedRwm, KeptLogDensitiesBelongToTheDraws) {
  FunctionTarget target = SkewNormal(3).target();
  Rng rng(14);
  const Chain chain = seed_rwm(target, {500, 100}, rng).value();
  for (Eigen::Index i = 0; i < chain.draws.rows(); i += 37) {
    EXPECT_EQ(chain.log_density(i), target.log_density(chain.draws.row(i).transpose()).value());
  }
}

TEST(SeedRwm, SameSeedSameBytesOtherSeedOthers) {
  const auto run = [](std::uint64_t seed) {
    FunctionTarget target = SkewNormal(3).target();
    Rng rng(seed, 2);
    return seed_rwm(target, {2000, 500}, rng).value().draws;
  };
  EXPECT_TRUE(run(1) == run(1));
  EXPECT_FALSE(run(1) == run(2));
}

// Two chains whose adaptation ended alike would differ only by their random numbers; that the
// proposal no longer changes after the burn-in shows in the set of step lengths: no new width
// appears.
TEST(SeedRwm, ProposalsAreFrozenAfterBurnIn) {
  double longest_early = 0.0;
  double longest_late = 0.0;
  Eigen::VectorXd previous;
  FunctionTarget target(1, 1.0, [](const Eigen::VectorXd&) { return 0.0; });  // accepts everything
  Rng rng(15);
  const Chain chain = seed_rwm(target, {40'000, 1'000}, rng).value();
  const Eigen::VectorXd steps =
      (chain.draws.bottomRows(38'999) - chain.draws.topRows(38'999)).cwiseAbs();
  longest_early = steps.head(19'000).maxCoeff();
  longest_late = steps.tail(19'000).maxCoeff();
  // Acceptance is 1, so a tuner still at work would widen the steps without end.
  EXPECT_NEAR(longest_late / longest_early, 1.0, 1e-3);
}

TEST(SeedRwm, StopsWhenToldAtAnyStep) {
  for (const int stop_at : {1, 2, 5}) {
    FunctionTarget target = SkewNormal(2).target();
    Rng rng(16);
    int calls = 0;
    const auto chain =
        seed_rwm(target, {2000, 500}, rng, [&](int, int) { return ++calls < stop_at; });
    ASSERT_FALSE(chain.has_value());
    EXPECT_EQ(chain.error().code, ErrorCode::cancelled);
    EXPECT_EQ(calls, stop_at);
  }
}

TEST(SeedRwm, ReportsProgressUpToTheEnd) {
  FunctionTarget target = SkewNormal(2).target();
  Rng rng(17);
  int last = 0;
  ASSERT_TRUE(seed_rwm(target, {1234, 100}, rng, [&](int done, int total) {
                EXPECT_GT(done, last);
                EXPECT_EQ(total, 1234);
                last = done;
                return true;
              }).has_value());
  EXPECT_EQ(last, 1234);
}

TEST(SeedRwm, AnErrorOfTheTargetEndsTheChain) {
  int calls = 0;
  FunctionTarget target(1, 1.0, [&](const Eigen::VectorXd&) -> Result<double> {
    if (++calls > 50) return failure(ErrorCode::not_finite, "the model broke");
    return 0.0;
  });
  Rng rng(18);
  const auto chain = seed_rwm(target, {2000, 500}, rng);
  ASSERT_FALSE(chain.has_value());
  EXPECT_EQ(chain.error().message, "the model broke");
}

TEST(SeedRwm, NowhereToStartIsSaid) {
  FunctionTarget target(
      1, 1.0, [](const Eigen::VectorXd&) { return -std::numeric_limits<double>::infinity(); });
  Rng rng(19);
  const auto chain = seed_rwm(target, {2000, 500}, rng);
  ASSERT_FALSE(chain.has_value());
  EXPECT_THAT(chain.error().message, HasSubstr("none of 100 starting points"));
}

TEST(SeedRwm, BurnInHasToLeaveDraws) {
  for (const SamplerOptions options : {SamplerOptions{100, 100}, {100, 0}, {0, 0}, {10, 20}}) {
    FunctionTarget target = SkewNormal(2).target();
    Rng rng(20);
    const auto chain = seed_rwm(target, options, rng);
    ASSERT_FALSE(chain.has_value());
    EXPECT_EQ(chain.error().code, ErrorCode::invalid_value);
  }
}

}  // namespace
}  // namespace recald::calibration
