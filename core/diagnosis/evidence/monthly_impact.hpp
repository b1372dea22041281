/// The monthly change caused by an effect, for people.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/diagnosis/evidence/site_problem.hpp"

namespace recald::diagnosis {

/// kWh in a mean month of the effect: of all months, or for a dated effect of those between its
/// dates, with fractions of a month.
/// @param eta        Values of the candidate's parameters, dates last.
/// @param effect_kW  (parts x m) with the effect minus without.
/// @return (m)
[[nodiscard]] std::vector<double> monthly_impact_kWh(const SiteProblem& site,
                                                     const Candidate& candidate,
                                                     std::span<const double> eta,
                                                     const Eigen::ArrayXXd& effect_kW);

}  // namespace recald::diagnosis
