#include "core/calibration/samplers/adaptive_proposal.hpp"

#include <algorithm>
#include <cmath>

#include "core/calibration/samplers/chain_loop.hpp"

namespace recald::calibration {
namespace {

/// Ratio of the best normal proposal's variance to that of a normal density in d dimensions
/// (Roberts, Gelman, Gilks 1997).
double best_variance_ratio(Eigen::Index d) { return 2.38 * 2.38 / static_cast<double>(d); }

}  // namespace

AdaptiveProposal::AdaptiveProposal(const SamplerOptions& options, double target_acceptance,
                                   Eigen::Index dimension)
    : target_acceptance_(target_acceptance),
      scratch_(dimension),
      positions_(options.burn_in, dimension),
      rough_end_(options.begin_at ? 0 : options.burn_in / 2),
      end_(options.burn_in * 5 / 6) {}

Result<AdaptiveProposal> AdaptiveProposal::make(const Target& target, const SamplerOptions& options,
                                                double target_acceptance, Rng& rng) {
  const Eigen::Index d = target.dimension();
  AdaptiveProposal proposal(options, target_acceptance, d);
  if (!options.begin_at) {
    const Eigen::VectorXd variances = best_variance_ratio(d) * spread_of_starts(target, rng);
    proposal.shape_.compute(Eigen::MatrixXd(variances.asDiagonal()));
    return proposal;
  }
  TRY(factor_of_state(*options.begin_at, d));
  proposal.shape_.compute(best_variance_ratio(d) * options.begin_at->covariance);
  proposal.log_scale_ = std::log(options.begin_at->scale);
  return proposal;
}

void AdaptiveProposal::to_step(const Eigen::VectorXd& unit, Eigen::VectorXd& step) const {
  step.noalias() = shape_.matrixL() * unit;
  step *= std::exp(log_scale_);
}

void AdaptiveProposal::learn(const Eigen::VectorXd& position, const Eigen::VectorXd& unit,
                             double acceptance) {
  positions_.row(seen_) = position;
  ++seen_;
  tune_scale(acceptance);
  if (seen_ < rough_end_) tune_shape(unit, acceptance);
  if (seen_ == rough_end_) learn_shape(positions_.middleRows(seen_ / 2, seen_ - seen_ / 2));
  if (seen_ == end_) learn_shape(positions_.middleRows(rough_end_, end_ - rough_end_));
}

ChainState AdaptiveProposal::state(const Eigen::VectorXd& position) const {
  const double ratio = best_variance_ratio(position.size());
  return {position, std::exp(log_scale_), shape_.reconstructedMatrix() / ratio};
}

/// Robbins-Monro on the scale: gains whose sum diverges and whose squares' sum does not.
void AdaptiveProposal::tune_scale(double acceptance) {
  ++tuned_;
  log_scale_ += (acceptance - target_acceptance_) * std::pow(tuned_, -0.6);
}

/// Eq. (1) of Vihola (2012): stretches the proposal along the direction just tried when such steps
/// are accepted too often, and shrinks it when too rarely. The factor stays positive definite
/// because |acceptance - target| < 1.
void AdaptiveProposal::tune_shape(const Eigen::VectorXd& unit, double acceptance) {
  const auto d = static_cast<double>(unit.size());
  const double gain = std::min(1.0, d * std::pow(tuned_, -2.0 / 3.0));
  scratch_.noalias() = shape_.matrixL() * unit;
  shape_.rankUpdate(scratch_, gain * (acceptance - target_acceptance_) / unit.squaredNorm());
}

/// Takes the shape of `positions` (n x d), mixed with a tenth of the present one so that no
/// direction is lost in which the chain hardly moved; with more of it if there are few positions.
void AdaptiveProposal::learn_shape(const Eigen::Ref<const Eigen::MatrixXd>& positions) {
  if (positions.rows() < 2) return;
  const Eigen::Index d = positions.cols();
  const auto n = static_cast<double>(positions.rows());
  const Eigen::MatrixXd centred = positions.rowwise() - positions.colwise().mean();
  const double present = std::exp(2.0 * log_scale_);
  const double share = std::clamp(5.0 * static_cast<double>(d) / n, 0.1, 0.9);
  shape_.compute((1.0 - share) * best_variance_ratio(d) / n * centred.transpose() * centred +
                 share * present * shape_.reconstructedMatrix());
  log_scale_ = 0.0;
  tuned_ = 0;
}

}  // namespace recald::calibration
