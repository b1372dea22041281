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
constexpr int kTrialsMax = 6;
// Precision of the damped steps, in units of the priors': first, and from one to the next.
constexpr double kFirstDamping = 3.0;
constexpr double kDampingStep = 8.0;

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

  /// What is chosen, never fitted.
  [[nodiscard]] bool is_choice(Eigen::Index j) const {
    return j >= eta_begin() &&
           candidate_.parameters[static_cast<std::size_t>(j - eta_begin())].choice;
  }
  [[nodiscard]] bool is_day(Eigen::Index j) const {
    return j >= eta_begin() &&
           candidate_.parameters[static_cast<std::size_t>(j - eta_begin())].unit == "day";
  }
  [[nodiscard]] bool has_days() const { return candidate_.begins; }
  [[nodiscard]] Eigen::MatrixXd with_days_held(Eigen::MatrixXd jacobian) const {
    for (Eigen::Index j = eta_begin(); j < count(); ++j) {
      if (is_day(j)) jacobian.col(j).setZero();
    }
    return jacobian;
  }
  /// A choice is as it is.
  void hold_choices(GaussianPosterior& posterior) const {
    constexpr double kNothing = 1e-12;
    for (Eigen::Index j = eta_begin(); j < count(); ++j) {
      if (!is_choice(j)) continue;
      posterior.covariance.row(j).setZero();
      posterior.covariance.col(j).setZero();
      posterior.covariance(j, j) = kNothing;
    }
  }
  /// Log of how many ways there were to choose: what one of them pays in evidence.
  [[nodiscard]] double log_choices() const {
    double logs = 0.0;
    for (const EffectParameter& parameter : candidate_.parameters) {
      if (parameter.choice) logs += std::log(static_cast<double>(parameter.scan.size()));
    }
    return logs;
  }

  /// Columns of choices are zero.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& scores, const Eigen::VectorXd& here) {
    Eigen::MatrixXd columns(here.size(), count());
    columns.middleCols(theta_count(), error_count()) = context_.errors;
    Eigen::VectorXd moved = scores;
    for (Eigen::Index j = 0; j < count(); ++j) {
      if (j >= theta_count() && j < eta_begin()) continue;
      if (is_choice(j)) {
        columns.col(j).setZero();
        continue;
      }
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
    if (!is_day(j)) return kScoreStep;
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

/// Gauss-Newton towards the mode, at the context's reference node.
class ModeSearch {
 public:
  ModeSearch(ScoredModel& model, const FitContext& context, const Eigen::VectorXd& start,
             const FitOptions& options)
      : model_(model),
        observations_(context.observations),
        node_(context.grid[context.reference_node]),
        damped_(options.damped) {
    fit.scores = start;
    modelled_ = model_.stacked(start);
    fit.residual = observations_.measured - modelled_;
    fit.log_density = log_posterior(node_, observations_, fit.residual, start);
  }

  /// Linearises and steps. @return what the step gained, 0 where none helped
  Result<double> iterate() {
    if (!std::isfinite(fit.log_density)) {
      return failure(ErrorCode::not_finite,
                     "the hourly model gives no finite power at some values of its parameters");
    }
    fit.jacobian = model_.jacobian(fit.scores, modelled_);
    auto gain = step_by(fit.jacobian);
    if (!gain || *gain > 0.0 || !model_.has_days()) return gain;
    // A day moves the meters by jerks, and a step that trusts its slope may help nothing else.
    return step_by(model_.with_days_held(fit.jacobian));
  }

  JointFit fit;  ///< Scores, residual and Jacobian as found so far.

 private:
  Result<double> step_by(const Eigen::MatrixXd& jacobian) {
    const Eigen::VectorXd linear = fit.residual + jacobian * fit.scores;
    const GramSystem system = node_.gram(observations_, beside(linear, jacobian));
    const auto moves = jacobian.colwise().squaredNorm().transpose().array() > 0.0;
    double damping = 0.0;
    double share = 1.0;
    for (int trial = 0; trial < kTrialsMax; ++trial) {
      const auto target = posterior(system, (1.0 + damping) * unit_precision(model_.count()));
      if (!target) return tl::unexpected(target.error());
      // The damping is a further prior about the present scores; what moves nothing stays.
      const Eigen::VectorXd aim = target->mean + damping * (target->covariance * fit.scores);
      const Eigen::VectorXd tried = (fit.scores + share * moves.select(aim - fit.scores, 0.0))
                                        .cwiseMax(-kScoreLimit)
                                        .cwiseMin(kScoreLimit);
      const Eigen::VectorXd modelled = model_.stacked(tried);
      const Eigen::VectorXd residual = observations_.measured - modelled;
      const double density = log_posterior(node_, observations_, residual, tried);
      if (density > fit.log_density) {
        const double gain = density - fit.log_density;
        fit.scores = tried;
        modelled_ = modelled;
        fit.residual = residual;
        fit.log_density = density;
        return gain;
      }
      if (damped_) {
        damping = std::max(kDampingStep * damping, kFirstDamping);
      } else {
        share *= 0.5;
      }
    }
    return 0.0;
  }

  ScoredModel& model_;
  const Observations& observations_;
  const NoiseNode& node_;
  Eigen::VectorXd modelled_;  ///< With the usual errors, stacked.
  bool damped_;
};

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
  ModeSearch search{model, context, start, options};
  JointFit& fit = search.fit;
  for (fit.iterations = 0; fit.iterations < options.iterations_max && !fit.converged;
       ++fit.iterations) {
    const auto gain = search.iterate();
    if (!gain) return tl::unexpected(gain.error());
    fit.converged = *gain < options.small_gain;
  }
  fit.parts_kW = model.run(fit.scores);
  const auto evidence =
      evidence_over(context.grid, observations, fit.linear_residual(), fit.jacobian);
  if (!evidence) return tl::unexpected(evidence.error());
  fit.log_evidence = evidence->log_evidence - model.log_choices();
  fit.node_weights = evidence->node_weights;
  fit.best_node = evidence->best_node;
  fit.log_likelihood =
      context.grid[static_cast<std::size_t>(fit.best_node)].log_density(observations, fit.residual);
  const auto spread = posterior(context.grid[static_cast<std::size_t>(fit.best_node)].gram(
                                    observations, beside(fit.linear_residual(), fit.jacobian)),
                                unit_precision(model.count()));
  if (!spread) return tl::unexpected(spread.error());
  fit.posterior = *spread;
  model.hold_choices(fit.posterior);
  fit.theta = model.theta(fit.scores);
  fit.usual = model.usual(fit.scores);
  fit.eta = model.eta(fit.scores);
  return std::move(fit);
}

}  // namespace recald::diagnosis
