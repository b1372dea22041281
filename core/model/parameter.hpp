/// Uncertain properties of a building: named parameters, their units and their priors.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/model/prior.hpp"

namespace recald {

/// A calibration parameter: θ_j of eq. (3) of the seed.
struct Parameter {
  std::string name;  ///< snake_case, e.g. occupancy_density
  std::string unit;  ///< As people write it: "person/m2", "degC".
  Prior prior;
};

/// The values in words, for messages: "outdoor_air = 0.4 m3/s, set_point = 23.5 degC".
/// @pre equal lengths
[[nodiscard]] std::string describe(std::span<const Parameter> parameters,
                                   std::span<const double> values);

/// The parameters at their prior modes or means.
[[nodiscard]] std::vector<double> prior_modes(std::span<const Parameter> parameters);
[[nodiscard]] std::vector<double> prior_means(std::span<const Parameter> parameters);

}  // namespace recald
