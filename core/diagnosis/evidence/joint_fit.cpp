#include "core/diagnosis/evidence/joint_fit.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace recald::diagnosis {
namespace {

// Slopes are taken over steps as long as the remaining uncertainty of a score, or slightly longer,
// because the model has kinks at thermostats and valves.
constexpr double kScoreStep = 0.03;
constexpr double kEffectStep = 0.1;
// A tenth of a score could move a day by a month; two days are still many parts.
constexpr double kDayStep_d = 2.0;
constexpr int kTrialsMax = 6;
// Precision of the damped steps, in units of the priors': the minimum, and factors after a failed
// step and after one that helped at once.
constexpr double kLeastDamping = 3.0;
constexpr double kMoreDamping = 8.0;
constexpr double kLessDamping = 0.1;
constexpr double kNoDamping = 0.05;

/// Runs the model at its own scores v = [theta | eta] (q + r) and stacks the result.
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
  [[nodiscard]] Eigen::Index eta_count() const {
    return static_cast<Eigen::Index>(eta_priors_.size());
  }
  [[nodiscard]] Eigen::Index count() const { return theta_count() + eta_count(); }
  [[nodiscard]] std::vector<double> theta(const Eigen::VectorXd& own) const {
    return values_at(theta_priors_, own.head(theta_count()));
  }
  [[nodiscard]] std::vector<double> eta(const Eigen::VectorXd& own) const {
    return values_at(eta_priors_, own.tail(eta_count()));
  }
  const Eigen::ArrayXXd& run(const Eigen::VectorXd& own) { return run_by(predictor_, own); }
  Eigen::VectorXd stacked(const Eigen::VectorXd& own) {
    return context_.observations.stack(run(own));
  }
  [[nodiscard]] bool is_stopped() const { return predictor_.is_stopped(); }

  /// Whether the parameter is chosen, not fitted. @param j  Index into eta.
  [[nodiscard]] bool is_choice(Eigen::Index j) const { return parameter(j).choice; }
  [[nodiscard]] bool is_day(Eigen::Index j) const { return parameter(j).unit == "day"; }
  [[nodiscard]] bool has_days() const { return candidate_.begins; }
  [[nodiscard]] Eigen::MatrixXd with_days_held(Eigen::MatrixXd jacobian) const {
    for (Eigen::Index j = 0; j < eta_count(); ++j) {
      if (is_day(j)) jacobian.col(theta_count() + j).setZero();
    }
    return jacobian;
  }
  /// Fixes the choices. @param eta_begin  Index in the posterior.
  void hold_choices(Eigen::Index eta_begin, GaussianPosterior& posterior) const {
    constexpr double kNoSpread = 1e-12;
    for (Eigen::Index j = 0; j < eta_count(); ++j) {
      if (!is_choice(j)) continue;
      posterior.covariance.row(eta_begin + j).setZero();
      posterior.covariance.col(eta_begin + j).setZero();
      posterior.covariance(eta_begin + j, eta_begin + j) = kNoSpread;
    }
  }
  /// Log of the number of choices, which is subtracted from the evidence of each.
  [[nodiscard]] double log_choices() const {
    double logs = 0.0;
    for (const EffectParameter& parameter : candidate_.parameters) {
      if (parameter.choice) logs += std::log(static_cast<double>(parameter.scan.size()));
    }
    return logs;
  }

