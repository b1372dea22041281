#include "core/diagnosis/joint_fit.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace recald::diagnosis {
namespace {

constexpr double kScoreStep = 0.1;
// A day moved by its tenth of a score would jump a month; two days are still many parts.
constexpr double kDayStep_d = 2.0;
constexpr double kScoreLimit = 5.0;
constexpr int kHalvingsMax = 6;

/// Runs the model at scores and stacks the result.
class ScoredModel {
 public:
  ScoredModel(Predictor& predictor, const FitContext& context, const Candidate& candidate)
      : predictor_(predictor),
        context_(context),
        candidate_(candidate),
        facts_(context.site.facts()),
        theta_priors_(priors_of(context.site)),
        eta_priors_(priors_of(candidate)) {}

  [[nodiscard]] Eigen::Index theta_count() const {
    return static_cast<Eigen::Index>(theta_priors_.size());
  }
  [[nodiscard]] Eigen::Index error_count() const { return context_.errors.cols(); }
  [[nodiscard]] Eigen::Index eta_begin() const { return theta_count() + error_count(); }
  [[nodiscard]] Eigen::Index count() const {
    return eta_begin() + static_cast<Eigen::Index>(eta_priors_.size());
  }
  [[nodiscard]] std::vector<double> theta(const Eigen::VectorXd& scores) const {
    return values_at(theta_priors_, scores.head(theta_count()));
  }
  [[nodiscard]] std::vector<double> eta(const Eigen::VectorXd& scores) const {
    return values_at(eta_priors_, scores.tail(count() - eta_begin()));
  }
  [[nodiscard]] Eigen::VectorXd usual(const Eigen::VectorXd& scores) const {
    return scores.segment(theta_count(), error_count());
  }
  const Eigen::ArrayXXd& run(const Eigen::VectorXd& scores) {
    const std::vector<double> values = theta(scores);
    if (candidate_.effect == nullptr) return predictor_.parts_kW(values);
    const auto alteration = alteration_of(candidate_, facts_, eta(scores));
    return predictor_.parts_kW(values, alteration.get());
  }
  /// Model and usual errors together.
  Eigen::VectorXd stacked(const Eigen::VectorXd& scores) {
    return context_.observations.stack(run(scores)) + context_.errors * usual(scores);
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& scores, const Eigen::VectorXd& here) {
    Eigen::MatrixXd columns(here.size(), count());
    columns.middleCols(theta_count(), error_count()) = context_.errors;
    Eigen::VectorXd moved = scores;
    for (Eigen::Index j = 0; j < count(); ++j) {
      if (j >= theta_count() && j < eta_begin()) continue;
      // Towards the middle of the prior: the step never leaves what is plausible.
      const double step = (scores[j] > 0.0 ? -1.0 : 1.0) * step_of(j, scores[j]);
      moved[j] = scores[j] + step;
      columns.col(j) = (stacked(moved) - here) / step;
      moved[j] = scores[j];
    }
    return columns;
  }

 private:
  [[nodiscard]] double step_of(Eigen::Index j, double score) const {
    if (j < theta_count()) return kScoreStep;
    const auto k = static_cast<std::size_t>(j - eta_begin());
    if (candidate_.parameters[k].unit != "day") return kScoreStep;
    const double days_per_score = std::abs(eta_priors_[k].at_score(score).derivative);
    return std::clamp(kDayStep_d / std::max(days_per_score, 1e-6), 1e-4, kScoreStep);
  }

  Predictor& predictor_;
  const FitContext& context_;
  const Candidate& candidate_;
  SiteFacts facts_;
  std::vector<Prior> theta_priors_;
  std::vector<Prior> eta_priors_;
};

Eigen::MatrixXd beside(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian) {
  Eigen::MatrixXd columns(residual.size(), jacobian.cols() + 1);
  columns << residual, jacobian;
  return columns;
}

Eigen::MatrixXd unit_precision(Eigen::Index q) { return Eigen::MatrixXd::Identity(q, q); }

/// Log posterior density of the scores, but for constants of the node.
double log_posterior(const NoiseNode& node, const Observations& observations,
                     const Eigen::VectorXd& residual, const Eigen::VectorXd& scores) {
  const GramSystem system = node.gram(observations, residual);
  return -0.5 * system.gram(0, 0) - 0.5 * scores.squaredNorm();
}

}  // namespace

std::vector<double> values_at(std::span<const Prior> priors,
                              const Eigen::Ref<const Eigen::VectorXd>& scores) {
  std::vector<double> values;
  values.reserve(priors.size());
  for (std::size_t j = 0; j < priors.size(); ++j) {
    values.push_back(priors[j].at_score(scores[static_cast<Eigen::Index>(j)]).value);
  }
  return values;
}

