// What runs 30 000 times must not touch the heap.

#include <gtest/gtest.h>

#include <limits>

#include "core/calibration/posterior/posterior.hpp"
#include "core/calibration/samplers/seed_rwm.hpp"
#include "tests/core/calibration/small_case.hpp"
#include "tests/core/calibration/toy_models.hpp"
#include "tests/support/allocations.hpp"

namespace recald::calibration {
namespace {

class NoEigenAllocation {
 public:
  NoEigenAllocation() { testing::let_eigen_allocate(false); }
  ~NoEigenAllocation() { testing::let_eigen_allocate(true); }
  NoEigenAllocation(const NoEigenAllocation&) = delete;
  NoEigenAllocation& operator=(const NoEigenAllocation&) = delete;
};

Posterior toy_posterior(int months) {
  CalibrationProblem problem = toy_problem(2, months);
  problem.outputs[1].weight = 0.5;
  problem.outputs[0].values[3] = std::numeric_limits<double>::quiet_NaN();
  problem.common_errors = {Eigen::VectorXd::Constant(2 * months, 30.0)};
  const PosteriorData data = normalise_problem(problem, {{{400.0, 2500.0}, {900.0, 5000.0}}, 0.05});
  return Posterior::make(toy_model(2, months), toy_parameters(), data,
                         make_hyper_prior(HyperPriorProfile::scaled, 0.05))
      .value();
}

TEST(Allocation, NoneInAnEvaluationOfThePosterior) {
  for (const int months : {12, 24, 36}) {
    Posterior posterior = toy_posterior(months);
    Rng rng(1);
    Eigen::VectorXd point = posterior.draw_start(rng);
    const NoEigenAllocation guard;
    const long before = testing::allocation_count();
    for (int i = 0; i < 50; ++i) {
      point(i % point.size()) += 0.01;  // theta alone, then hyper-parameters too
      ASSERT_TRUE(posterior.log_density(point).has_value());
    }
    EXPECT_EQ(testing::allocation_count() - before, 0) << months << " months";
  }
}

TEST(Allocation, NoneInAGradient) {
  constexpr int n = 24;
  PosteriorData general;
  general.month_inputs = Eigen::VectorXd::LinSpaced(n, 0.0, 1.0);
  for (int i = 0; i < n; ++i) general.points.push_back({0, i});
  general.values = Eigen::VectorXd::Constant(n, 0.4);
  general.extra_variances = Eigen::VectorXd::LinSpaced(n, 0.0, 1e-3);
  general.common_errors = Eigen::VectorXd::Constant(n, 0.01);
  general.scales = {{0.0, 1.0}};
  const auto weighted = [&](double weight) {
    general.weights = {weight};
    return Posterior::make(RampModel(n), {{"level", "-", {0.0, 0.5, 1.0}}}, general,
                           make_hyper_prior(HyperPriorProfile::scaled, 0.05))
        .value();
  };
  Posterior dense = weighted(0.5);
  Posterior with_common_errors = weighted(1.0);
  Posterior decoupled = small_posterior(0.03);
  for (Posterior* posterior : {&dense, &with_common_errors, &decoupled}) {
    Rng rng(1);
    Eigen::VectorXd point = posterior->draw_start(rng);
    Eigen::VectorXd gradient(point.size());
    const NoEigenAllocation guard;
    const long before = testing::allocation_count();
    for (int i = 0; i < 50; ++i) {
      point(i % point.size()) += 0.01;
      ASSERT_TRUE(posterior->log_density_and_gradient(point, gradient).has_value());
    }
    EXPECT_EQ(testing::allocation_count() - before, 0);
  }
}

// From the first observation after burn-in to the last; adaptation before may allocate.
TEST(Allocation, NoneInAKeptIterationOfTheRandomWalk) {
  Posterior posterior = toy_posterior(24);
  Rng rng(2);
  long first = -1;
  long last = -1;
  const SamplerObserver observer = [&](int done, int total) {
    if (done < 1000) return true;
    testing::let_eigen_allocate(done == total);  // what follows is no iteration
    if (first < 0) first = testing::allocation_count();
    last = testing::allocation_count();
    return true;
  };
  const auto chain = seed_rwm(posterior, {2000, 1000}, rng, observer);
  testing::let_eigen_allocate(true);
  ASSERT_TRUE(chain.has_value());
  EXPECT_EQ(last - first, 0);
}

// The guard itself: an allocation would be seen.
TEST(AllocationDeathTest, TheGuardsSeeAllocations) {
  const long before = testing::allocation_count();
  const auto model = toy_model(2, 12).clone();
  EXPECT_GT(testing::allocation_count() - before, 0);
#ifdef EIGEN_RUNTIME_NO_MALLOC
  EXPECT_DEATH(
      {
        const NoEigenAllocation guard;
        const Eigen::VectorXd fresh = Eigen::VectorXd::Zero(1000);
        (void)fresh;
      },
      "heap allocation is forbidden");
#endif
}

}  // namespace
}  // namespace recald::calibration
