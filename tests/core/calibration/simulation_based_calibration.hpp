/// Simulation-based calibration: are posteriors as wide as they say?
///
/// Truths are drawn from the prior, data made by the very model and covariance that the posterior
/// assumes. Then the rank of a truth among independent posterior draws is uniform, and a p-interval
/// holds it with probability p. This proves the density, the sampler and their bookkeeping, and
/// nothing about how well such a model describes a building.
///
/// Talts, Betancourt, Simpson, Vehtari, Gelman (2018), "Validating Bayesian inference algorithms
/// with simulation-based calibration".
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/calibration/sampling.hpp"
#include "core/statistics/quantile.hpp"

namespace recald::calibration {

struct SbcCase {
  const MonthlyModel& model;
  std::vector<Parameter> parameters;
  PosteriorData data;  ///< Its values are replaced.
  HyperPrior prior;
  std::vector<std::string> input_names;
  SamplingOptions sampling;
  /// Posterior draws a rank is taken among; they have to be about independent. One less than a
  /// multiple of 40, so that bins and levels are whole numbers of ranks.
  int draws = 199;
  /// In the chains in the place of the model, which makes the data; null: the model itself.
  const MonthlyModel* stand_in = nullptr;
  Eigen::VectorXd stand_in_variances{};  ///< (points) Normalised; empty: none.
};

inline constexpr int kSbcBins = 20;
inline constexpr std::array<double, 3> kSbcLevels{0.50, 0.80, 0.95};

/// One quantity over all replicates.
struct SbcQuantity {
  std::string name;
  std::array<int, kSbcBins> bins{};
  std::array<int, 3> inside{};  ///< Truths inside the central interval of each level.

  /// Probability of ranks at least as uneven if they were uniform. Bins are put together until
  /// five replicates are expected in each, as the chi-squared law needs.
  [[nodiscard]] double p_value() const {
    double n = 0.0;
    for (const int count : bins) n += count;
    int merged = 1;
    while (n * merged / kSbcBins < 5.0 && merged < kSbcBins / 4)
      merged = merged == 4 ? 5 : 2 * merged;
    const int count = kSbcBins / merged;
    const double expected = n / count;
    double statistic = 0.0;
    for (int b = 0; b < count; ++b) {
      double observed = 0.0;
      for (int i = 0; i < merged; ++i) observed += bins[static_cast<std::size_t>(b * merged + i)];
      statistic += (observed - expected) * (observed - expected) / expected;
    }
    return boost::math::cdf(
        boost::math::complement(boost::math::chi_squared(count - 1), statistic));
  }
};

struct SbcResult {
  std::vector<SbcQuantity> quantities;
  int replicates = 0;
  int unconverged = 0;  ///< Counted in all the same: leaving them out would bias the ranks.
  int replaced = 0;     ///< Where populations took over.
  int failed = 0;
  double smallest_ess = 1e300;
};

/// A draw of the data from the model at (theta, hyper).
inline Eigen::VectorXd simulate_data(const SbcCase& c, const Eigen::VectorXd& theta,
                                     const Hyperparameters& hyper, Rng& rng) {
  const auto model = c.model.clone();
  std::vector<double> outputs(
      static_cast<std::size_t>(model->output_count() * model->month_count()));
  model->evaluate({theta.data(), static_cast<std::size_t>(theta.size())}, outputs);
  const auto m = static_cast<Eigen::Index>(c.data.points.size());
  DiscrepancyKernel kernel(c.data.month_inputs, c.data.points);
  Eigen::MatrixXd sigma = Eigen::MatrixXd::Zero(m, m);
  kernel.covariance(1.0 / hyper.discrepancy_precision, hyper.beta, sigma);
  if (c.data.common_errors.cols() > 0) {
    sigma += c.data.common_errors * c.data.common_errors.transpose();
  }
  sigma.diagonal() += c.data.extra_variances;
  sigma.diagonal().array() += 1.0 / hyper.error_precision;
  const Eigen::LLT<Eigen::MatrixXd> factor(sigma);
  Eigen::VectorXd unit(m);
  for (double& u : unit) u = rng.normal();
  Eigen::VectorXd values = factor.matrixL() * unit;
  for (Eigen::Index i = 0; i < m; ++i) {
    const PointIndex& p = c.data.points[static_cast<std::size_t>(i)];
    values(i) += c.data.scales[static_cast<std::size_t>(p.output)].normalise(
        outputs[static_cast<std::size_t>(p.output * model->month_count() + p.month)]);
  }
  return values;
}

/// Truth and posterior of one replicate: one column a quantity.
struct SbcReplicate {
  Eigen::VectorXd truth;
  Eigen::MatrixXd draws;  ///< (draws x quantities), equally spaced over the pooled chains.
  bool converged = false;
  bool replaced = false;
  bool failed = true;
  double smallest_ess = 0.0;
};

inline SbcReplicate run_replicate(const SbcCase& c, std::uint64_t seed) {
  PosteriorData data = c.data;
  data.values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(data.points.size()));
  const Posterior prior = Posterior::make(c.model, c.parameters, data, c.prior).value();
  const Eigen::Index q = prior.parameter_count();
  const Eigen::Index s = prior.kernel_dimension();
  Rng rng(seed, std::uint64_t{1} << 40);
  Eigen::VectorXd theta(q);
  Hyperparameters hyper{0.0, 0.0, Eigen::VectorXd(s)};
  prior.to_natural(prior.draw_start(rng), theta, hyper);
  data.values = simulate_data(c, theta, hyper, rng);

