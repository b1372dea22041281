#include "core/calibration/checks/bridge.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/calibration/posterior/diagnostics.hpp"
#include "core/calibration/samplers/log_sum.hpp"

namespace recald::calibration {
namespace {

/// The target in coordinates where it is approximately standard normal, made symmetric: log q(u).
class WarpedTarget {
 public:
  /// @param draws  (n x d)
  static Result<WarpedTarget> fit(Target& target, const Eigen::Ref<const Eigen::MatrixXd>& draws) {
    const Eigen::VectorXd mean = draws.colwise().mean();
    const Eigen::MatrixXd centred = draws.rowwise() - mean.transpose();
    const Eigen::LLT<Eigen::MatrixXd> factor(centred.transpose() * centred /
                                             static_cast<double>(draws.rows() - 1));
    if (factor.info() != Eigen::Success || !draws.allFinite()) {
      return failure(ErrorCode::not_positive_definite,
                     "the draws do not vary in every direction, so no normal density fits them; "
                     "use more draws");
    }
    return WarpedTarget(target, mean, factor.matrixL());
  }

  /// log q(u).
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& u) {
    const Eigen::VectorXd step = factor_ * u;
    const auto ahead = target_.log_density(mean_ + step);
    if (!ahead) return ahead;
    const auto behind = target_.log_density(mean_ - step);
    if (!behind) return behind;
    return log_constant_ + log_sum(*ahead, *behind);
  }

  [[nodiscard]] Eigen::VectorXd whiten(const Eigen::VectorXd& point) const {
    return factor_.triangularView<Eigen::Lower>().solve(point - mean_);
  }

 private:
  WarpedTarget(Target& target, Eigen::VectorXd mean, Eigen::MatrixXd factor)
      : target_(target),
        mean_(std::move(mean)),
        factor_(std::move(factor)),
        log_constant_(factor_.diagonal().array().log().sum() - std::numbers::ln2) {}

  Target& target_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd factor_;  // L
  double log_constant_;
};

double log_standard_normal(const Eigen::VectorXd& u) {
  return -0.5 * u.squaredNorm() -
         0.5 * static_cast<double>(u.size()) * std::log(2.0 * std::numbers::pi);
}

/// log q - log g at n points; `draw_point` gives the i-th in whitened coordinates.
template <class DrawPoint>
Result<Eigen::VectorXd> log_ratios(WarpedTarget& warped, Eigen::Index n,
                                   const std::function<bool()>& proceed, DrawPoint draw_point) {
  Eigen::VectorXd ratios(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (proceed && !proceed()) return failure(ErrorCode::cancelled, "cancelled while bridging");
    const Eigen::VectorXd u = draw_point(i);
    const auto value = TRY(warped.log_density(u));
    ratios(i) = value - log_standard_normal(u);
  }
  return ratios;
}

double relative_variance(const Eigen::ArrayXd& values) {
  return (values - values.mean()).square().mean() / (values.mean() * values.mean());
}

/// The iteration of Meng and Wong (1996), eq. (4.1), on log ratios minus `shift`.
class FixedPoint {
 public:
  FixedPoint(const Eigen::VectorXd& posterior, const Eigen::VectorXd& proposal)
      : shift_([&] {
          Eigen::VectorXd sorted = posterior;
          std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
          return sorted(sorted.size() / 2);
        }()),
        posterior_((posterior.array() - shift_).exp()),
        proposal_((proposal.array() - shift_).exp()) {
    const Eigen::MatrixXd as_drawn = posterior;
    const double effective = std::max(1.0, effective_sample_size(as_drawn));
    const double total = effective + static_cast<double>(proposal.size());
    share_ = effective / total;
  }

  Result<BridgeEstimate> solve() {
    constexpr int iterations_max = 1000;
    double r = 1.0;
    for (int k = 1; k <= iterations_max; ++k) {
      const double next = bridged_proposal(r).mean() / bridged_posterior(r).mean();
      if (!(next > 0.0) || !std::isfinite(next)) break;
      const bool converged = std::abs(std::log(next / r)) < 1e-10;
      r = next;
      if (converged) return BridgeEstimate{shift_ + std::log(r), standard_error(r), k};
    }
    return failure(ErrorCode::not_finite,
                   "bridge sampling failed: the draws and the normal density fitted to them hardly "
                   "overlap; use the evidence of smc");
  }

 private:
  // q / (s_1 q + s_2 r g) over draws of g, and g / (s_1 q + s_2 r g) over draws of the posterior,
  // with numerator and denominator both divided by g.
  [[nodiscard]] Eigen::ArrayXd bridged_proposal(double r) const {
    return (share_ + (1.0 - share_) * r / proposal_).inverse();
  }
  [[nodiscard]] Eigen::ArrayXd bridged_posterior(double r) const {
    return (share_ * posterior_ + (1.0 - share_) * r).inverse();
  }

  /// Frühwirth-Schnatter (2004), eq. (14): relative variances of the two means, the posterior one
  /// with its autocorrelation time.
  [[nodiscard]] double standard_error(double r) const {
    const Eigen::ArrayXd over_proposal = bridged_proposal(r);
    const Eigen::ArrayXd over_posterior = bridged_posterior(r);
    const Eigen::MatrixXd as_drawn = over_posterior;
    const double effective = std::max(1.0, effective_sample_size(as_drawn));
    return std::sqrt(relative_variance(over_proposal) / static_cast<double>(proposal_.size()) +
                     relative_variance(over_posterior) / effective);
  }

  double shift_;
  Eigen::ArrayXd posterior_;  // q / g over draws of the posterior
  Eigen::ArrayXd proposal_;   // q / g over draws of g
  double share_ = 0.5;        // s_1
};

}  // namespace

Result<BridgeEstimate> bridge_log_evidence(Target& target, const Eigen::MatrixXd& draws, Rng& rng,
                                           const std::function<bool()>& proceed) {
  const Eigen::Index d = target.dimension();
  if (draws.cols() != d || draws.rows() < 4 * (d + 2)) {
    return failure(ErrorCode::not_enough_data,
                   "bridge sampling in " + std::to_string(d) + " dimensions needs at least " +
                       std::to_string(4 * (d + 2)) + " draws with as many columns, not " +
                       std::to_string(draws.rows()) + " of " + std::to_string(draws.cols()));
  }
  const Eigen::Index fitted = draws.rows() / 2;
  auto warped = TRY(WarpedTarget::fit(target, draws.topRows(fitted)));
  const Eigen::Index n = draws.rows() - fitted;
  // The symmetrised density is the same at mu + L u and mu - L u, so a draw needs no random sign.
  const auto posterior = TRY(log_ratios(warped, n, proceed, [&](Eigen::Index i) {
    return warped.whiten(draws.row(fitted + i).transpose());
  }));
  const auto proposal = TRY(log_ratios(warped, n, proceed, [&](Eigen::Index) {
    Eigen::VectorXd u(d);
    for (double& value : u) value = rng.normal();
    return u;
  }));
  return FixedPoint(posterior, proposal).solve();
}

}  // namespace recald::calibration
