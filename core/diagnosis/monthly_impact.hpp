/// What an effect changes in a month, for people.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/diagnosis/site_problem.hpp"

namespace recald::diagnosis {

/// kWh of a mean month in which the effect is there: of all months, or of a dated one those between
/// its dates, parts of a month counting as parts.
/// @param eta        Values of the candidate's parameters, dates last.
/// @param effect_kW  (parts x m) with the effect minus without.
/// @return (m)
[[nodiscard]] std::vector<double> monthly_impact_kWh(const SiteProblem& site,
                                                     const Candidate& candidate,
                                                     std::span<const double> eta,
                                                     const Eigen::ArrayXXd& effect_kW);

}  // namespace recald::diagnosis
