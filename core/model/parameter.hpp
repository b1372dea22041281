/// Uncertain properties of a building: named parameters, their units and their priors.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/model/prior.hpp"

namespace recald {

namespace model {
struct ParameterDefinition;
}

/// A calibration parameter: θ_j of eq. (3) of the seed.
struct Parameter {
  std::string name;  ///< snake_case, e.g. occupancy_density
  std::string unit;  ///< As people write it: "person/m2", "degC".
  Prior prior;
  std::string label = {};   ///< For people.
  std::string source = {};  ///< Of the prior, as the site file says; empty: it says nothing.
  /// What it is of a building, or of an effect; null: a client's model has values of its own.
  const model::ParameterDefinition* definition = nullptr;
};

/// (q) What they are of a building.
[[nodiscard]] std::vector<const model::ParameterDefinition*> definitions_of(
    std::span<const Parameter> parameters);

/// The values in words, for messages: "outdoor_air = 0.4 m3/s, set_point = 23.5 degC".
/// @pre equal lengths
[[nodiscard]] std::string describe(std::span<const Parameter> parameters,
                                   std::span<const double> values);

/// The parameters at their prior modes or means.
[[nodiscard]] std::vector<double> prior_modes(std::span<const Parameter> parameters);
[[nodiscard]] std::vector<double> prior_means(std::span<const Parameter> parameters);

}  // namespace recald
