/// How large the lasso's penalty should be: what predicts runs that were left out.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/regression/cross_products.hpp"
#include "core/regression/folds.hpp"
#include "core/result.hpp"
#include "core/screening/lasso.hpp"

namespace recald::screening {

struct LassoCrossValidation {
  LassoPath path;                  ///< Of all rows.
  Eigen::VectorXd error;           ///< Mean square left-out error by penalty, responses summed.
  Eigen::VectorXd standard_error;  ///< Of `error`, from its spread over the folds.
  int best;                        ///< Index of the smallest error.
  int chosen;  ///< Largest penalty whose error is within one standard error of the smallest.
};

/// K-fold cross-validation of the lasso path.
///
/// The training sums of a fold are the total less its own, so the rows are read once whatever the
/// number of folds; left-out errors come from the fold's sums as well.
///
/// @param folds  Sums over the rows of each fold, at least two; every row in exactly one.
/// @return what fits and what was chosen, or
///         not_finite     a missing or infinite value;
///         invalid_value  no response varies, or the lasso does not settle.
/// @note   Folds are weighted by their rows, as glmnet's cv.glmnet does.
/// @see    Hastie, Tibshirani, Friedman (2009), The Elements of Statistical Learning, 7.10.
[[nodiscard]] Result<LassoCrossValidation> cross_validate_lasso(
    std::span<const regression::CrossProducts> folds, const LassoOptions& options = {});

/// Sums over the rows of each fold of runs.
///
/// @param x  (rows x p), @param y  (rows x m): centred about the means of all rows on the way, so
///           that no digits are lost.
/// @param run_of_row  (rows) which run a row belongs to.
[[nodiscard]] std::vector<regression::CrossProducts> fold_products(
    const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, std::span<const int> run_of_row,
    const regression::RunFolds& folds);

}  // namespace recald::screening
