#include "core/calibration/posterior/diagnostics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/random/rng.hpp"

namespace recald::calibration::diagnostics_test {
namespace {

/// Draws that R can repeat to the last bit: Park and Miller's generator is exact in doubles.
///   lcg <- function(s) (16807 * s) %% 2147483647; u <- s / 2147483647
Eigen::MatrixXd repeatable_chains(int n, const std::vector<double>& seeds,
                                  const std::function<double(double, double, double, int)>& step) {
  Eigen::MatrixXd draws(n, static_cast<Eigen::Index>(seeds.size()));
  for (int c = 0; c < draws.cols(); ++c) {
    double s = seeds[static_cast<std::size_t>(c)];
    double x = 0.0;
    for (int t = 0; t < n; ++t) {
      s = std::fmod(16807.0 * s, 2147483647.0);
      const double u = s / 2147483647.0;
      s = std::fmod(16807.0 * s, 2147483647.0);
      const double v = s / 2147483647.0;
      x = step(x, u, v, c);
      draws(t, c) = x;
    }
  }
  return draws;
}

void expect_like_r(const Eigen::MatrixXd& draws, const Diagnostics& golden) {
  const Diagnostics d = diagnose(draws);
  EXPECT_NEAR(d.rhat, golden.rhat, 1e-8);
  EXPECT_NEAR(d.ess_bulk, golden.ess_bulk, 1e-6 * golden.ess_bulk);
  EXPECT_NEAR(d.ess_tail, golden.ess_tail, 1e-6 * golden.ess_tail);
  EXPECT_NEAR(d.mcse, golden.mcse, 1e-6 * golden.mcse);
}

// Golden values of the four tests below: R 4.2.2, package posterior 1.4.0 (Debian 12), functions
// rhat, ess_bulk, ess_tail, mcse_mean on the same (iterations x chains) matrices. Same definitions,
// so the tolerance is that of the printed digits.
TEST(DiagnosticsAgainstR, AutoregressiveChains) {
  expect_like_r(
      repeatable_chains(1000, {1, 22, 333, 4444},
                        [](double x, double u, double, int) { return 0.8 * x + (u - 0.5); }),
      {.rhat = 1.0044658134361,
       .ess_bulk = 428.61942615665,
       .ess_tail = 873.88867630781,
       .mcse = 0.023349244283839});
}

// Draws repeat as a Metropolis chain's do, tails are heavy and the length is odd.
TEST(DiagnosticsAgainstR, RejectionsAndHeavyTails) {
  const auto step = [](double x, double u, double v, int) {
    if (v >= 0.3) return x;
    const double w = 2.0 * u - 1.0;
    return w * w * w / (1.05 - w * w);
  };
  expect_like_r(repeatable_chains(501, {5, 66, 777, 8888}, step), {.rhat = 1.0162379334012,
                                                                   .ess_bulk = 313.11860302625,
                                                                   .ess_tail = 208.52674620792,
                                                                   .mcse = 0.15179123311261});
}

TEST(DiagnosticsAgainstR, OneChainShifted) {
  const auto step = [](double x, double u, double, int chain) {
    return 0.5 * x + (u - 0.5) + (chain == 3 ? 0.3 : 0.0);
  };
  expect_like_r(repeatable_chains(400, {9, 10, 11, 12}, step), {.rhat = 1.2531711343183,
                                                                .ess_bulk = 12.317577157812,
                                                                .ess_tail = 42.281864970665,
                                                                .mcse = 0.12227295966023});
}

// Antithetic draws: R says that the ESS has been capped, and so it is here.
TEST(DiagnosticsAgainstR, AntitheticChains) {
  expect_like_r(
      repeatable_chains(200, {13, 14},
                        [](double x, double u, double, int) { return -0.7 * x + (u - 0.5); }),
      {.rhat = 0.99975345026084,
       .ess_bulk = 1040.8239965312,
       .ess_tail = 382.98666874942,
       .mcse = 0.012872065852638});
}

Eigen::MatrixXd normal_chains(int n, int chains, double autocorrelation, std::uint64_t seed) {
  Eigen::MatrixXd draws(n, chains);
  for (int c = 0; c < chains; ++c) {
    Rng rng(seed, static_cast<std::uint64_t>(c));
    double x = rng.normal();
    for (int t = 0; t < n; ++t) {
      x = autocorrelation * x + std::sqrt(1.0 - autocorrelation * autocorrelation) * rng.normal();
      draws(t, c) = x;
    }
  }
  return draws;
}

TEST(Diagnostics, IndependentDrawsCountFully) {
  const Diagnostics d = diagnose(normal_chains(4000, 4, 0.0, 1));

  EXPECT_NEAR(d.rhat, 1.0, 0.003);
  EXPECT_NEAR(d.ess_bulk / 16'000.0, 1.0, 0.06);
  EXPECT_NEAR(d.ess_tail / 16'000.0, 1.0, 0.06);
  EXPECT_NEAR(d.mcse, 1.0 / std::sqrt(16'000.0), 0.05 / std::sqrt(16'000.0));
}

// AR(1) with coefficient phi: autocorrelation time (1 + phi) / (1 - phi).
TEST(Diagnostics, AutoregressiveDrawsCountByTheirKnownTime) {
  for (const double phi : {0.5, 0.9, 0.97}) {
    SCOPED_TRACE(phi);
    const double expected = 80'000.0 * (1.0 - phi) / (1.0 + phi);

    EXPECT_NEAR(effective_sample_size(normal_chains(20'000, 4, phi, 7)) / expected, 1.0, 0.1);
  }
}

TEST(Diagnostics, AChainThatSitsElsewhereIsSeen) {
  Eigen::MatrixXd draws = normal_chains(1000, 4, 0.0, 3);
  draws.col(2).array() += 1.0;

  const Diagnostics d = diagnose(draws);

  EXPECT_GT(d.rhat, 1.05);
  EXPECT_LT(d.ess_bulk, 100.0);
}

// Same centre, other width: only the folded ranks see it.
TEST(Diagnostics, AChainOfOtherWidthIsSeen) {
  Eigen::MatrixXd draws = normal_chains(1000, 4, 0.0, 4);
  draws.col(1) *= 0.2;

  EXPECT_GT(diagnose(draws).rhat, 1.05);
}

TEST(Diagnostics, AStuckChainIsSeen) {
  Eigen::MatrixXd draws = normal_chains(1000, 4, 0.0, 5);
  draws.col(3).setConstant(0.1);

  EXPECT_GT(diagnose(draws).rhat, 1.05);
}

TEST(Diagnostics, DrawsThatNeverMoveAreWorthNothing) {
  const Diagnostics same = diagnose(Eigen::MatrixXd::Constant(100, 4, 2.0));
  EXPECT_TRUE(std::isinf(same.rhat));
  EXPECT_EQ(same.ess_bulk, 0.0);

  Eigen::MatrixXd each_its_own(100, 4);
  each_its_own.rowwise() = Eigen::RowVector4d(1.0, 2.0, 3.0, 4.0);
  EXPECT_GT(diagnose(each_its_own).rhat, 100.0);

  Eigen::MatrixXd broken = normal_chains(100, 4, 0.0, 6);
  broken(5, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(diagnose(broken).rhat));
}

}  // namespace
}  // namespace recald::calibration::diagnostics_test
