#include "core/design/latin_hypercube.hpp"

#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace recald::design {
namespace {

void shuffle(std::vector<int>& order, Rng& rng) {
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(rng.below(i))]);
  }
}

Eigen::MatrixXd plain_hypercube(std::span<const Parameter> parameters, int runs, Rng& rng) {
  Eigen::MatrixXd design(runs, static_cast<Eigen::Index>(parameters.size()));
  std::vector<int> stratum(static_cast<std::size_t>(runs));
  for (Eigen::Index j = 0; j < design.cols(); ++j) {
    std::iota(stratum.begin(), stratum.end(), 0);
    shuffle(stratum, rng);
    const Prior& prior = parameters[static_cast<std::size_t>(j)].prior;
    for (Eigen::Index i = 0; i < design.rows(); ++i) {
      const double u = (stratum[static_cast<std::size_t>(i)] + rng.uniform()) / runs;
      design(i, j) = prior.quantile(u);
    }
  }
  return design;
}

}  // namespace

Eigen::MatrixXd corners(std::span<const Parameter> parameters, int runs, Rng& rng) {
  constexpr double kTail = 0.001;
  Eigen::MatrixXd design(runs, static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    for (Eigen::Index j = 0; j < design.cols(); ++j) {
      const Prior& prior = parameters[static_cast<std::size_t>(j)].prior;
      const bool is_upper = rng.below(2) == 1;
      const double end = is_upper ? prior.max() : prior.min();
      design(i, j) = std::isfinite(end) ? end : prior.quantile(is_upper ? 1.0 - kTail : kTail);
    }
  }
  return design;
}

double largest_correlation(const Eigen::MatrixXd& design) {
  const Eigen::MatrixXd centred = design.rowwise() - design.colwise().mean();
  const Eigen::VectorXd norms = centred.colwise().norm();
  double largest = 0.0;
  for (Eigen::Index j = 0; j < design.cols(); ++j) {
    for (Eigen::Index k = 0; k < j; ++k) {
      const double correlation = centred.col(j).dot(centred.col(k)) / (norms(j) * norms(k));
      largest = std::max(largest, std::abs(correlation));
    }
  }
  return largest;
}

Eigen::MatrixXd latin_hypercube(std::span<const Parameter> parameters, int runs, Rng& rng,
                                int candidates) {
  assert(!parameters.empty() && runs >= 2 && candidates >= 1);
  Eigen::MatrixXd best = plain_hypercube(parameters, runs, rng);
  double best_correlation = largest_correlation(best);
  for (int c = 1; c < candidates; ++c) {
    Eigen::MatrixXd candidate = plain_hypercube(parameters, runs, rng);
    const double correlation = largest_correlation(candidate);
    if (correlation < best_correlation) {
      best_correlation = correlation;
      best = std::move(candidate);
    }
  }
  return best;
}

}  // namespace recald::design
