/// What is uncertain about a building: named parameters, their units and their priors.
#pragma once

#include <span>
#include <string>

#include "core/result.hpp"

namespace recald {

/// Triangular distribution on [min, max]; the seed's choice for every parameter.
///
/// All three numbers are in the parameter's own unit. min < max and min <= mode <= max.
struct TriangularPrior {
  double min;
  double mode;
  double max;

  /// @return the prior, or invalid_value when the three are not finite or not in order.
  static Result<TriangularPrior> make(double min, double mode, double max);

  [[nodiscard]] double density(double value) const;
  [[nodiscard]] double cumulative(double value) const;
  /// Inverse of `cumulative`. @pre 0 <= probability <= 1
  [[nodiscard]] double quantile(double probability) const;
  [[nodiscard]] double mean() const { return (min + mode + max) / 3.0; }
  [[nodiscard]] double variance() const;

  bool operator==(const TriangularPrior&) const = default;
};

/// A calibration parameter: θ_j of eq. (3) of the seed.
struct Parameter {
  std::string name;  ///< snake_case, e.g. occupancy_density
  std::string unit;  ///< as people write it: "person/m2", "degC"
  TriangularPrior prior;
};

/// The values in words, for messages: "outdoor_air = 0.4 m3/s, set_point = 23.5 degC".
/// @pre equal lengths
[[nodiscard]] std::string describe(std::span<const Parameter> parameters,
                                   std::span<const double> values);

}  // namespace recald
