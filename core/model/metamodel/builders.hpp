/// Builds a model of given months from a fitted meta-model or a given regression.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "core/model/metamodel/gaussian_model.hpp"
#include "core/model/metamodel/quadratic_model.hpp"
#include "core/model/parameter.hpp"
#include "core/regression/monthly_form.hpp"
#include "core/regression/seed_form.hpp"
#include "core/result.hpp"

namespace recald::model::metamodel {

/// Known inputs of the months to model, in their own units.
struct MonthInputs {
  std::vector<std::string> names;   ///< (p) in any order; additional ones are ignored.
  std::vector<std::string> months;  ///< (m) for sentences: "2018-03".
  Eigen::MatrixXd values;           ///< (m x p)
};

/// The seed's form for any months, including those outside the design: outputs in the order of
/// the design, in their units. Inputs are scaled as in the design, so a month outside its range
/// is an extrapolation.
/// @return the model; or
///         not_found   an input of the regression is not among the names;
///         not_finite  an input has no number in a month.
[[nodiscard]] Result<QuadraticModel> model_of(const regression::SeedForm& form,
                                              const MonthInputs& inputs);

/// The monthly form, for some of the design's months in any order.
/// @return the model, or not_found for a month outside the design.
[[nodiscard]] Result<GaussianModel> model_of(const regression::MonthlyForm& form,
                                             std::span<const std::string> months);

/// A coefficient as a file names it: "(Intercept)", "drybulb", "drybulb:t_cool" or "t_cool^2".
struct NamedCoefficient {
  std::string term;
  double value;
};

/// A regression made elsewhere: its coefficients and the meaning of its scaled axes.
struct GivenRegression {
  std::vector<NamedCoefficient> terms;
  std::vector<std::string> parameters;
  std::vector<regression::ColumnScale> parameter_scales;  ///< Of the priors: `prior_scales`.
  std::vector<std::string> inputs;
  std::vector<regression::ColumnScale> input_scales;  ///< Of the measured months.
  std::vector<regression::ColumnScale>
      output_scales;  ///< One, or consumption (`out` = 0), peak (1).
};

/// Min and max of each prior. @pre all are bounded
[[nodiscard]] std::vector<regression::ColumnScale> prior_scales(
    std::span<const Parameter> parameters);

/// The given regression for any months. Nothing is refitted, and an input called `winddir` is a
/// plain number in degrees. If `output_scales` are {0, 1}, the outputs are the normalised ones.
/// @return the model; or
///         invalid_value  a term with an unknown factor, more than two factors, a coefficient that
///                        is repeated or not finite: names the term and the known factors;
///         not_found, not_finite  as above.
[[nodiscard]] Result<QuadraticModel> model_of(const GivenRegression& regression,
                                              const MonthInputs& inputs);

}  // namespace recald::model::metamodel
