#include "core/diagnosis/evidence/posterior_algebra.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/calibration/samplers/log_sum.hpp"

namespace recald::diagnosis {
namespace {

constexpr double log_two_pi = 1.8378770664093454836;

/// Of the largest d^2: a column below this is invisible except for rounding.
constexpr double invisible = 1e-12;

using Factor = Eigen::LLT<Eigen::MatrixXd>;

double log_determinant(const Factor& factor) {
  return 2.0 * factor.matrixLLT().diagonal().array().log().sum();
}

/// Factor of J' P J + Lambda; its log determinant is finite.
Result<Factor> posterior_factor(const GramSystem& system, const Eigen::MatrixXd& prior_precision) {
  const Eigen::Index q = prior_precision.rows();
  assert(prior_precision.cols() == q && system.gram.rows() > q);
  Factor factor(system.gram.block(1, 1, q, q) + prior_precision);
  // Eigen accepts a NaN in its factorisation.
  if (factor.info() != Eigen::Success || !std::isfinite(log_determinant(factor))) {
    return failure(ErrorCode::not_positive_definite,
                   "the posterior precision of " + std::to_string(q) +
                       " parameters has no Cholesky factor; a sensitivity is not finite or a prior "
                       "is unbounded");
  }
  return factor;
}

/// Inverse of d, with 0 for invisible columns.
Eigen::VectorXd visible_scale(const GramSystem& system) {
  const Eigen::VectorXd d = detectability(system);
  const double least = d.size() > 0 ? std::sqrt(invisible) * d.maxCoeff() : 0.0;
  return d.unaryExpr([least](double value) { return value > least ? 1.0 / value : 0.0; });
}

}  // namespace

void GramSystem::add(const BlockNoise& noise, const Eigen::MatrixXd& columns) {
  assert(points == 0 || gram.rows() == columns.cols());
  if (points == 0) gram = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  gram += noise.gram(columns);
  log_determinant += noise.log_determinant();
  points += noise.points();
}

Result<GramSystem> marginalise(const GramSystem& system, const Eigen::MatrixXd& prior_precision) {
  const Eigen::Index q = prior_precision.rows();
  if (q == 0) return system;
  const Factor prior(prior_precision);
  const double log_prior = log_determinant(prior);
  if (prior.info() != Eigen::Success || !std::isfinite(log_prior)) {
    return failure(ErrorCode::not_positive_definite,
                   "the prior precision of the parameters is not positive definite");
  }
  const auto factor = TRY(posterior_factor(system, prior_precision));

  std::vector<Eigen::Index> kept{0};
  for (Eigen::Index j = q + 1; j < system.gram.rows(); ++j) kept.push_back(j);
  const Eigen::MatrixXd explained =
      factor.matrixL().solve(Eigen::MatrixXd(system.gram.middleRows(1, q)(Eigen::all, kept)));
  GramSystem rest;
  rest.gram = system.gram(kept, kept) - explained.transpose() * explained;
  rest.log_determinant = system.log_determinant + log_determinant(factor) - log_prior;
  rest.points = system.points;
  return rest;
}

Result<GaussianPosterior> posterior(const GramSystem& system,
                                    const Eigen::MatrixXd& prior_precision) {
  const Eigen::Index q = prior_precision.rows();
  if (q == 0) return GaussianPosterior{Eigen::VectorXd(0), Eigen::MatrixXd(0, 0)};
  const auto factor = TRY(posterior_factor(system, prior_precision));
  return GaussianPosterior{factor.solve(Eigen::VectorXd(system.gram.col(0).segment(1, q))),
                           factor.solve(Eigen::MatrixXd::Identity(q, q))};
}

GramSystem select(const GramSystem& system, std::span<const Eigen::Index> columns) {
  std::vector<Eigen::Index> kept{0};
  kept.insert(kept.end(), columns.begin(), columns.end());
  return {system.gram(kept, kept), system.log_determinant, system.points};
}

double log_evidence(const GramSystem& system) {
  return -0.5 * (static_cast<double>(system.points) * log_two_pi + system.log_determinant +
                 system.gram(0, 0));
}

Eigen::VectorXd detectability(const GramSystem& system) {
  return system.gram.diagonal().tail(system.gram.rows() - 1).cwiseMax(0.0).cwiseSqrt();
}

Eigen::VectorXd score(const GramSystem& system) {
  return visible_scale(system).cwiseProduct(system.gram.col(0).tail(system.gram.rows() - 1));
}

Eigen::MatrixXd confusability(const GramSystem& system) {
  const Eigen::Index k = system.gram.rows() - 1;
  const Eigen::VectorXd scale = visible_scale(system);
  return scale.asDiagonal() * system.gram.bottomRightCorner(k, k) * scale.asDiagonal();
}

Eigen::VectorXd absorbed_share(const GramSystem& before, const GramSystem& after) {
  const Eigen::Index k = after.gram.rows() - 1;
  const Eigen::ArrayXd left = after.gram.diagonal().tail(k).array();
  return 1.0 - left / before.gram.diagonal().tail(k).array();
}

double combine_nodes(const Eigen::VectorXd& log_evidences, const Eigen::VectorXd& log_weights) {
  return calibration::log_sum(log_evidences + log_weights);
}

Eigen::VectorXd node_weights(const Eigen::VectorXd& log_evidences,
                             const Eigen::VectorXd& log_weights) {
  const Eigen::ArrayXd logs = log_evidences + log_weights;
  return (logs - calibration::log_sum(logs)).exp();
}

Eigen::MatrixXd draw_scores(const Eigen::MatrixXd& correlation, int draws, Rng& rng) {
  // Bins that add up to others make the matrix singular; pivoting puts the
  // rank-deficient part last.
  const Eigen::LDLT<Eigen::MatrixXd> factor(correlation);
  Eigen::MatrixXd root = factor.matrixL();
  const Eigen::VectorXd pivots = factor.vectorD();
  const double least = invisible * (pivots.size() > 0 ? pivots.maxCoeff() : 0.0);
  for (Eigen::Index j = 0; j < root.cols(); ++j) {
    if (pivots[j] > least) {
      root.col(j) *= std::sqrt(pivots[j]);
    } else {
      root.col(j).setZero();
    }
  }
  root = factor.transpositionsP().transpose() * root;
  return root *
         Eigen::MatrixXd::NullaryExpr(correlation.rows(), draws,
                                      [&rng](Eigen::Index, Eigen::Index) { return rng.normal(); });
}

Eigen::VectorXd null_maxima(const Eigen::MatrixXd& correlation, int draws, Rng& rng) {
  Eigen::VectorXd maxima =
      draw_scores(correlation, draws, rng).cwiseAbs().colwise().maxCoeff().transpose();
  std::sort(maxima.begin(), maxima.end());
  return maxima;
}

double exceedance(const Eigen::VectorXd& maxima, double statistic) {
  const auto at_least =
      std::distance(std::lower_bound(maxima.begin(), maxima.end(), statistic), maxima.end());
  return (1.0 + static_cast<double>(at_least)) / (1.0 + static_cast<double>(maxima.size()));
}

double normal_p_value(double score) { return std::erfc(std::abs(score) / std::numbers::sqrt2); }

}  // namespace recald::diagnosis