  /// (n x (q + r)); columns of choices are zero.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& own, const Eigen::VectorXd& here) {
    Eigen::MatrixXd columns(here.size(), count());
    predictor_.for_each(
        static_cast<std::size_t>(count()), [&](Predictor& predictor, std::size_t index) {
          const auto j = static_cast<Eigen::Index>(index);
          if (j >= theta_count() && is_choice(j - theta_count())) {
            columns.col(j).setZero();
            return;
          }
          // Towards the middle of the prior, so that the step stays plausible.
          const double step = (own[j] > 0.0 ? -1.0 : 1.0) * step_of(j, own[j]);
          Eigen::VectorXd moved = own;
          moved[j] = own[j] + step;
          columns.col(j) = (context_.observations.stack(run_by(predictor, moved)) - here) / step;
        });
    return columns;
  }

 private:
  const Eigen::ArrayXXd& run_by(Predictor& predictor, const Eigen::VectorXd& own) const {
    const std::vector<double> values = theta(own);
    if (candidate_.effect == nullptr) return predictor.parts_kW(values);
    const auto alteration = alteration_of(candidate_, facts_, eta(own));
    return predictor.parts_kW(values, alteration.get());
  }
  [[nodiscard]] const EffectParameter& parameter(Eigen::Index j) const {
    return candidate_.parameters[static_cast<std::size_t>(j)];
  }
  [[nodiscard]] double step_of(Eigen::Index j, double score) const {
    if (j < theta_count()) return kScoreStep;
    if (!is_day(j - theta_count())) return kEffectStep;
    const Prior& prior = eta_priors_[static_cast<std::size_t>(j - theta_count())];
    const double days_per_score = std::abs(prior.at_score(score).derivative);
    return std::clamp(kDayStep_d / std::max(days_per_score, 1e-6), 1e-4, kEffectStep);
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

/// The current point of a search.
struct Place {
  Eigen::VectorXd own;       ///< (q + r)
  Eigen::VectorXd residual;  ///< (n) measured - modelled
  Eigen::MatrixXd jacobian;  ///< (n x (q + r)) of the model near `own`, as last made or learnt.
  double log_density = 0.0;  ///< Posterior under the search's noise, up to a constant.
  double damping = 0.0;
};

/// Climbs towards the mode with damped Gauss-Newton steps, under the context's
/// noise for the search.
class ModeSearch {
 public:
  ModeSearch(ScoredModel& model, const FitContext& context, const Eigen::VectorXd& start)
      : model_(model), observations_(context.observations), noise_(context.search) {
    move_to(start.cwiseMax(-kScoreLimit).cwiseMin(kScoreLimit));
  }

  /// @return whether it converged
  Result<bool> climb(int iterations_max, double small_gain) {
    // With slopes made anew and then learnt from each step, as long as that brings much.
    constexpr double kMuch = 0.1;  // Of the gain with new slopes.
    constexpr int kQuickStepsMax = 4;
    for (int iteration = 0; iteration < iterations_max; ++iteration) {
      const bool is_free = place.damping == 0.0;
      auto gain = iterate();
      if (!gain) return tl::unexpected(gain.error());
      if (*gain < small_gain) {
        if (is_free) return true;
        place.damping = 0.0;  // A damped step is short, wherever the mode is.
        continue;
      }
      const double much = std::max(kMuch * *gain, small_gain);
      for (int i = 0; i < kQuickStepsMax && *gain >= much; ++i) {
        const double damping = place.damping;
        gain = step_by(place.jacobian);
        if (!gain) return tl::unexpected(gain.error());
        if (*gain == 0.0) place.damping = damping;  // The slopes were poor, not the length.
      }
    }
    return false;
  }

  Place place;

 private:
  void move_to(const Eigen::VectorXd& own) {
    place.own = own;
    place.residual = observations_.measured - model_.stacked(own);
    place.log_density = log_density(place.residual, own);
    place.damping = 0.0;
  }

  [[nodiscard]] double log_density(const Eigen::VectorXd& residual,
                                   const Eigen::VectorXd& own) const {
    return -0.5 * (noise_.squared_norms(observations_, residual)[0] + own.squaredNorm());
  }

  /// Linearises and steps.
  /// @return the gain of the step, 0 if none helped
  Result<double> iterate() {
    if (!std::isfinite(place.log_density)) {
      return failure(
          ErrorCode::not_finite,
          "the hourly model does not give a finite power for some values of its parameters");
    }
    place.jacobian = model_.jacobian(place.own, observations_.measured - place.residual);
    auto gain = step_by(place.jacobian);
    if (!gain || *gain > 0.0 || !model_.has_days()) return gain;
    // Moving a day changes the meters in jumps, and a step based on its slope may not help.
    place.damping = 0.0;
    return step_by(model_.with_days_held(place.jacobian));
  }

  /// Steps with these slopes, and lets the place's own slopes learn from the step.
  /// @see Broyden (1965), A class of methods for solving nonlinear simultaneous equations.
  Result<double> step_by(const Eigen::MatrixXd& slopes) {
    if (model_.is_stopped()) return tl::unexpected(diagnosis_cancelled());
    const Eigen::VectorXd linear = place.residual + slopes * place.own;
    const GramSystem system = noise_.gram(observations_, beside(linear, slopes));
    const auto moves = slopes.colwise().squaredNorm().transpose().array() > 0.0;
    for (int trial = 0; trial < kTrialsMax; ++trial) {
      const auto target =
          TRY(posterior(system, (1.0 + place.damping) * unit_precision(model_.count())));
      // The damping is an additional prior around the current scores; scores without effect stay.
      const Eigen::VectorXd aim = target.mean + place.damping * (target.covariance * place.own);
      const Eigen::VectorXd tried = (place.own + moves.select(aim - place.own, 0.0))
                                        .cwiseMax(-kScoreLimit)
                                        .cwiseMin(kScoreLimit);
      const Eigen::VectorXd residual = observations_.measured - model_.stacked(tried);
      const double density = log_density(residual, tried);
      if (density > place.log_density) {
        const double gain = density - place.log_density;
        const Eigen::VectorXd step = tried - place.own;
        const Eigen::VectorXd unforeseen = place.residual - residual - place.jacobian * step;
        place.jacobian += unforeseen * (step / step.squaredNorm()).transpose();
        place.own = tried;
        place.residual = residual;
        place.log_density = density;
        if (trial == 0) place.damping *= kLessDamping;
        if (place.damping < kNoDamping) place.damping = 0.0;
        return gain;
      }
      place.damping = std::max(kMoreDamping * place.damping, kLeastDamping);
    }
    return 0.0;
  }

  ScoredModel& model_;
  const Observations& observations_;
  const NoiseNode& noise_;
};

/// The evidence of a linear model, by node of the noise.
struct GridEvidence {
  double log_evidence;
  Eigen::VectorXd node_weights;
  Eigen::Index best_node;
};

Result<GridEvidence> evidence_over(const std::vector<NoiseNode>& grid,
                                   const Observations& observations,
                                   const Eigen::VectorXd& linear_residual,
                                   const Eigen::MatrixXd& jacobian, const ForEachIndex& executor) {
  const Eigen::MatrixXd columns = beside(linear_residual, jacobian);
  const auto nodes = static_cast<Eigen::Index>(grid.size());
  std::vector<Result<double>> found(grid.size());
  executor(grid.size(), [&](std::size_t i) {
    found[i] = marginalise(grid[i].gram(observations, columns), unit_precision(jacobian.cols()))
                   .map([](const auto& reduced) { return log_evidence(reduced); });
  });
  Eigen::VectorXd evidences(nodes);
  Eigen::VectorXd weights(nodes);
  for (Eigen::Index i = 0; i < nodes; ++i) {
    const auto& evidence = found[static_cast<std::size_t>(i)];
    if (!evidence) return tl::unexpected(evidence.error());
    evidences[i] = *evidence;
    weights[i] = grid[static_cast<std::size_t>(i)].log_weight;
  }
  GridEvidence result{combine_nodes(evidences, weights), node_weights(evidences, weights), 0};
  result.node_weights.maxCoeff(&result.best_node);
  return result;
}

/// The three kinds of scores in order: (q + k + r).
Eigen::VectorXd all_scores(const Eigen::VectorXd& own, const Eigen::VectorXd& usual,
                           Eigen::Index q) {
  Eigen::VectorXd scores(own.size() + usual.size());
  scores << own.head(q), usual, own.tail(own.size() - q);
  return scores;
}

Eigen::VectorXd own_scores(const Eigen::VectorXd& scores, Eigen::Index q, Eigen::Index r) {
  Eigen::VectorXd own(q + r);
  own << scores.head(q), scores.tail(r);
  return own;
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

Result<void> take_usual_errors(const FitContext& context, JointFit& fit) {
  const NoiseNode& reference = context.grid[context.reference_node];
  const Eigen::Index k = context.errors.cols();
  const Eigen::VectorXd left = fit.residual + context.errors * fit.usual;
  const auto usual = TRY(posterior(
      reference.gram(context.observations, beside(left, context.errors)), unit_precision(k)));
  fit.usual = usual.mean;
  fit.scores.segment(std::ssize(context.site.parameters), k) = fit.usual;
  fit.residual = left - context.errors * fit.usual;
  return {};
}

Result<JointFit> fit_jointly(Predictor& predictor, const FitContext& context,
                             const Candidate& candidate, const Eigen::VectorXd& start,
                             const FitOptions& options) {
  ScoredModel model{predictor, context, candidate};
  const Observations& observations = context.observations;
  const Eigen::Index q = model.theta_count();
  const Eigen::Index k = context.errors.cols();
  const Eigen::Index r = model.eta_count();
  ModeSearch search{model, context, own_scores(start, q, r)};
  auto ended = TRY(search.climb(options.iterations_max, options.small_gain));
  if (predictor.is_stopped()) return tl::unexpected(diagnosis_cancelled());
  const Place& place = search.place;
  JointFit fit;
  fit.converged = ended;
  fit.log_density = place.log_density;
  fit.theta = model.theta(place.own);
  fit.eta = model.eta(place.own);
  fit.scores = all_scores(place.own, Eigen::VectorXd::Zero(k), q);
  fit.residual = place.residual;
  fit.usual = Eigen::VectorXd::Zero(k);
  TRY(take_usual_errors(context, fit));
  fit.jacobian.resize(observations.count(), q + k + r);
  fit.jacobian << place.jacobian.leftCols(q), context.errors, place.jacobian.rightCols(r);
  fit.parts_kW = model.run(place.own);
  const auto evidence = TRY(evidence_over(context.grid, observations, fit.linear_residual(),
                                          fit.jacobian, predictor.executor()));
  fit.log_evidence = evidence.log_evidence - model.log_choices();
  fit.node_weights = evidence.node_weights;
  fit.best_node = evidence.best_node;
  const NoiseNode& best = context.grid[static_cast<std::size_t>(fit.best_node)];
  fit.posterior =
      TRY(posterior(best.gram(observations, beside(fit.linear_residual(), fit.jacobian)),
                    unit_precision(q + k + r)));
  model.hold_choices(q + k, fit.posterior);
  return fit;
}

}  // namespace recald::diagnosis
