/// The seed's meta-model: one regression a meter over runs, months and output types.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/random/rng.hpp"
#include "core/regression/design_data.hpp"
#include "core/regression/fit_quality.hpp"
#include "core/regression/stepwise.hpp"
#include "core/result.hpp"

namespace recald::regression {

/// How month inputs become columns of the regression.
struct InputColumns {
  std::vector<std::string> names;   ///< As the terms call them.
  std::vector<ColumnScale> scales;  ///< Of the design's months.
};

/// Month inputs as columns, not yet scaled. A wind direction (`winddir`, degrees from north) is
/// circular: it becomes `winddir_sin` and `winddir_cos` unless asked for in plain degrees.
struct NamedColumns {
  std::vector<std::string> names;
  Eigen::MatrixXd values;  ///< (months x columns)
};
[[nodiscard]] NamedColumns input_columns(const std::vector<std::string>& inputs,
                                         const Eigen::MatrixXd& month_inputs, bool wind_in_degrees);

struct SeedFormOptions {
  /// None: AIC as the seed, unless BIC predicts left-out runs clearly better. AIC counts every row
  /// as a witness, but the months of a run are one when products of parameters are on trial: on 200
  /// runs of 26 parameters it keeps some fifty such products that left-out runs do not confirm.
  std::optional<Criterion> criterion = std::nullopt;
  bool wind_in_degrees = false;  ///< True: as the seed, a plain number.
  int folds = 10;
};

/// One meter's regression on the normalised scale of each output type.
struct SeedFormMeter {
  MeterOutputs outputs;
  std::vector<std::string> variables;  ///< Inputs, `out` if the meter has both types, parameters.
  std::vector<Term> terms;             ///< Chosen.
  double intercept;
  Eigen::VectorXd coefficients;  ///< (terms)
  Criterion chosen_by;
  double aic;      ///< Of the chosen model, as R's `extractAIC`.
  int candidates;  ///< Terms to choose from.
  std::vector<std::string> aliased;
};

struct SeedForm {
  std::vector<std::string> parameters;
  std::vector<ColumnScale> parameter_scales;  ///< Of the design's runs.
  std::vector<std::string> inputs;            ///< As in the design.
  bool wind_in_degrees;
  InputColumns input_columns;
  std::vector<std::string> outputs;
  std::vector<ColumnScale> output_scales;
  std::vector<SeedFormMeter> meters;
  DesignQuality quality;
};

/// Eq. (1) of the seed with two-factor terms, chosen stepwise. Rows are runs x months x output
/// types of one meter; columns the month inputs, `out` (0 consumption, 1 peak) and the parameters,
/// all scaled to [0, 1] by the design, and their products by two.
///
/// The search starts from the full model, as R's `step` would, where the runs can carry it: the
/// products of parameters alone vary over runs only, so their number has to stay well below that of
/// the runs, however many rows there are. Otherwise it starts without these products.
///
/// Cross-validation leaves runs out and repeats the choice of terms in every fold (that between AIC
/// and BIC excepted: it is made once, by the left-out error).
///
/// @param rng  Deals the runs into folds.
/// @return the regressions, or what `check_design` finds, or
///         not_enough_data  no month inputs, or fewer months than they need.
[[nodiscard]] Result<SeedForm> fit_seed_form(const DesignData& design,
                                             const SeedFormOptions& options, Rng& rng);

}  // namespace recald::regression
