// Truths drawn from the prior, data made by the very model and covariance that the posterior
// assumes. Then a p-interval holds the truth with probability p. This proves the density and the
// sampler, and nothing about how well such a model describes a building.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "core/calibration/draws.hpp"
#include "core/calibration/seed_rwm.hpp"
#include "core/statistics/quantile.hpp"
#include "tests/core/calibration/toy_models.hpp"

namespace recald::calibration {
namespace {

constexpr int kMonths = 12;
const HyperPrior kPrior{"test", {10.0, 0.02}, {10.0, 0.002}, {1.0, 0.3}};

PosteriorData empty_data() {
  return normalise_problem(toy_problem(2, kMonths), {{{400.0, 2500.0}, {900.0, 5000.0}}, 0.05});
}

/// Replaces the measurements by a draw of the model at `theta`, discrepancy and noise added.
void simulate(PosteriorData& data, const Eigen::VectorXd& theta, const Hyperparameters& hyper,
              Rng& rng) {
  FunctionModel model = toy_model(2, kMonths);
  std::vector<double> outputs(2 * kMonths);
  model.evaluate({theta.data(), 2}, outputs);
  const auto m = static_cast<Eigen::Index>(data.points.size());
  DiscrepancyKernel kernel(data.month_inputs, data.points);
  Eigen::MatrixXd sigma(m, m);
  kernel.covariance(1.0 / hyper.discrepancy_precision, hyper.beta, sigma);
  sigma.diagonal().array() += 1.0 / hyper.error_precision;
  const Eigen::LLT<Eigen::MatrixXd> factor(sigma);
  Eigen::VectorXd unit(m);
  for (double& u : unit) u = rng.normal();
  data.values = factor.matrixL() * unit;
  for (Eigen::Index i = 0; i < m; ++i) {
    const PointIndex& p = data.points[static_cast<std::size_t>(i)];
    data.values(i) += data.scales[static_cast<std::size_t>(p.output)].normalise(
        outputs[static_cast<std::size_t>(p.output * kMonths + p.month)]);
  }
}

ChainDraws sample(const PosteriorData& data, std::uint64_t seed) {
  Posterior posterior =
      Posterior::make(toy_model(2, kMonths), toy_parameters(), data, kPrior).value();
  Rng rng(seed, 1);
  return to_natural_units(seed_rwm(posterior, {9'000, 2'000}, rng).value(), posterior);
}

bool inside_90(Eigen::VectorXd draws, double truth) {
  std::sort(draws.begin(), draws.end());
  return quantile_of_sorted(draws, 0.05) <= truth && truth <= quantile_of_sorted(draws, 0.95);
}

TEST(Coverage, NinetyPerCentIntervalsHoldNinetyPerCentOfTruths) {
  constexpr int truths = 60;
  std::map<std::string, int> inside;
  PosteriorData data = empty_data();
  const Posterior prior =
      Posterior::make(toy_model(2, kMonths), toy_parameters(), data, kPrior).value();
  for (std::uint64_t seed = 1; seed <= truths; ++seed) {
    Rng rng(seed);
    Eigen::VectorXd theta(2);
    Hyperparameters hyper{0.0, 0.0, Eigen::VectorXd(3)};
    prior.to_natural(prior.draw_start(rng), theta, hyper);
    simulate(data, theta, hyper, rng);
    const ChainDraws draws = sample(data, seed);
    inside["gain"] += inside_90(draws.theta.col(0), theta(0));
    inside["balance_point"] += inside_90(draws.theta.col(1), theta(1));
    inside["lambda_delta"] += inside_90(draws.discrepancy_precision, hyper.discrepancy_precision);
    inside["lambda_eps"] += inside_90(draws.error_precision, hyper.error_precision);
    inside["beta_dry_bulb"] += inside_90(draws.beta.col(0), hyper.beta(0));
    inside["beta_out"] += inside_90(draws.beta.col(2), hyper.beta(2));
  }
  // Three binomial standard errors, for six counts.
  const double slack = 3.0 * std::sqrt(truths * 0.9 * 0.1);
  for (const auto& [name, count] : inside) {
    RecordProperty(name, count);
    EXPECT_NEAR(count, 0.9 * truths, slack) << name << " of " << truths;
  }
}

}  // namespace
}  // namespace recald::calibration
