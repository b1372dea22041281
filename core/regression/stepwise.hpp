/// Stepwise choice of the terms of a regression by an information criterion.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/regression/cross_products.hpp"
#include "core/regression/term.hpp"
#include "core/result.hpp"

namespace recald::regression {

enum class Criterion {
  aic,            ///< Akaike (1974); penalty 2 a coefficient, as in R's `step`.
  aic_corrected,  ///< Hurvich, Tsai (1989): for models whose size is not small against the rows.
  bic,            ///< Schwarz (1978); penalty log(rows) a coefficient.
};

struct StepwiseOptions {
  enum class Start {
    full,   ///< Backward first, as R's `step` on a full model; needs more rows than terms.
    empty,  ///< Forward first; terms may outnumber rows.
    given,  ///< From `given_columns`.
  };

  Criterion criterion = Criterion::aic;
  Start start = Start::full;
  /// Start model for `given`, ascending, parents before children; fewer than rows - 2.
  std::vector<int> given_columns = {};
  /// A column of which the model's columns explain all but this share is aliased: it stays out.
  double tolerance = 1e-9;
  int terms_max = 0;        ///< Never more terms than this; 0: rows - 2.
  int steps_max = 100'000;  ///< Only a bug can reach it: each step lowers the criterion.
};

struct StepwiseFit {
  std::vector<int> columns;          ///< Chosen, ascending. (k)
  Eigen::MatrixXd coefficients;      ///< (k x m)
  Eigen::VectorXd intercepts;        ///< (m)
  Eigen::VectorXd residual_squares;  ///< (m)
  double criterion;                  ///< Without the constant n log(2 pi) + n, as R's `extractAIC`.
  int steps;                         ///< Columns that came or went after the start.
  std::vector<int> aliased;          ///< Kept out of the start model because others determine them.
};

/// m n log(RSS / (m n)) + penalty, for m responses on the same k terms and an intercept, RSS summed
/// over them. With m = 1 and `aic` this is R's `extractAIC(fit)`: n log(RSS/n) + 2 (k + 1).
[[nodiscard]] double information_criterion(Criterion criterion, double residual_squares,
                                           double rows, double responses, int terms);

/// Moves, one column at a time, to the neighbouring model with the smallest criterion until none is
/// better: a column may come in when its parents are in, and go when no child of it is in.
///
/// Several responses share one set of terms and have a coefficient each.
///
/// @param products  p columns and m responses about their means.
/// @param parents   (p) see `Parents`.
/// @return the model, or
///         not_enough_data  the start model has more than rows - 2 terms;
///         not_finite       a NaN or infinity in the products.
///         A response without spread gives a model without terms; that is no error.
/// @note   One sweep, p^2 / 2 + p m multiplications, a step; the rows are never seen again. The
///         coefficients are solved anew for the chosen columns, so rounding does not pile up.
/// @see    Venables, Ripley (2002), Modern Applied Statistics with S, 6.8: `stepAIC`.
[[nodiscard]] Result<StepwiseFit> stepwise(const CentredProducts& products,
                                           std::span<const Parents> parents,
                                           const StepwiseOptions& options);

}  // namespace recald::regression