  SbcReplicate result;
  if (c.stand_in_variances.size() > 0) data.extra_variances += c.stand_in_variances;
  const MonthlyModel& sampled_model = c.stand_in != nullptr ? *c.stand_in : c.model;
  const Posterior posterior = Posterior::make(sampled_model, c.parameters, data, c.prior).value();
  const auto sampled = sample_posterior(posterior, c.input_names, c.sampling, {.seed = seed});
  if (!sampled) return result;
  result.failed = false;
  result.converged = sampled->converged;
  result.replaced = !sampled->report.taken_over.empty();
  result.smallest_ess = 1e300;
  for (const auto* list : {&sampled->parameters, &sampled->hyperparameters}) {
    for (const Summary& summary : *list) {
      result.smallest_ess = std::min(result.smallest_ess, summary.ess_bulk);
    }
  }
  result.truth.resize(q + 2 + s);
  result.truth << theta, hyper.discrepancy_precision, hyper.error_precision, hyper.beta;
  const ThinnedDraws thinned = thin(sampled->chains, c.draws);
  result.draws.resize(c.draws, result.truth.size());
  for (Eigen::Index d = 0; d < c.draws; ++d) {
    const auto draw = static_cast<std::size_t>(d);
    const ChainDraws& chain = sampled->chains[static_cast<std::size_t>(thinned.chain[draw])];
    const int row = thinned.iteration[draw];
    result.draws.row(d) << chain.theta.row(row), chain.discrepancy_precision(row),
        chain.error_precision(row), chain.beta.row(row);
  }
  return result;
}

inline void count_replicate(const SbcReplicate& replicate, SbcResult& result) {
  ++result.replicates;
  result.failed += replicate.failed;
  if (replicate.failed) return;
  result.unconverged += !replicate.converged;
  result.replaced += replicate.replaced;
  result.smallest_ess = std::min(result.smallest_ess, replicate.smallest_ess);
  for (std::size_t j = 0; j < result.quantities.size(); ++j) {
    SbcQuantity& quantity = result.quantities[j];
    const auto column = static_cast<Eigen::Index>(j);
    Eigen::VectorXd sorted = replicate.draws.col(column);
    std::sort(sorted.begin(), sorted.end());
    const double truth = replicate.truth(column);
    const auto ranks = static_cast<std::ptrdiff_t>(replicate.draws.rows()) + 1;
    const auto rank = std::lower_bound(sorted.begin(), sorted.end(), truth) - sorted.begin();
    ++quantity.bins[static_cast<std::size_t>(rank * kSbcBins / ranks)];
    for (std::size_t level = 0; level < kSbcLevels.size(); ++level) {
      // Of equally likely ranks, those that leave (1 - level) / 2 on either side.
      const auto tail = static_cast<std::ptrdiff_t>(
          std::lround(0.5 * (1.0 - kSbcLevels[level]) * static_cast<double>(ranks)));
      quantity.inside[level] += tail <= rank && rank < ranks - tail;
    }
  }
}

/// @param executor  Runs replicates side by side.
inline SbcResult run_sbc(const SbcCase& c, int replicates, std::uint64_t first_seed,
                         const ForEachIndex& executor) {
  std::vector<SbcReplicate> done(static_cast<std::size_t>(replicates));
  executor(done.size(), [&](std::size_t i) {
    done[i] = run_replicate(c, first_seed + static_cast<std::uint64_t>(i));
  });
  SbcResult result;
  for (const Parameter& p : c.parameters) result.quantities.push_back({.name = p.name});
  const bool cross = DiscrepancyKernel(c.data.month_inputs, c.data.points).has_output_dimension();
  for (const std::string& name : hyperparameter_names(c.input_names, cross)) {
    result.quantities.push_back({.name = name});
  }
  for (const SbcReplicate& replicate : done) count_replicate(replicate, result);
  return result;
}

}  // namespace recald::calibration
