/// The parameters that every model calibrates, as answers tell their truths.
#pragma once

#include <nlohmann/json.hpp>

namespace recald::blind {

/// Each in the unit of site files.
struct BaseParameters {
  double occupancy_person_m2;
  double outdoor_air_m3_s;
  double cooling_setpoint_C;
};

/// Answers' keys `true_parameters` and `prior_sd`: standard deviations of the triangular priors
/// that a site file with these drawings has.
void add_base_parameters(nlohmann::ordered_json& answer, const BaseParameters& truth,
                         const BaseParameters& drawings);

}  // namespace recald::blind