std::vector<Prior> priors_of(const SiteProblem& site) {
  std::vector<Prior> priors;
  for (const Parameter& parameter : site.parameters) priors.push_back(parameter.prior);
  return priors;
}

std::vector<Prior> priors_of(const Candidate& candidate) {
  std::vector<Prior> priors;
  for (const EffectParameter& parameter : candidate.parameters) priors.push_back(parameter.prior);
  return priors;
}

double score_of(const Prior& prior, double value, double limit) {
  const double p = std::clamp(prior.cumulative(value), 1e-9, 1.0 - 1e-9);
  return std::clamp(boost::math::quantile(boost::math::normal{}, p), -limit, limit);
}

Result<GridEvidence> evidence_over(const std::vector<NoiseNode>& grid,
                                   const Observations& observations,
                                   const Eigen::VectorXd& linear_residual,
                                   const Eigen::MatrixXd& jacobian) {
  const Eigen::MatrixXd columns = beside(linear_residual, jacobian);
  const auto nodes = static_cast<Eigen::Index>(grid.size());
  Eigen::VectorXd evidences(nodes);
  Eigen::VectorXd weights(nodes);
  for (Eigen::Index i = 0; i < nodes; ++i) {
    const NoiseNode& node = grid[static_cast<std::size_t>(i)];
    const auto reduced =
        marginalise(node.gram(observations, columns), unit_precision(jacobian.cols()));
    if (!reduced) return tl::unexpected(reduced.error());
    evidences[i] = log_evidence(*reduced);
    weights[i] = node.log_weight;
  }
  GridEvidence result{combine_nodes(evidences, weights), node_weights(evidences, weights), 0};
  result.node_weights.maxCoeff(&result.best_node);
  return result;
}

Result<JointFit> fit_jointly(Predictor& predictor, const FitContext& context,
                             const Candidate& candidate, const Eigen::VectorXd& start,
                             const FitOptions& options) {
  ScoredModel model{predictor, context, candidate};
  const Observations& observations = context.observations;
  const NoiseNode& node = context.grid[context.reference_node];

  JointFit fit;
  fit.scores = start;
  Eigen::VectorXd modelled = model.stacked(fit.scores);
  fit.residual = observations.measured - modelled;
  double density = log_posterior(node, observations, fit.residual, fit.scores);
  for (fit.iterations = 0; fit.iterations < options.iterations_max; ++fit.iterations) {
    if (!std::isfinite(density)) {
      return failure(ErrorCode::not_finite,
                     "the hourly model gives no finite power at some values of its parameters");
    }
    fit.jacobian = model.jacobian(fit.scores, modelled);
    const auto target =
        posterior(node.gram(observations, beside(fit.linear_residual(), fit.jacobian)),
                  unit_precision(model.count()));
    if (!target) return tl::unexpected(target.error());

    double share = 1.0;
    double gain = 0.0;
    for (int halving = 0; halving < kHalvingsMax; ++halving, share *= 0.5) {
      const Eigen::VectorXd tried = (fit.scores + share * (target->mean - fit.scores))
                                        .cwiseMax(-kScoreLimit)
                                        .cwiseMin(kScoreLimit);
      const Eigen::VectorXd tried_modelled = model.stacked(tried);
      const Eigen::VectorXd residual = observations.measured - tried_modelled;
      const double tried_density = log_posterior(node, observations, residual, tried);
      if (!(tried_density > density)) continue;
      gain = tried_density - density;
      fit.scores = tried;
      modelled = tried_modelled;
      fit.residual = residual;
      density = tried_density;
      break;
    }
    if (gain < options.small_gain) {
      fit.converged = true;
      break;
    }
  }
  fit.parts_kW = model.run(fit.scores);
  const auto evidence =
      evidence_over(context.grid, observations, fit.linear_residual(), fit.jacobian);
  if (!evidence) return tl::unexpected(evidence.error());
  fit.log_evidence = evidence->log_evidence;
  fit.node_weights = evidence->node_weights;
  fit.best_node = evidence->best_node;
  const auto spread = posterior(context.grid[static_cast<std::size_t>(fit.best_node)].gram(
                                    observations, beside(fit.linear_residual(), fit.jacobian)),
                                unit_precision(model.count()));
  if (!spread) return tl::unexpected(spread.error());
  fit.posterior = *spread;
  fit.theta = model.theta(fit.scores);
  fit.usual = model.usual(fit.scores);
  fit.eta = model.eta(fit.scores);
  return fit;
}

}  // namespace recald::diagnosis
