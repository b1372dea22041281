/// The distribution of one parameter over a population of buildings, from their calibrations.
#pragma once

#include <span>
#include <vector>

#include "core/model/prior.hpp"
#include "core/result.hpp"

namespace recald::population {

/// What the calibration of one site says of the parameter, in its own unit.
struct SitePosterior {
  double q05;
  double q50;
  double q95;
  Prior prior;  ///< Under which it was calibrated.
};

/// A site's likelihood without its prior: normal(score, sd) in normal scores of that prior.
struct SiteEvidence {
  double score;
  double sd;
};

/// Sites that say less than this of a parameter are not counted: 1 - variance of the posterior, in
/// scores. Below it the noise of the draws would be amplified.
inline constexpr double kLeastContraction = 0.1;
/// Fewer sites than this show no spread. Of many sites half have to say something: the few that do
/// where most do not are those that chance or the model's errors have moved.
inline constexpr int kSitesMin = 5;

/// In scores z = Phi^-1(F(theta)) the prior is normal(0, 1). A posterior with the median m and the
/// variance v, of (q95 - q05) / 3.29, is the product of it and a normal likelihood of
///
///     precision 1/v - 1,  mean m / (1 - v).
///
/// @return one for each site whose 1 - v reaches `kLeastContraction`, in their order.
[[nodiscard]] std::vector<SiteEvidence> evidence_of(std::span<const SitePosterior> sites);

/// Where the parameter of a further building of the population lies, in normal scores of its prior.
struct Population {
  int sites;        ///< That said something.
  double location;  ///< Mean of the population's centre mu.
  double location_sd;
  double spread;                   ///< Mean of the scale tau of its buildings.
  std::vector<double> scores;      ///< Increasing.
  std::vector<double> cumulative;  ///< Probability of a score below each of them.

  /// Inverse of the predictive distribution. @pre 0 < probability < 1
  [[nodiscard]] double quantile(double probability) const;
};

/// Site i has the evidence y_i with the sd s_i, and
///
///     y_i ~ normal(z_i, s_i^2),  z_i ~ t_4(mu, tau),  mu ~ normal(0, 1/2),  tau ~
///     half-normal(1/2).
///
/// Student's t lets an unusual building be unusual, instead of moving the others. A t_4 has the
/// variance 2 tau^2: with no site, mu and z together have the variance 1 of the prior. mu and tau
/// are integrated over a grid, so their own uncertainty is in the predictive.
///
/// @return not_enough_data, and the sentence why, where fewer than `kSitesMin` sites or fewer than
///         half of them say something.
/// @see Gelman et al. (2013), Bayesian Data Analysis, 3rd ed.: sections 5.4 (hierarchical normal
///      model, eq. 5.16 to 5.21) and 17.4 (the same by t). Gelman (2006), Bayesian Analysis 1(3),
///      515-534: the prior of tau. Higgins, Thompson, Spiegelhalter (2009), J. R. Stat. Soc. A
///      172(1), 137-159: the predictive is what a further member is told.
[[nodiscard]] Result<Population> estimate_population(std::span<const SitePosterior> sites);

}  // namespace recald::population
