#include "core/calibration/samplers/chain_loop.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>

namespace recald::calibration {
namespace {

constexpr int kStartsTried = 100;

/// When to look at the processor's clock, which costs as much as some evaluations of a fast
/// density: about every sixteenth of the time that may pass.
class Lateness {
 public:
  /// @return whether too much time has passed since `begin_again`.
  [[nodiscard]] bool is_late(int done) {
    if (done < next_look_) return false;
    const double now_s = worked_s();
    every_ = now_s - looked_s_ < kObserveWithin_s / 16.0 ? std::min(2 * every_, kEveryMax)
                                                         : std::max(1, every_ / 2);
    looked_s_ = now_s;
    next_look_ = done + every_;
    return now_s - begun_s_ > kObserveWithin_s;
  }
  void begin_again() { begun_s_ = looked_s_; }

 private:
  static constexpr int kEveryMax = 1024;
  int every_ = 1;
  int next_look_ = 1;
  double looked_s_ = worked_s();
  double begun_s_ = looked_s_;
};

Result<StartingPoint> start_at(Target& target, const Eigen::VectorXd& position) {
  if (position.size() != target.dimension()) {
    return failure(ErrorCode::invalid_value,
                   "the initial state has " + std::to_string(position.size()) +
                       " coordinates, but the density has " + std::to_string(target.dimension()) +
                       "; it belongs to another model");
  }
  const auto value = TRY(target.log_density(position));
  if (!std::isfinite(value)) {
    return failure(ErrorCode::not_finite,
                   "the initial state has no positive posterior density; start without it");
  }
  return StartingPoint{position, value, 1};
}

}  // namespace

Result<StartingPoint> choose_start(Target& target, const SamplerOptions& options, Rng& rng) {
  if (options.begin_at) return start_at(target, options.begin_at->position);
  for (int i = 0; i < kStartsTried; ++i) {
    StartingPoint start{target.draw_start(rng), 0.0, i + 1};
    const auto value = TRY(target.log_density(start.position));
    start.log_density = value;
    if (std::isfinite(value)) return start;
  }
  return failure(ErrorCode::not_finite, "none of " + std::to_string(kStartsTried) +
                                            " starting points drawn from the prior has a positive "
                                            "posterior density");
}

Eigen::VectorXd spread_of_starts(const Target& target, Rng& rng) {
  Eigen::MatrixXd points(kStartsTried, target.dimension());
  for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) = target.draw_start(rng);
  const Eigen::MatrixXd centred = points.rowwise() - points.colwise().mean();
  return centred.array().square().colwise().mean();
}

Result<Eigen::LLT<Eigen::MatrixXd>> factor_of_state(const ChainState& state,
                                                    Eigen::Index dimension) {
  const Eigen::MatrixXd& covariance = state.covariance;
  if (covariance.rows() != dimension || covariance.cols() != dimension) {
    return failure(ErrorCode::invalid_value,
                   "the initial covariance is " + std::to_string(covariance.rows()) + " x " +
                       std::to_string(covariance.cols()) + ", but the density has " +
                       std::to_string(dimension) + " dimensions; it belongs to another model");
  }
  if (!(state.scale > 0.0) || !std::isfinite(state.scale)) {
    return failure(ErrorCode::invalid_value,
                   "the initial scale is " + std::to_string(state.scale) +
                       ", but it must be above zero; start without the state");
  }
  Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success || !covariance.allFinite()) {
    return failure(ErrorCode::not_positive_definite,
                   "the initial covariance is not positive definite; start without the state");
  }
  return factor;
}

double worked_s() {
  std::timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Result<Chain> run_chain(ChainKernel& kernel, const SamplerOptions& options, int observe_every,
                        const SamplerObserver& observer) {
  const int kept = options.iterations - options.burn_in;
  Chain chain;
  chain.draws.resize(kept, kernel.position().size());
  chain.log_density.resize(kept);
  Lateness lateness;
  for (int done = 1; done <= options.iterations; ++done) {
    TRY(kernel.step());
    if (done <= options.burn_in) {
      TRY(kernel.adapt());
      if (done == options.burn_in) kernel.begin_keeping();
    } else {
      chain.draws.row(done - options.burn_in - 1) = kernel.position();
      chain.log_density(done - options.burn_in - 1) = kernel.log_density();
    }
    if (!lateness.is_late(done) && done % observe_every != 0 && done != options.iterations)
      continue;
    lateness.begin_again();
    if (observer && !observer(done, options.iterations)) {
      return failure(ErrorCode::cancelled,
                     "cancelled after " + std::to_string(done) + " iterations of a chain");
    }
  }
  chain.statistics = kernel.statistics();
  chain.last = kernel.state();
  return chain;
}

}  // namespace recald::calibration
