/// How sure a selection is: what the lasso selects on halves of the runs.
#pragma once

#include <Eigen/Core>

#include "core/random/rng.hpp"
#include "core/result.hpp"
#include "core/screening/lasso.hpp"

namespace recald::screening {

struct StabilityOptions {
  int half_samples = 50;  ///< Rounded up to an even number: halves come in complementary pairs.
};

/// Fits the lasso with one penalty to random halves of the rows and to their complements.
///
/// @param x  (n x p), @param y  (n x m): one row a run, so that halves are of runs. n >= 4.
/// @return (half samples x p) 1 where a column was selected, 0 where not; or what `fit_lasso`
/// finds.
/// @see    Meinshausen, Buehlmann (2010), J. R. Stat. Soc. B 72(4); the complementary pairs are
///         Shah, Samworth (2013), J. R. Stat. Soc. B 75(1).
[[nodiscard]] Result<Eigen::MatrixXd> select_on_halves(const Eigen::MatrixXd& x,
                                                       const Eigen::MatrixXd& y, double penalty,
                                                       Rng& rng,
                                                       const StabilityOptions& options = {},
                                                       const LassoOptions& lasso = {});

}  // namespace recald::screening
