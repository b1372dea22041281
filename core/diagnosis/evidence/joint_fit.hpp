/// Base parameters and one candidate effect fitted together, from their original priors.
///
/// All parameters are standard normal scores: value = prior.at_score(u), so the prior of all scores
/// is N(0, I) and no value ever leaves its prior. Damped Gauss-Newton steps find the mode under
/// nearly white noise. Recurring patterns and usual errors are left out of this search, because
/// they could replace the building's parameters, and footprints would be wrong at the resulting
/// mode. At the mode the model is linearised. The evidence is that of the linear model with all
/// possible errors, at every node of the noise grid.
/// @see Tierney, Kadane (1986), J. Am. Stat. Assoc. 81(393): Laplace's approximation.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/diagnosis/evidence/observations.hpp"
#include "core/diagnosis/evidence/posterior_algebra.hpp"
#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

struct FitOptions {
  int iterations_max = 20;
  double small_gain = 1.0;  ///< Stop when an iteration gains less log posterior density than this.
};

/// No score is farther from 0: so many standard deviations of its prior.
inline constexpr double kScoreLimit = 5.0;

/// A model linearised at its mode, with the likeliest usual errors there.
struct JointFit {
  Eigen::VectorXd scores;        ///< (q + k + r) at the mode: theta, usual errors, eta.
  std::vector<double> theta;     ///< (q)
  Eigen::VectorXd usual;         ///< (k) amounts b of the usual errors.
  std::vector<double> eta;       ///< (r)
  Eigen::VectorXd residual;      ///< (n) measured - modelled - E b, on the scale.
  Eigen::MatrixXd jacobian;      ///< (n x (q + k + r)) with respect to the scores.
  Eigen::ArrayXXd parts_kW;      ///< (parts x m) the model at the mode, whole period, without E b.
  double log_density = 0.0;      ///< Of theta and eta under the search's noise, up to a constant.
  double log_evidence = 0.0;     ///< Over the grid.
  Eigen::VectorXd node_weights;  ///< (nodes) posterior.
  Eigen::Index best_node = 0;
  GaussianPosterior posterior;  ///< Of the scores at the best node.
  bool converged = false;

  /// r + J u: the residual column of the linear model with prior N(0, I) at score 0.
  [[nodiscard]] Eigen::VectorXd linear_residual() const { return residual + jacobian * scores; }
};

/// The data and noise of a fit. References live as long as the call.
struct FitContext {
  const SiteProblem& site;
  const Observations& observations;
  const Eigen::MatrixXd& errors;  ///< E (n x k), usual errors of these observations; k may be 0.
  const std::vector<NoiseNode>& grid;
  std::size_t reference_node;  ///< Used for the likeliest amounts of the usual errors.
  const NoiseNode& search;     ///< Nearly white: the mode is found under this noise.
};

/// @param candidate  effect == nullptr: the base model alone.
/// @param start      (q + k + r) scores.
/// @return the fit, converged or not; not_finite if the model gives no finite values.
[[nodiscard]] Result<JointFit> fit_jointly(Predictor& predictor, const FitContext& context,
                                           const Candidate& candidate, const Eigen::VectorXd& start,
                                           const FitOptions& options = {});

/// The likeliest amounts of the usual errors at the context's reference node, in place.
[[nodiscard]] Result<void> take_usual_errors(const FitContext& context, JointFit& fit);

/// The values of scores. @param priors  (r) in order.
[[nodiscard]] std::vector<double> values_at(std::span<const Prior> priors,
                                            const Eigen::Ref<const Eigen::VectorXd>& scores);
[[nodiscard]] std::vector<Prior> priors_of(const SiteProblem& site);
[[nodiscard]] std::vector<Prior> priors_of(const Candidate& candidate);

/// The score of a value, limited to +-limit.
[[nodiscard]] double score_of(const Prior& prior, double value, double limit = 3.0);

}  // namespace recald::diagnosis
