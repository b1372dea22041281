#include "core/design/latin_hypercube.hpp"

#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>
#include <variant>
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

/// Where a prior ends, or one with tails all but ends.
UniformPrior ends_of(const Prior& prior) {
  constexpr double kTail = 0.001;
  const bool has_tails = std::holds_alternative<TruncatedNormalPrior>(prior.distribution()) ||
                         std::holds_alternative<LogNormalPrior>(prior.distribution());
  if (!has_tails) return {prior.min(), prior.max()};
  return {prior.quantile(kTail), prior.quantile(1.0 - kTail)};
}

}  // namespace

Eigen::MatrixXd wide_hypercube(std::span<const Parameter> parameters, int runs, Rng& rng) {
  assert(runs >= 4);
  if (const int rest = runs - kWideBlock; rest >= 4) {
    Eigen::MatrixXd design(runs, std::ssize(parameters));
    design.topRows(kWideBlock) = wide_hypercube(parameters, kWideBlock, rng);
    design.bottomRows(rest) = wide_hypercube(parameters, rest, rng);
    return design;
  }
  std::vector<Parameter> even{parameters.begin(), parameters.end()};
  for (Parameter& parameter : even) parameter.prior = ends_of(parameter.prior);
  const int evenly = runs / 2;
  Eigen::MatrixXd design(runs, std::ssize(parameters));
  design(Eigen::seq(0, Eigen::last, 2), Eigen::all) =
      latin_hypercube(parameters, runs - evenly, rng);
  design(Eigen::seq(1, Eigen::last, 2), Eigen::all) = latin_hypercube(even, evenly, rng);
  return design;
}

Eigen::MatrixXd corners(std::span<const Parameter> parameters, int runs, Rng& rng) {
  Eigen::MatrixXd design(runs, static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    for (Eigen::Index j = 0; j < design.cols(); ++j) {
      const UniformPrior ends = ends_of(parameters[static_cast<std::size_t>(j)].prior);
      design(i, j) = rng.below(2) == 1 ? ends.max : ends.min;
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

Eigen::MatrixXd draw_points(Points points, std::span<const Parameter> parameters, int runs,
                            Rng& rng) {
  switch (points) {
    case Points::priors:
      return latin_hypercube(parameters, runs, rng);
    case Points::corners:
      return corners(parameters, runs, rng);
    case Points::wide:
      break;
  }
  return wide_hypercube(parameters, runs, rng);
}

}  // namespace recald::design
