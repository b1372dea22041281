/// The other meta-model: one regression an output and month, on the parameters alone.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/random/rng.hpp"
#include "core/regression/design_data.hpp"
#include "core/regression/fit_quality.hpp"
#include "core/regression/stepwise.hpp"
#include "core/result.hpp"

namespace recald::regression {

struct MonthlyFormOptions {
  /// The rows are few and the candidates many, so AIC takes all it can get: on 200 runs of 26
  /// parameters it left 0.974 of R2 on runs left out, the corrected one 0.9956, BIC 0.9970.
  Criterion criterion = Criterion::bic;
  int folds = 10;
};

/// The regressions of one output, on its normalised scale; the same columns for all months.
struct MonthlyFormOutput {
  std::vector<Term> terms;     ///< Variables are the parameters.
  Eigen::VectorXd intercepts;  ///< (months)
  /// (months) Of the bend at nothing (rectified_fit.hpp); 0: there is none.
  Eigen::VectorXd widths;
  Eigen::MatrixXd coefficients;  ///< (terms x months)
};

struct MonthlyForm {
  std::vector<std::string> parameters;
  std::vector<ParameterCap> caps;             ///< As the design's.
  std::vector<ColumnScale> parameter_scales;  ///< Of the design's runs, capped.
  std::vector<std::string> months;            ///< The only ones it can speak of.
  std::vector<std::string> outputs;
  std::vector<ColumnScale> output_scales;
  std::vector<MonthlyFormOutput> fits;  ///< (outputs)
  int candidates;                       ///< Terms to choose from.
  DesignQuality quality;
};

/// Main effects, squares and two-factor products of the parameters scaled to [0, 1], chosen
/// stepwise from the empty model, so that terms may outnumber runs.
///
/// The months of an output share one choice of terms and have coefficients of their own. A choice a
/// month predicts left-out runs no better (0.9968 against 0.9970 in the case above) at twenty times
/// the cost, and a term that matters in July is worth knowing in June.
///
/// Heating and cooling stop where nothing is needed, which no polynomial does. So a month whose
/// left-out runs are predicted better with a bend at zero has one: on an office's chilled water it
/// halved the error.
///
/// Months have no order here: nothing is said of one that the design does not cover.
///
/// @param rng  Deals the runs into folds. The choice of terms is repeated in every fold.
/// @return the regressions, or what `check_design` finds.
/// @note   The columns are the same for every output and month: X'X is made once.
[[nodiscard]] Result<MonthlyForm> fit_monthly_form(const DesignData& design,
                                                   const MonthlyFormOptions& options, Rng& rng);

}  // namespace recald::regression
