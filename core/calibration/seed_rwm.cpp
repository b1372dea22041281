#include "core/calibration/seed_rwm.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>

namespace recald::calibration {
namespace {

constexpr double kTargetAcceptance = 0.25;
constexpr int kObserveEvery = 250;
constexpr int kStartsTried = 100;

/// Covariance that the proposals begin with: the spread of starting points, each coordinate by
/// itself, times 2.38^2 / d (Roberts, Gelman, Gilks 1997).
Eigen::MatrixXd first_shape(const Target& target, Rng& rng) {
  const Eigen::Index d = target.dimension();
  Eigen::MatrixXd points(kStartsTried, d);
  for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) = target.draw_start(rng);
  const Eigen::MatrixXd centred = points.rowwise() - points.colwise().mean();
  const Eigen::VectorXd variances = centred.array().square().colwise().mean();
  return (2.38 * 2.38 / static_cast<double>(d) * variances).asDiagonal();
}

class RandomWalk {
 public:
  RandomWalk(Target& target, Rng& rng)
      : target_(target),
        rng_(rng),
        d_(target.dimension()),
        shape_(first_shape(target, rng)),
        unit_(d_),
        step_(d_),
        proposal_(d_) {}

  Result<void> start() {
    for (int i = 0; i < kStartsTried; ++i) {
      position_ = target_.draw_start(rng_);
      const auto value = target_.log_density(position_);
      if (!value) return tl::unexpected(value.error());
      log_density_ = *value;
      if (std::isfinite(log_density_)) return {};
    }
    return failure(ErrorCode::not_finite,
                   "none of " + std::to_string(kStartsTried) +
                       " starting points drawn from the prior has a positive "
                       "posterior density");
  }

  /// One joint proposal of all coordinates. @return the probability with which it was accepted.
  Result<double> step() {
    for (Eigen::Index j = 0; j < d_; ++j) {
      unit_(j) = rng_.uniform(-std::sqrt(3.0), std::sqrt(3.0));  // unit variance
    }
    step_.noalias() = shape_.matrixL() * unit_;
    proposal_ = position_ + std::exp(log_scale_) * step_;
    const auto proposed = target_.log_density(proposal_);
    if (!proposed) return tl::unexpected(proposed.error());
    const double probability = std::exp(std::min(0.0, *proposed - log_density_));
    if (rng_.uniform() < probability) {
      position_.swap(proposal_);
      log_density_ = *proposed;
      ++accepted_;
    }
    return probability;
  }

  /// Robbins-Monro on the scale: gains whose sum diverges and whose squares' sum does not.
  void tune_scale(double acceptance) {
    ++tuned_;
    log_scale_ += (acceptance - kTargetAcceptance) * std::pow(tuned_, -0.6);
  }

  /// Eq. (1) of Vihola (2012): stretches the proposal along the direction just tried when such
  /// steps are accepted too often, and shrinks it when too rarely. The factor stays positive
  /// definite since |acceptance - target| < 1.
  void tune_shape(double acceptance) {
    const double gain = std::min(1.0, static_cast<double>(d_) * std::pow(tuned_, -2.0 / 3.0));
    step_.noalias() = shape_.matrixL() * unit_;
    shape_.rankUpdate(step_, gain * (acceptance - kTargetAcceptance) / unit_.squaredNorm());
  }

  /// Takes the shape of `positions` (n x d), with a tenth of the present one so that no direction
  /// is lost in which the chain hardly moved.
  void learn_shape(const Eigen::Ref<const Eigen::MatrixXd>& positions) {
    if (positions.rows() < 2) return;
    const Eigen::MatrixXd centred = positions.rowwise() - positions.colwise().mean();
    const double factor = 2.38 * 2.38 / static_cast<double>(d_ * positions.rows());
    const double present = std::exp(2.0 * log_scale_);
    shape_.compute(0.9 * factor * centred.transpose() * centred +
                   0.1 * present * shape_.reconstructedMatrix());
    log_scale_ = 0.0;
    tuned_ = 0;
  }

  [[nodiscard]] const Eigen::VectorXd& position() const { return position_; }
  [[nodiscard]] double log_density() const { return log_density_; }
  [[nodiscard]] int accepted() const { return accepted_; }

 private:
  Target& target_;
  Rng& rng_;
  Eigen::Index d_;
  Eigen::LLT<Eigen::MatrixXd> shape_;  // L
  double log_scale_ = 0.0;
  int tuned_ = 0;
  Eigen::VectorXd position_;
  double log_density_ = 0.0;
  int accepted_ = 0;
  Eigen::VectorXd unit_;  // u
  Eigen::VectorXd step_;  // L u
  Eigen::VectorXd proposal_;
};

/// What each part of the burn-in learns: the first half finds its way in and a rough shape, the
/// next third moves well enough for its own covariance to be the shape, the rest lets the scale
/// settle.
class BurnIn {
 public:
  BurnIn(Eigen::Index d, int length)
      : positions_(length, d), rough_end_(length / 2), end_(length * 5 / 6) {}

  void after(Eigen::Index iteration, double acceptance, RandomWalk& walk) {
    positions_.row(iteration) = walk.position();
    walk.tune_scale(acceptance);
    const Eigen::Index seen = iteration + 1;
    if (seen < rough_end_) walk.tune_shape(acceptance);
    if (seen == rough_end_) walk.learn_shape(positions_.middleRows(seen / 2, seen - seen / 2));
    if (seen == end_) walk.learn_shape(positions_.middleRows(rough_end_, end_ - rough_end_));
  }

 private:
  Eigen::MatrixXd positions_;
  Eigen::Index rough_end_;
  Eigen::Index end_;
};

bool wants_stop(const SamplerObserver& observer, int done, int total) {
  const bool due = done % kObserveEvery == 0 || done == total;
  return due && observer && !observer(done, total);
}

}  // namespace

Result<Chain> seed_rwm(Target& target, const SamplerOptions& options, Rng& rng,
                       const SamplerObserver& observer) {
  if (auto valid = check_options(options); !valid) return tl::unexpected(valid.error());
  RandomWalk walk(target, rng);
  if (auto started = walk.start(); !started) return tl::unexpected(started.error());

  const int kept = options.iterations - options.burn_in;
  Chain chain{Eigen::MatrixXd(kept, target.dimension()), Eigen::VectorXd(kept), 0.0};
  BurnIn burn_in(target.dimension(), options.burn_in);
  int accepted_in_burn_in = 0;
  for (int i = 0; i < options.iterations; ++i) {
    const auto acceptance = walk.step();
    if (!acceptance) return tl::unexpected(acceptance.error());
    if (i < options.burn_in) {
      burn_in.after(i, *acceptance, walk);
      accepted_in_burn_in = walk.accepted();
    } else {
      chain.draws.row(i - options.burn_in) = walk.position();
      chain.log_density(i - options.burn_in) = walk.log_density();
    }
    if (wants_stop(observer, i + 1, options.iterations)) {
      return failure(ErrorCode::cancelled,
                     "cancelled after " + std::to_string(i + 1) + " iterations of a chain");
    }
  }
  chain.acceptance_rate = static_cast<double>(walk.accepted() - accepted_in_burn_in) / kept;
  return chain;
}

}  // namespace recald::calibration
