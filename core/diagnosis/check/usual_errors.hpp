/// The usual errors of building models: small amounts of every effect in the catalogue.
///
/// Even if nothing is hidden, a calibrated model leaves gaps that look like a small amount of an
/// effect on all meters at once: some per cent of a scale, a slightly open damper. Sigma of one
/// meter cannot represent that. So every competing model includes all effects of the catalogue,
/// with small amounts learnt where nothing was hidden:
///     y = f(theta, eta) + E b + Z a + u + e,   b ~ N(0, I),
/// where E holds the footprint of each effect for one learnt standard deviation of its amount. A
/// named effect is one that is present in far more than its usual amount, and what two effects have
/// in common with the usual errors supports neither.
/// @see Brynjarsdottir, O'Hagan (2014), Inverse Problems 30(11): why a model needs its discrepancy.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "core/diagnosis/evidence/observations.hpp"
#include "core/diagnosis/evidence/site_problem.hpp"

namespace recald::diagnosis {

class UsualErrors {
 public:
  /// A model with no errors besides its parameters and noise.
  UsualErrors() = default;

  /// One footprint for each undated shape of every effect that could be visible at the site.
  /// @param predictor  The model; this takes about fifty runs.
  /// @param theta      (q) where the footprints are drawn: base parameters at their mode.
  [[nodiscard]] static UsualErrors draw(Predictor& predictor, const SiteProblem& site,
                                        std::span<const double> theta);

  [[nodiscard]] Eigen::Index count() const { return std::ssize(footprints_kW_); }

  /// E (n x count) on the meters' scales.
  [[nodiscard]] Eigen::MatrixXd columns(const Observations& observations) const;

  /// The effect of each column.
  [[nodiscard]] const std::vector<std::string_view>& effects() const { return effects_; }

 private:
  Eigen::ArrayXXd base_kW_;                     ///< (parts x m)
  std::vector<Eigen::ArrayXXd> footprints_kW_;  ///< Each (parts x m), of one sd.
  std::vector<std::string_view> effects_;
};

/// Standard deviation of an effect's amount where it is absent, in units of its typical amount.
/// Learnt before lights and plugs were read off the meter anew in each run.
/// @return the median of all effects for one that was not visible in the training population.
/// @see tests/results/diagnosis.md for that population.
[[nodiscard]] double usual_amount_sd(std::string_view effect);

}  // namespace recald::diagnosis
