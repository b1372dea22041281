/// Whether surprises are what they ought to be while nothing changes: independent, standard normal.
#pragma once

#include <span>

#include "core/result.hpp"

namespace recald::drift {

struct CalibrationCheck {
  double mean;     ///< Of the standardised surprises; 0 where forecasts are unbiased.
  double sd;       ///< 1 where their spread is honest; larger: too sure of themselves.
  double lag_one;  ///< Autocorrelation between one month and the next.
  double pvalue;   ///< That such values come about by chance.
};

/// Likelihood-ratio test of an autoregression u_t = c + r u_(t-1) + s e_t against c = r = 0, s = 1:
/// chi-squared with 3 degrees of freedom. Small samples reject a little too often (6 % at 24).
/// @param standardised  Normal scores of PITs, in order of time.
/// @return or not_enough_data below 8 of them.
/// @see Berkowitz (2001), J. Bus. Econ. Stat. 19(4), eq. (12).
[[nodiscard]] Result<CalibrationCheck> check_calibration(std::span<const double> standardised);

}  // namespace recald::drift
