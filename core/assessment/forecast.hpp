/// What was expected of one output before its month was seen, and how surprising the month was.
#pragma once

#include <Eigen/Core>

namespace recald::assessment {

/// A mixture of normal distributions, one a particle of the posterior: given parameters and
/// hyper-parameters a month is normal, and those are not known.
struct Forecast {
  Eigen::VectorXd means;    ///< (n) in the output's unit.
  Eigen::VectorXd sds;      ///< (n) > 0
  Eigen::VectorXd weights;  ///< (n) >= 0, sum 1.

  [[nodiscard]] double mean() const;
  [[nodiscard]] double sd() const;
  [[nodiscard]] double cdf(double value) const;
  /// To 1e-9 sd. @pre 0 < probability < 1
  [[nodiscard]] double quantile(double probability) const;
};

/// How a forecast did. All of them are proper: nobody gains by saying other than what he believes.
struct Surprise {
  double pit;           ///< Probability integral transform, in (0, 1): F(y).
  double standardised;  ///< Normal score of the PIT: standard normal where forecasts are true.
  double log_score;     ///< log density at y, in 1/unit; larger is better.
  double crps;          ///< Continuous ranked probability score, in the unit; smaller is better.
};

/// Surprise::log_score alone, O(n).
[[nodiscard]] double log_density(const Forecast& forecast, double measured);

/// Surprise::standardised alone, O(n).
[[nodiscard]] double standardised_surprise(const Forecast& forecast, double measured);

/// @note  O(n^2), for the CRPS.
/// @see   Dawid (1984), J. R. Stat. Soc. A 147, on the prequential approach; Gneiting, Raftery
///        (2007), J. Am. Stat. Assoc. 102, eq. (20) for the CRPS.
[[nodiscard]] Surprise surprise_of(const Forecast& forecast, double measured);

}  // namespace recald::assessment
