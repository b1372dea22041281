#include "core/calibration/posterior/diagnostics.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cassert>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "core/statistics/quantile.hpp"

namespace recald::calibration {
namespace {

bool is_constant(const Eigen::MatrixXd& draws) { return (draws.array() == draws(0, 0)).all(); }

/// Splits each chain into its first and last half; a middle draw is left out.
Eigen::MatrixXd split(const Eigen::MatrixXd& draws) {
  const Eigen::Index half = draws.rows() / 2;
  Eigen::MatrixXd halves(half, 2 * draws.cols());
  halves << draws.topRows(half), draws.bottomRows(half);
  return halves;
}

/// Normal scores of the ranks over all chains; ties share their mean rank (ibid., eq. 14).
Eigen::MatrixXd normal_scores(const Eigen::MatrixXd& draws) {
  const auto n = static_cast<std::size_t>(draws.size());
  std::vector<std::pair<double, Eigen::Index>> order(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto index = static_cast<Eigen::Index>(i);
    order[i] = {draws.data()[index], index};
  }
  std::sort(order.begin(), order.end());
  Eigen::MatrixXd scores(draws.rows(), draws.cols());
  const boost::math::normal_distribution<> standard_normal;
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    while (end < n && order[end].first == order[begin].first) ++end;
    const double rank = 0.5 * static_cast<double>(begin + 1 + end);
    const double u = (rank - 0.375) / (static_cast<double>(n) + 0.25);
    const double score = boost::math::quantile(standard_normal, u);
    for (std::size_t i = begin; i < end; ++i) scores.data()[order[i].second] = score;
  }
  return scores;
}

double variance(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return (values.array() - values.mean()).square().sum() / static_cast<double>(values.size() - 1);
}

/// Gelman-Rubin R-hat of unsplit chains (ibid., eqs. 1-4).
double potential_scale_reduction(const Eigen::MatrixXd& chains) {
  const auto n = static_cast<double>(chains.rows());
  const Eigen::VectorXd means = chains.colwise().mean();
  double within = 0.0;
  for (Eigen::Index c = 0; c < chains.cols(); ++c) within += variance(chains.col(c));
  within /= static_cast<double>(chains.cols());
  return std::sqrt((n - 1.0) / n + variance(means) / within);
}

/// Autocovariance at lags 0 … n - 1, biased (divided by n), averaged over chains.
///
/// Two chains share one complex transform: for z = a + i b the power of a and b together at
/// frequency f is (|Z(f)|^2 + |Z(-f)|^2) / 2, and only the sum over chains is needed.
Eigen::VectorXd mean_autocovariance(const Eigen::MatrixXd& chains) {
  const Eigen::Index n = chains.rows();
  Eigen::Index size = 1;
  while (size < 2 * n) size *= 2;  // padded with zeros, so that the ends do not wrap around
  Eigen::FFT<double> fft;
  Eigen::VectorXcd padded(size);
  Eigen::VectorXcd spectrum(size);
  Eigen::VectorXd power = Eigen::VectorXd::Zero(size);
  const Eigen::MatrixXd centred = chains.rowwise() - chains.colwise().mean();
  for (Eigen::Index c = 0; c < chains.cols(); c += 2) {
    padded.setZero();
    padded.head(n).real() = centred.col(c);
    if (c + 1 < chains.cols()) padded.head(n).imag() = centred.col(c + 1);
    fft.fwd(spectrum, padded);
    power += spectrum.cwiseAbs2();
  }
  // (power(f) + power(-f)) / 2 is real and even, so its transform is real and equals the inverse up
  // to the factor 1 / size.
  padded = power.cast<std::complex<double>>();
  fft.fwd(spectrum, padded);
  return spectrum.head(n).real() / static_cast<double>(size * n * chains.cols());
}

/// Autocorrelation time by Geyer's initial monotone sequence, truncated as in R's posterior.
///
/// @param rho  Correlation at lags 0 …, from within and between chains together.
template <class Correlation>
double autocorrelation_time(const Correlation& rho, Eigen::Index lags) {
  std::vector<double> pairs;  // rho(2k) + rho(2k + 1), the initial positive ones
  double leftover_even = 0.0;
  for (Eigen::Index t = 0; t + 1 < lags; t += 2) {
    const double even = t == 0 ? 1.0 : rho(t);
    const double pair = even + rho(t + 1);
    if (!(pair > 0.0) || t + 5 >= lags) {
      leftover_even = std::max(even, 0.0);
      break;
    }
    pairs.push_back(pairs.empty() ? pair : std::min(pair, pairs.back()));
  }
  return -1.0 + 2.0 * std::accumulate(pairs.begin(), pairs.end(), 0.0) + leftover_even;
}

double ess_of_quantile(const Eigen::MatrixXd& halves, double quantile) {
  const Eigen::MatrixXd below = (halves.array() <= quantile).cast<double>();
  return effective_sample_size(below);
}

}  // namespace

double effective_sample_size(const Eigen::MatrixXd& draws) {
  assert(draws.rows() >= 4);
  if (!draws.allFinite() || is_constant(draws)) return 0.0;
  const auto n = static_cast<double>(draws.rows());
  const Eigen::VectorXd covariance = mean_autocovariance(draws);
  const double within = covariance(0) * n / (n - 1.0);
  const Eigen::VectorXd means = draws.colwise().mean();
  const double total = covariance(0) + (draws.cols() > 1 ? variance(means) : 0.0);
  const auto correlation = [&](Eigen::Index lag) {
    return 1.0 - (within - covariance(lag)) / total;
  };
  const auto count = static_cast<double>(draws.size());
  // The bound limits antithetic chains to count * log10(count).
  return count / std::max(autocorrelation_time(correlation, draws.rows()), 1.0 / std::log10(count));
}

Diagnostics diagnose(const Eigen::MatrixXd& draws) {
  assert(draws.rows() >= 8 && draws.cols() >= 1);
  if (!draws.allFinite() || is_constant(draws)) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {infinity, 0.0, 0.0, infinity};
  }
  const Eigen::MatrixXd halves = split(draws);
  Eigen::VectorXd sorted = draws.reshaped();
  std::sort(sorted.begin(), sorted.end());
  const double median = quantile_of_sorted(sorted, 0.5);
  const Eigen::MatrixXd scores = normal_scores(halves);
  const Eigen::MatrixXd folded_scores = normal_scores((halves.array() - median).abs());
  const double ess_mean = effective_sample_size(halves);
  return {
      .rhat = std::max(potential_scale_reduction(scores), potential_scale_reduction(folded_scores)),
      .ess_bulk = effective_sample_size(scores),
      .ess_tail = std::min(ess_of_quantile(halves, quantile_of_sorted(sorted, 0.05)),
                           ess_of_quantile(halves, quantile_of_sorted(sorted, 0.95))),
      .mcse = std::sqrt(variance(sorted) / ess_mean)};
}

}  // namespace recald::calibration
