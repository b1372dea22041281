/// How building models usually err: a little in every way that the catalogue knows.
///
/// Where nothing is hidden a calibrated model still leaves gaps that look like a little of an
/// effect on all meters at once: some per cent of a scale, a touch of an open damper. Sigma of one
/// meter cannot know that. So every competing model carries, with small amounts learnt where
/// nothing was hidden, all effects of the catalogue:
///     y = f(theta, eta) + E b + Z a + u + e,   b ~ N(0, I),
/// E holding the footprint of each effect for one learnt standard deviation of its amount. A named
/// effect is then one that is there in far more than the usual amount, and what two effects share
/// with the usual errors speaks for neither.
/// @see Brynjarsdottir, O'Hagan (2014), Inverse Problems 30(11): why a model needs its discrepancy.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "core/diagnosis/observations.hpp"
#include "core/diagnosis/site_problem.hpp"

namespace recald::diagnosis {

class UsualErrors {
 public:
  /// A model that errs by its parameters and its noise alone.
  UsualErrors() = default;

  /// One footprint for each undated shape of every effect that the site could show.
  /// @param predictor  The model; its runs are what this costs, some fifty.
  /// @param theta      (q) where the footprints are drawn: base parameters at their mode.
  [[nodiscard]] static UsualErrors draw(Predictor& predictor, const SiteProblem& site,
                                        std::span<const double> theta);

  [[nodiscard]] Eigen::Index count() const { return std::ssize(footprints_kW_); }

  /// E (n x count) on the meters' scales.
  [[nodiscard]] Eigen::MatrixXd columns(const Observations& observations) const;

  /// The effect that a column is a little of.
  [[nodiscard]] const std::vector<std::string_view>& effects() const { return effects_; }

 private:
  Eigen::ArrayXXd base_kW_;                     ///< (parts x m)
  std::vector<Eigen::ArrayXXd> footprints_kW_;  ///< Each (parts x m), of one sd.
  std::vector<std::string_view> effects_;
};

/// Standard deviation of an effect's amount where it is not there, in units of its typical amount.
/// @return the median of all effects for one that was not there when this was learnt.
/// @see tests/results/diagnosis.md for the population that taught it.
[[nodiscard]] double usual_amount_sd(std::string_view effect);

}  // namespace recald::diagnosis
