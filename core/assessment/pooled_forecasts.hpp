/// Two forecasters of one output made into one, each with the weight that it has earned.
#pragma once

#include <span>

#include "core/assessment/given_data.hpp"

namespace recald::assessment {

/// Weight w of the first of two forecasters in a mixture of both: the one under which what was
/// measured is likeliest, prod_i ( w exp(a_i) + (1 - w) exp(b_i) ). 1/2 without a month.
///
/// @param log_a, log_b  (n) log densities that each gave to what was measured, in months that it
/// had
///                      not seen.
/// @see Yao, Vehtari, Simpson, Gelman (2018), Bayesian Anal. 13(3), on stacking.
[[nodiscard]] double stacking_weight(std::span<const double> log_a, std::span<const double> log_b);

/// Pools the forecasts by what both said of the calibration months with three left out together. A
/// month that only one of them forecasts stays that one's.
/// @param weight  Receives that of `model`.
[[nodiscard]] OutputForecasts pool(const OutputForecasts& model, const OutputForecasts& days,
                                   std::span<const double> measured, double& weight);

}  // namespace recald::assessment
